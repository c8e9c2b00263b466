# Short names for what scripts do; `just` lists them.

_default:
    @just --list

# Every test there is
test:
    scripts/test

# Format, lints and the quicker Rust tests
quick:
    scripts/test --quick

# Format all code
format:
    cargo fmt --all

# Lints, as the tests run them
lint:
    cargo clippy --workspace --all-targets -- -D warnings

# The kill-and-resume test, at length
kill-test kills="200":
    cargo build --release
    COINMC_KILLS={{kills}} cargo test -p coinmc-tests --test resume

# Breaks lines, and looks whether tests go red: all promises and all listed modules (hours)
mutants *arguments:
    scripts/mutants {{arguments}}

# Breaks a thousand lines of a listed module in one build, and lists what its tests let live
survey-mutants *arguments:
    scripts/survey-mutants {{arguments}}

# The tables of docs/, from the CSV files under data/validation
tables *arguments:
    scripts/docs-tables {{arguments}}

# The Python wheel, into target/wheels
wheel:
    scripts/wheel

# Everything of a release, into target/dist; or with --dry-run what that would be
release *arguments:
    scripts/release {{arguments}}
