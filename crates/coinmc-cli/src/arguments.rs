//! The command line: global options and one subcommand per verb.

#[cfg(feature = "robot")]
use crate::commands::Robot;
use crate::commands::{
    AimAt, Analytic, Ask, Check, Compare, Completions, Converge, DesignArgs, Fair, Merge, Rare,
    ReportOf, Run, Schema, SensitivityOf, Show, Status, Trace, Validate,
};
#[cfg(feature = "film")]
use crate::commands::{Calibrate, Film, Listen};
use crate::exit::{Failure, Outcome};
use crate::negative::{with_negative_numbers, with_quantities_joined};
use crate::output::{Console, Format};
use clap::error::ContextKind;
use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::error::Error as _;
use std::ffi::OsString;
use std::num::{ParseFloatError, ParseIntError};

const EXAMPLES: &str = "\
Examples:
  coinmc check examples/flat-fair.toml            what would be computed, and how long it takes
  coinmc run examples/flat-fair.toml              run it; the same command again resumes
  coinmc run toss.toml --set surface.friction=0.2 --format json
  coinmc fair --scene wood                        how thick is a fair coin on a wooden table?
  coinmc analytic --fair                          fair ratios of the closed forms
  coinmc trace toss.toml --toss 42 --show          what happened in a toss

Exit status:
  0    done
  1    failure at run time (disk full, file unreadable, …)
  2    bad input: arguments, config, or a directory that belongs to another run
  3    stopped short of the target: max_tosses came before the targets of [stop], --max-time before
  the end, a search found too few tosses
  4    a robot's experiment has halted and needs a person
  130  stopped by Ctrl-C or SIGTERM; finished work is kept

With --format json, standard output holds exactly one JSON document: the result, or the problems \
that prevented it. Only arguments that are not understood print none.";

/// How likely does a tossed cylinder come to rest on heads, on tails or on its side?
///
/// A coin of height H and radius R ("ratio" is always H/R) is tossed onto a surface, many times, by
/// the laws of mechanics. A config (TOML) says which coins, which surfaces and how they are tossed;
/// any number in it may be a list or a range, which makes it an axis of a sweep.
#[derive(Debug, Parser)]
#[command(name = "coinmc", version = coinmc_build::BUILD, after_long_help = EXAMPLES, max_term_width = 100)]
pub(crate) struct Arguments {
    /// When to use colour; NO_COLOR is respected
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto, value_name = "WHEN")]
    color: ColorChoice,

    #[command(subcommand)]
    command: Command,
}

/// The file of each verb describes it and its arguments.
#[derive(Debug, Subcommand)]
enum Command {
    Run(Run),
    Show(Show),
    Status(Status),
    Report(ReportOf),
    Check(Check),
    Ask(Ask),
    Fair(Box<Fair>),
    Design(Box<DesignArgs>),
    Sensitivity(SensitivityOf),
    Converge(Converge),
    Aim(AimAt),
    Rare(Rare),
    #[cfg(feature = "film")]
    Calibrate(Calibrate),
    Compare(Compare),
    Validate(Validate),
    Merge(Merge),
    Trace(Box<Trace>),
    #[cfg(feature = "film")]
    Film(Film),
    #[cfg(feature = "film")]
    Listen(Box<Listen>),
    Analytic(Analytic),
    #[cfg(feature = "robot")]
    Robot(Robot),
    Schema(Schema),
    Completions(Completions),
}

/// The same error, in plain words where a value is no number or out of its range.
fn in_plain_words(error: clap::Error) -> clap::Error {
    let value = error.get(ContextKind::InvalidValue);
    let (Some(expected), Some(value), Some(arg)) =
        (expected(&error), value, error.get(ContextKind::InvalidArg))
    else {
        return error;
    };
    let message = format!(
        "invalid value '{value}' for '{arg}': {expected}\n\nFor more information, try '--help'.\n"
    );
    clap::Error::raw(error.kind(), message)
}

