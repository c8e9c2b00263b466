//! What the WebAssembly module exports. A question is written to where [`coinmc_question`] says,
//! [`coinmc_answer`] answers it, and the answer is read from where [`coinmc_answer_at`] says.
//!
//! No memory is accessed unsafely here: JavaScript writes and reads it between the calls.

// A function exported by its name could be mistaken for another of that name; the prefix prevents it.
#![allow(unsafe_code)]

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The question, then its answer.
static TEXT: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn text() -> MutexGuard<'static, Vec<u8>> {
    TEXT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for a question of `length` bytes; the address to write it to.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn coinmc_question(length: usize) -> *mut u8 {
    let mut text = text();
    text.clear();
    text.resize(length, 0);
    text.as_mut_ptr()
}

/// Answers the question; the number of bytes of the answer.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn coinmc_answer() -> usize {
    let mut text = text();
    let answer = crate::answer(&String::from_utf8_lossy(&text));
    *text = answer.into_bytes();
    text.len()
}

/// The address of the answer.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn coinmc_answer_at() -> *const u8 {
    text().as_ptr()
}
