//! Negative values of options: the option then says its own range, where clap would know no argument `-1`.

use crate::commands::quantity::{Density, Length, Mass, Volume};
use clap::{Arg, Command};
use std::any::TypeId;
use std::ffi::{OsStr, OsString};
use std::time::Duration;

/// The same command, whose options take negative numbers as their values.
pub(crate) fn with_negative_numbers(command: Command) -> Command {
    let takes_values = |arg: &Arg| arg.get_action().takes_values() && !arg.is_positional();
    command
        .mut_args(|arg| {
            let takes = takes_values(&arg);
            arg.allow_negative_numbers(takes)
        })
        .mut_subcommands(with_negative_numbers)
}

/// The same words, in which a negative quantity, which clap takes for no number, is joined to its option:
/// `--diameter=-30mm`.
pub(crate) fn with_quantities_joined(command: &Command, words: &[OsString]) -> Vec<OsString> {
    let mut options = vec![];
    collect_quantities(command, &mut options);
    let is_option = |word: &OsStr| {
        let name = word.to_str().and_then(|word| word.strip_prefix("--"));
        name.is_some_and(|name| options.contains(&name))
    };
    let mut joined: Vec<OsString> = vec![];
    for word in words {
        match joined.last_mut() {
            Some(option) if is_option(option) && is_negative(word) => {
                option.push("=");
                option.push(word);
            }
            _ => joined.push(word.clone()),
        }
    }
    joined
}

/// The names of the options of a command and its subcommands whose values have a unit.
fn collect_quantities<'a>(command: &'a Command, names: &mut Vec<&'a str>) {
    let with_unit = [
        TypeId::of::<Length>(),
        TypeId::of::<Volume>(),
        TypeId::of::<Mass>(),
        TypeId::of::<Density>(),
        TypeId::of::<Duration>(),
    ];
    let has_unit = |arg: &&Arg| {
        let kind = arg.get_value_parser().type_id();
        with_unit.iter().any(|with_unit| kind == *with_unit)
    };
    names.extend(
        command
            .get_arguments()
            .filter(has_unit)
            .filter_map(Arg::get_long),
    );
    for command in command.get_subcommands() {
        collect_quantities(command, names);
    }
}

/// Whether a word is a negative number, perhaps with a unit.
fn is_negative(word: &OsStr) -> bool {
    let number = word.to_str().and_then(|word| word.strip_prefix('-'));
    number.is_some_and(|number| number.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
}