/// What was expected in place of a value, if that is a number.
fn expected(error: &clap::Error) -> Option<String> {
    let source = error.source()?;
    if source.is::<ParseFloatError>() {
        return Some("expected a number".to_owned());
    }
    if source.is::<ParseIntError>() {
        return Some("expected a whole number".to_owned());
    }
    let text = source.to_string();
    let (_, range) = text.split_once(" is not in ")?;
    Some(match range.split_once("..=") {
        Some((least, most)) => format!("expected a whole number from {least} to {most}"),
        None => format!("expected at least {}", range.trim_end_matches('.')),
    })
}

impl Arguments {
    /// Reads the words of a command line.
    pub(crate) fn read(words: &[OsString]) -> Result<Self, clap::Error> {
        let mut command = with_negative_numbers(Self::command());
        let words = with_quantities_joined(&command, words);
        let matches = command.try_get_matches_from_mut(words);
        let matches = matches.map_err(in_plain_words)?;
        Self::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
    }

    /// Executes the command and reports failures; returns the exit status.
    pub(crate) fn execute(self) -> u8 {
        let format = self.command.format();
        let console = Console::new(self.color, format);
        match self.command.execute(&console) {
            Ok(outcome) => outcome.into(),
            Err(failure) => failure.report(&console),
        }
    }
}

impl Command {
    fn format(&self) -> Format {
        match self {
            Self::Run(run) => run.format(),
            Self::Show(show) => show.format(),
            Self::Status(status) => status.format(),
            Self::Report(report) => report.format(),
            Self::Check(check) => check.format(),
            Self::Ask(ask) => ask.format(),
            Self::Fair(fair) => fair.format(),
            Self::Design(design) => design.format(),
            Self::Sensitivity(sensitivity) => sensitivity.format(),
            Self::Converge(converge) => converge.format(),
            Self::Aim(aim) => aim.format(),
            Self::Rare(rare) => rare.format(),
            #[cfg(feature = "film")]
            Self::Calibrate(calibrate) => calibrate.format(),
            Self::Compare(compare) => compare.format(),
            Self::Validate(validate) => validate.format(),
            Self::Merge(merge) => merge.format(),
            Self::Trace(trace) => trace.format(),
            #[cfg(feature = "film")]
            Self::Film(film) => film.format(),
            #[cfg(feature = "film")]
            Self::Listen(listen) => listen.format(),
            Self::Analytic(analytic) => analytic.errors_as(),
            #[cfg(feature = "robot")]
            Self::Robot(robot) => robot.format(),
            Self::Schema(_) | Self::Completions(_) => Format::Table,
        }
    }

    fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        match self {
            Self::Run(run) => run.execute(console),
            Self::Show(show) => show.execute(console),
            Self::Status(status) => status.execute(console),
            Self::Report(report) => report.execute(console),
            Self::Check(check) => check.execute(console),
            Self::Ask(ask) => ask.execute(console),
            Self::Fair(fair) => fair.execute(console),
            Self::Design(design) => design.execute(console),
            Self::Sensitivity(sensitivity) => sensitivity.execute(console),
            Self::Converge(converge) => converge.execute(console),
            Self::Aim(aim) => aim.execute(console),
            Self::Rare(rare) => rare.execute(console),
            #[cfg(feature = "film")]
            Self::Calibrate(calibrate) => calibrate.execute(console),
            Self::Compare(compare) => compare.execute(console),
            Self::Validate(validate) => validate.execute(console),
            Self::Merge(merge) => merge.execute(console),
            Self::Trace(trace) => trace.execute(console),
            #[cfg(feature = "film")]
            Self::Film(film) => film.execute(console),
            #[cfg(feature = "film")]
            Self::Listen(listen) => listen.execute(console),
            Self::Analytic(analytic) => analytic.execute(console),
            #[cfg(feature = "robot")]
            Self::Robot(robot) => robot.execute(console),
            Self::Schema(schema) => schema.execute(),
            Self::Completions(completions) => completions.execute(Arguments::command()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        with_negative_numbers(Arguments::command()).debug_assert();
    }

    fn refused(words: &str) -> String {
        let words: Vec<OsString> = words.split(' ').map(Into::into).collect();
        let error = Arguments::read(&words).expect_err("a problem");
        error.to_string()
    }

    #[test]
    fn what_is_no_number_is_told_in_plain_words() {
        for (words, told) in [
            (
                "fair --threads 0",
                "'0' for '--threads <N>': expected a whole number from 1 to 1024",
            ),
            (
                "listen a.wav --seed 1e9",
                "'1e9' for '--seed <SEED>': expected a whole number",
            ),
            ("aim --clumsy abc", "'abc' for '--clumsy"),
            ("aim --clumsy abc", ": expected a number\n"),
            (
                "check a.toml --nodes 0",
                "'0' for '--nodes <N>': expected a",
            ),
        ] {
            let message = refused(&format!("coinmc {words}"));
            assert!(message.contains(told), "{message}");
            assert!(message.starts_with("error: invalid value"), "{message}");
        }
    }

    /// Then it is wrapped at the width of any terminal, and but once.
    #[test]
    fn a_paragraph_below_a_help_is_one_line() {
        let mut commands = vec![Arguments::command()];
        while let Some(command) = commands.pop() {
            commands.extend(command.get_subcommands().cloned());
            let below = command.get_after_help().or(command.get_after_long_help());
            let text = below.map(ToString::to_string).unwrap_or_default();
            let lines: Vec<&str> = text.lines().collect();
            for pair in lines.windows(2) {
                let is_prose = |line: &str| !line.is_empty() && !line.starts_with(' ');
                let is_title = pair[0].ends_with(':');
                // a table
                let is_cell = pair[0].contains("  ");
                let is_wrapped = is_prose(pair[0]) && is_prose(pair[1]) && !is_title && !is_cell;
                assert!(!is_wrapped, "{}: {pair:?}", command.get_name());
            }
        }
    }

    #[test]
    fn a_shell_offers_the_names_of_fixed_lists() {
        let mut command = Arguments::command();
        command.build();
        for (verb, option, name) in [
            ("fair", "scene", "billiards"),
            ("fair", "face", "side"),
            ("ask", "material", "felt"),
            ("ask", "launch", "rolled"),
            ("validate", "only", "kerrich"),
        ] {
            let verb = command.find_subcommand(verb).expect("a verb");
            let mut options = verb.get_arguments();
            let option = options.find(|arg| arg.get_long() == Some(option));
            let offered = option.expect("an option").get_possible_values();
            assert!(
                offered.iter().any(|value| value.matches(name, false)),
                "{name}"
            );
        }
    }

    #[test]
    fn a_negative_number_is_a_value_that_its_option_may_refuse() {
        let time = refused("coinmc run a.toml --max-time -5");
        assert!(
            time.contains("'-5' for '--max-time <TIME>': expected a time"),
            "{time}"
        );
        for words in [
            "fair --diameter -30mm",
            "fair --mass -.5g --density 1g/cm3",
            "design --rim -1mm",
            "ask --thickness -2mm",
        ] {
            let told = refused(&format!("coinmc {words}"));
            assert!(
                told.contains("expected a number above 0 and a unit"),
                "{told}"
            );
        }
        let time = refused("coinmc run a.toml --max-time -5s");
        assert!(time.contains("expected a time such as"), "{time}");
        let missing = refused("coinmc fair --diameter --threads 2");
        assert!(
            missing.contains("a value is required for '--diameter"),
            "{missing}"
        );
        let threads = refused("coinmc fair --threads -1");
        assert!(
            threads.contains("expected a whole number from 1 to 1024"),
            "{threads}"
        );
        let words = ["coinmc", "ask", "--ratio", "-1"].map(OsString::from);
        assert!(Arguments::read(&words).is_ok());
        assert!(refused("coinmc run -1").contains("unexpected argument '-1'"));
    }
}
