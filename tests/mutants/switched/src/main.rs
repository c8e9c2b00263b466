//! Builds many mutants into one program, each behind a switch.
//!
//!     switched-mutants LIST.json ROOT LIB
//!
//! LIST.json is what `cargo mutants --list --json` prints, with a number `id` for each mutant. The sources under ROOT
//! that it names are rewritten in place: where the function `__on(id)` says so, a mutant acts. `a + b` becomes
//!
//!     ({ let __l = (a); let __r = (b); if crate::__on(7) { __l - __r } else { __l + __r } })
//!
//! LIB, the library's root under ROOT, gets that function, which reads the environment: `MUTANT` is the one that acts,
//! and a program that ends writes into the file `MUTANTS_REACHED` which it came to. Prints the mutants that have no
//! switch, as a list in JSON: deleted fields of structs, conditions with `let`, and values of functions that return an
//! `impl`.

mod edits;
mod switches;

use edits::Edits;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::path::Path;
use switches::Switches;
use syn::visit::Visit;

/// One mutant of the list.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Mutant {
    pub(crate) id: u32,
    file: String,
    pub(crate) genre: String,
    pub(crate) replacement: String,
    pub(crate) span: Span,
}

#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct Span {
    pub(crate) start: Place,
}

/// Both count from 1.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct Place {
    pub(crate) line: usize,
    pub(crate) column: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, list, root, lib] = arguments.as_slice() else {
        return Err("usage: switched-mutants LIST.json ROOT LIB".into());
    };
    let mutants: Vec<Mutant> = serde_json::from_slice(&std::fs::read(list)?)?;
    let mut files: BTreeMap<String, Vec<Mutant>> = BTreeMap::new();
    for mutant in mutants {
        files.entry(mutant.file.clone()).or_default().push(mutant);
    }
    let mut without = BTreeSet::new();
    for (file, mutants) in files {
        let path = Path::new(root).join(file);
        let source = std::fs::read_to_string(&path)?;
        let mut switches = Switches::new(Edits::of(&source), &mutants);
        switches.visit_file(&syn::parse_file(&source)?);
        let (text, switched) = switches.finish();
        without.extend(
            mutants
                .iter()
                .map(|m| m.id)
                .filter(|id| !switched.contains(id)),
        );
        std::fs::write(&path, text)?;
    }
    let path = Path::new(root).join(lib);
    let text = std::fs::read_to_string(&path)?;
    // nobody reads what the compiler thinks of the switches
    let text = format!(
        "#![allow(warnings)]\n{text}{}",
        include_str!("runtime.rs.in")
    );
    std::fs::write(&path, text)?;
    println!("{}", serde_json::to_string(&without)?);
    Ok(())
}
