//! Invalid configs: every problem is reported at once, at its exact location, with a remedy.

use coinmc::config;

/// A valid config; each case replaces one piece of it.
const GOOD: &str = "\
seed = 1
[coin]
ratio = 1.2
[surface]
restitution = 0.5
friction = 0.3
[launch]
preset = 'robot'
[engine.flat]
law = 'moreau'
[stop]
tosses = 1000
";

/// The engine of the valid config.
const FLAT: &str = "[engine.flat]\nlaw = 'moreau'";

/// Replaced piece, its replacement, and every problem: line, column, a piece of message or help.
type Case = (
    &'static str,
    &'static str,
    &'static [(usize, usize, &'static str)],
);

#[rustfmt::skip]
const NUMBERS: &[Case] = &[
    ("1.2", "0", &[(3, 9, "`coin.ratio` must be from 1e-12 to 1e12, found `0`")]),
    ("1.2", "-1.5", &[(3, 9, "found `-1.5`")]),
    ("1.2", "1e13", &[(3, 9, "to 1e12, found `1e13`")]),
    ("1.2", "nan", &[(3, 9, "must be finite, from 1e-12 to 1e12, found `nan`")]),
    ("1.2", "-inf", &[(3, 9, "must be finite")]),
    ("1.2", "1e999", &[(3, 9, "must be finite, from 1e-12 to 1e12, found `1e999`")]),
    ("1.2", "99999999999999999999999999999999999999999999", &[(3, 9, "must be from 1e-12 to 1e12")]),
    ("1.2", "'1.2'", &[(3, 9, "remove the quotes")]),
    ("1.2", "true", &[(3, 9, "a number, a list of numbers or a range {from, to, steps}, found a boolean: `true`")]),
    ("1.2", "1979-05-27", &[(3, 9, "found a date")]),
    ("1.2", "1.2\nradius_m = 0", &[(4, 12, "`coin.radius_m` must be from 1e-9 to 1e6")]),
    ("1.2", "1.2\nrim_radius_m = 0.001", &[(4, 16, "engine.flat models sharp rims: `coin.rim_radius_m` must be 0")]),
    ("1.2", "1.2\ndraft_deg = 4.0", &[(4, 13, "engine.flat models cylinders: `coin.draft_deg` must be 0")]),
    ("1.2", "1.2\ndraft_deg = 45", &[(4, 13, "`coin.draft_deg` must be above -45 and below 45, found `45`")]),
    ("1.2", "1.2\ncentre_of_mass_over_height = 0.1", &[(4, 30, "engine.flat models coins with their centre of mass in the middle")]),
    ("1.2", "1.2\ncentre_of_mass_over_height = -0.5", &[(4, 30, "must be above -0.5 and below 0.5, found `-0.5`")]),
    ("1.2", "1.2\nrim_radius_m = -1e-4", &[(4, 16, "`coin.rim_radius_m` must be from 0 to 1e6")]),
    ("1.2", "1.2\nmass_kg = -0.0", &[(4, 11, "`coin.mass_kg` must be from 1e-12")]),
    ("0.5", "1.01", &[(5, 15, "`surface.restitution` must be from 0 to 1, found `1.01`")]),
    ("0.3", "-0.1", &[(6, 12, "`surface.friction` must be from 0 to 1e6")]),
    ("[stop]", "[environment]\ngravity_m_s2 = 0\n[stop]", &[(12, 16, "`environment.gravity_m_s2` must be from 1e-6")]),
    ("law = 'moreau'", "zeno = 0", &[(10, 8, "`engine.flat.zeno` must be above 0 and at most 1")]),
    ("law = 'moreau'", "tolerance = 0.5", &[(10, 13, "must be from 1e-12 to 0.01")]),
    ("law = 'moreau'", "max_impacts = 0", &[(10, 15, "a whole number from 1 to 4294967295, found `0`")]),
    ("law = 'moreau'", "decision = { energy_fraction = 1.0 }", &[(10, 32, "must be above 0 and below 1, found `1.0`")]),
    ("0.3", "0.3\nrolling_friction_m = -1e-9", &[(7, 22, "`surface.rolling_friction_m` must be from 0 to 1e6, found `-1e-9`")]),
    ("0.3", "0.3\npivoting_friction_m = 'none'", &[(7, 23, "`surface.pivoting_friction_m` must be a number")]),
    ("0.3", "0.3\nrestitution_threshold_m_s = inf", &[(7, 29, "must be finite, from 0 to 1e6")]),
    ("0.3", "0.3\nroughness_slope = 0.25\nroughness_wavelength_m = 0", &[(7, 19, "`surface.roughness_slope` must be from 0 to 0.2, found `0.25`"), (8, 26, "`surface.roughness_wavelength_m` must be above 0")]),
    ("0.3", "0.3\nrestitution_exponent = -0.25\nrestitution_reference_m_s = 0", &[(7, 24, "`surface.restitution_exponent` must be from 0 to 1"), (8, 29, "`surface.restitution_reference_m_s` must be above 0")]),
    ("[stop]", "[environment]\nlinear_drag_per_s = -1\nangular_drag_per_s = nan\n[stop]", &[(12, 21, "`environment.linear_drag_per_s` must be from 0 to 1e6"), (13, 22, "`environment.angular_drag_per_s` must be finite")]),
    ("[stop]", "[environment]\ngyroscopic_torque = 0\n[stop]", &[(12, 21, "`environment.gyroscopic_torque` must be true or false, found an integer: `0`")]),
    ("tosses = 1000", "tosses = 0", &[(12, 10, "a whole number from 1 to 1000000000000000, found `0`")]),
    ("tosses = 1000", "tosses = 1e16", &[(12, 10, "found `1e16`")]),
    ("tosses = 1000", "tosses = 10.5", &[(12, 10, "must be a whole number from 1 to 1000000000000000, found a number: `10.5`")]),
    ("tosses = 1000", "half_width = 0.5", &[(12, 14, "must be at least 1e-7 and below 0.5")]),
    ("tosses = 1000", "tosses = 1000\n[estimate]\nconfidence = 1", &[(14, 14, "must be at least 0.5 and below 1")]),
    ("seed = 1", "seed = -1", &[(1, 8, "`seed` must be a whole number from 0 to 18446744073709551615, found `-1`")]),
    ("seed = 1", "seed = 18446744073709551616", &[(1, 8, "found `18446744073709551616`")]),
    ("seed = 1", "seed = nan", &[(1, 8, "a whole number")]),
    ("seed = 1", "seed = [1, 2]", &[(1, 8, "found a list")]),
    ("seed = 1", "paired = 1", &[(1, 10, "`paired` must be true or false, found an integer: `1`")]),
];

/// Settings of the engine in space.
#[rustfmt::skip]
const VOLUMETRIC: &[Case] = &[
    (FLAT, "[engine.volumetric]\nlaw = 'stronge'\nzeno = 0", &[(11, 8, "`engine.volumetric.zeno` must be above 0 and at most 1")]),
    (FLAT, "[engine.volumetric]\nlaw = 'strong'", &[(10, 7, "did you mean \"stronge\"?")]),
    (FLAT, "[engine.volumetric]\nlaw = 'newton'", &[(10, 7, "`engine.volumetric.law` must be one of \"moreau\", \"chatterjee-ruina\", \"stronge\"")]),
    (FLAT, "[engine.volumetric]\ndecision = 'certain'", &[(10, 12, "must be one of \"tilting\", \"energy\", found `certain`")]),
    (FLAT, "[engine.volumetric]\ndecision = { energy_fraction = 0.01 }", &[(10, 12, "found a table")]),
    (FLAT, "[engine.volumetric]\ntolerance = 1e-13", &[(10, 13, "must be from 1e-12 to 0.01")]),
    (FLAT, "[engine.volumetric]\nstick_speed = 0.2\nsmoothing_time = 0", &[(10, 15, "above 0 and at most 0.1"), (11, 18, "`engine.volumetric.smoothing_time` must be above 0")]),
    (FLAT, "[engine.volumetric]\nmax_impacts = 0\ntime_limit = 0", &[(10, 15, "a whole number from 1"), (11, 14, "`engine.volumetric.time_limit` must be above 0")]),
    (FLAT, "[engine.volumetric]\ntime_limit = inf", &[(10, 14, "must be finite")]),
    (FLAT, "[engine.volumetirc]", &[(9, 9, "did you mean `volumetric`?")]),
];

/// What the flat engine does not model is rejected, never ignored.
#[rustfmt::skip]
const NOT_FLAT: &[Case] = &[
    ("'moreau'", "{ gaek-sukhov = { eta_n_s = 1e-3 } }", &[(6, 12, "Gaek & Sukhov's law has no friction: `surface.friction` must be 0 set `friction = 0`")]),
    ("'moreau'", "{ gaek-sukhov = {} }", &[(6, 12, "no friction"), (10, 23, "`eta_n_s` is missing")]),
    ("'moreau'", "{ half-sine = { peak_n = 10 } }", &[(10, 21, "one of `time_s`, `contact` is missing")]),
    ("'moreau'", "{ half-sine = { time_s = 0 } }", &[(10, 32, "must be from 1e-12 to 1")]),
    ("'moreau'", "{ line-contact = { coin_young_pa = 1e9, surface_young_pa = 1e9, length_m = 0 } }", &[(10, 82, "`engine.flat.law.line-contact.length_m` must be from 1e-9")]),
    ("'moreau'", "'gaek-sukhov'", &[(10, 7, "{gaek-sukhov = …}")]),
    ("0.3", "0.3\nrolling_friction_m = 1e-4", &[(7, 22, "engine.flat models no rolling friction: `surface.rolling_friction_m` must be 0 remove `rolling_friction_m`, or toss in space with [engine.volumetric]")]),
    ("0.3", "0.3\nrolling_friction_m = [0, 1e-4]\npivoting_friction_m = 1e-4", &[(7, 22, "rolling friction"), (8, 23, "engine.flat models no pivoting friction")]),
    ("0.3", "0.3\npivoting_friction_m = { from = 0, to = 1e-4, steps = 3 }", &[(7, 23, "pivoting friction")]),
    ("0.3", "0.3\nrestitution_threshold_m_s = 2", &[(7, 29, "engine.flat models no restitution threshold")]),
    ("0.3", "0.3\nrestitution_exponent = 0.25", &[(7, 24, "engine.flat models no restitution that depends on speed: `surface.restitution_exponent` must be 0")]),
    ("0.3", "0.3\nroughness_slope = [0, 0.1]\nroughness_wavelength_m = 1e-3", &[(7, 19, "engine.flat models no roughness: `surface.roughness_slope` must be 0 remove `roughness_slope` and `roughness_wavelength_m`")]),
    ("[stop]", "[environment]\nlinear_drag_per_s = 1\nangular_drag_per_s = 0.05\ngyroscopic_torque = false\n[stop]", &[(12, 21, "engine.flat models no drag: `environment.linear_drag_per_s` must be 0"), (13, 22, "`environment.angular_drag_per_s` must be 0"), (14, 21, "`environment.gyroscopic_torque` must be true")]),
    // a launch out of the plane and a value out of range are reported together
    ("0.3\n[launch]\npreset = 'robot'", "-1\nrolling_friction_m = 1e-4\n[launch]\npreset = 'clean'", &[(6, 12, "from 0 to 1e6"), (7, 22, "rolling friction"), (9, 10, "leaves it")]),
];

#[rustfmt::skip]
const SWEEPS: &[Case] = &[
    ("1.2", "[]", &[(3, 9, "`coin.ratio` is an empty list")]),
    ("1.2", "[1, 'x', -1]", &[(3, 13, "must be a number, found text"), (3, 18, "found `-1`")]),
    ("1.2", "[1, 2, 1.0]", &[(3, 16, "`coin.ratio` has the value `1.0` twice")]),
    ("0.3", "[0.0, -0.0]", &[(6, 18, "has the value `-0.0` twice")]),
    ("1.2", "[[1, 2], 3]", &[(3, 10, "must be a number, found a list")]),
    ("1.2", "{ from = 1, to = 2 }", &[(3, 9, "`steps` is missing in `coin.ratio`")]),
    ("1.2", "{ from = 2, to = 1, steps = 3 }", &[(3, 26, "the range of `coin.ratio` is empty: `to` must be larger than `from` (2)")]),
    ("1.2", "{ from = 1, to = 1, steps = 2 }", &[(3, 26, "is empty")]),
    ("1.2", "{ from = 0, to = nan, steps = 1 }", &[(3, 18, "found `0`"), (3, 26, "finite"), (3, 39, "from 2 to 1000000, found `1`")]),
    ("1.2", "{ from = 1, to = 2, steps = 1_000_000_000_000 }", &[(3, 37, "a whole number from 2 to 1000000, found `1_000_000_000_000`")]),
    ("0.3", "{ from = 0, to = 1, steps = 3, scale = 'log' }", &[(6, 21, "must begin above 0")]),
    ("1.2", "{ from = 1, to = 2, steps = 3, scale = 'lin' }", &[(3, 48, "must be one of \"linear\", \"log\", found `lin`")]),
    ("1.2", "{ from = 1, too = 2, steps = 3 }", &[(3, 21, "did you mean `to`?")]),
    ("1.2", "{ from = 1, to = 1.000000000000001, steps = 9 }", &[(3, 9, "the 9 values of `ratio` lie closer together")]),
    ("ratio = 1.2", "ratio = { from = 1, to = 2, steps = 1000000 }\nradius_m = { from = 1, to = 2, steps = 1000000 }", &[(4, 12, "the sweep has 1000000000000 points (ratio 1000000 × radius_m 1000000), at most 1000000 are allowed")]),
    ("0.3", "[0.1, 0.2]\nlanding = 'bouncing'\n[sweep]\nmode = 'side-by-side'", &[(9, 8, "`sweep.mode` must be one of \"grid\", \"zip\", \"sobol\"")]),
    ("seed = 1", "sweep.mode = 'zip'\nenvironment.gravity_m_s2 = [1, 2, 3]\ncoin.radius_m = [1, 2]", &[(2, 28, "zipped axes must be equally long: `gravity_m_s2` has 3 values, `radius_m` has 2"), (4, 2, "`coin` is given twice")]),
    ("seed = 1", "sweep.mode = 'sobol'\nenvironment.gravity_m_s2 = [1, 2, 3]", &[(2, 28, "`gravity_m_s2` must be a range of at least three steps")]),
    ("[launch]", "[sweep]\nmode = 'sobol'\n[environment]\ngravity_m_s2 = { from = 1, to = 2, steps = 9 }\n[launch]\nheight_m = { from = 1, to = 2, steps = 5 }", &[(12, 12, "ranges of a design must be equally long: `launch.height_m` has 5 values, `gravity_m_s2` has 9")]),
    ("[launch]", "[sweep]\nmode = 'zip'\n[environment]\ngravity_m_s2 = { from = 1, to = 2, steps = 9 }\n[launch]\nheight_m = [1, 2]", &[(12, 12, "`launch.height_m` has 2 values, `gravity_m_s2` has 9")]),
];

#[rustfmt::skip]
const LAUNCHES: &[Case] = &[
    ("preset = 'robot'", "preset = 'robto'", &[(8, 10, "did you mean \"robot\"?")]),
    ("preset = 'robot'", "preset = 'clean'", &[(8, 10, "this one's orientation leaves it")]),
    ("preset = 'robot'", "preset = 'table1'", &[(8, 10, "the presets robot and clean-flat are flat")]),
    ("preset = 'robot'", "preset = 'robot'\nspin = { precessing = { rate_rad_s = 1, psi_deg = 90 } }", &[(9, 8, "this one's spin leaves it")]),
    ("preset = 'robot'", "preset = 'robot'\nvelocity_m_s = [0, 0.1, 0]", &[(9, 16, "this one's velocity leaves it")]),
    ("preset = 'robot'", "preset = 'robot'\nvelocity_m_s = [0, [0, 1], 0]", &[(9, 16, "the number 0")]),
    ("preset = 'robot'", "preset = 'robot'\nvelocity_m_s = [0, 0]", &[(9, 16, "must be a list of three, x, y and z, found 2")]),
    ("preset = 'robot'", "preset = 'robot'\nvelocity_m_s = 3", &[(9, 16, "must be a list of three, x, y and z, found an integer")]),
    ("preset = 'robot'", "preset = 'robot'\nvelocity_m_s = [0, 0, 'up']", &[(9, 23, "`launch.velocity_m_s.z` must be")]),
    ("preset = 'robot'", "height_m = 1", &[(7, 1, "`orientation` is missing in `launch` (required unless `preset` is given)"), (7, 1, "`spin` is missing")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = -1", &[(9, 12, "`launch.height_m` must be from 0 to 1e6")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { uniform = { from = 2, to = 1 } }", &[(9, 41, "a uniform distribution from 2 to 1 is empty")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { uniform = { from = 1, to = [0.5, 1, 2] } }", &[(9, 41, "from 1 to 0.5 is empty")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { normal = { mean = 1, sd = -1 } }", &[(9, 40, "`launch.height_m.normal.sd` must be from 0 to 1e6")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { normal = { mean = 1 } }", &[(9, 23, "`sd` is missing in `launch.height_m.normal`")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { normla = { mean = 1, sd = 1 } }", &[(9, 14, "did you mean `normal`?")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = {}", &[(9, 12, "`launch.height_m` is empty: it needs one of `uniform`, `normal`")]),
    ("preset = 'robot'", "preset = 'robot'\nheight_m = { uniform = { from = 0, to = 1 }, normal = { mean = 0, sd = 1 } }", &[(9, 46, "is already `uniform`: exactly one of `uniform`, `normal`")]),
    ("preset = 'robot'", "preset = 'robot'\norientation = 'isotropc'", &[(9, 15, "did you mean \"isotropic\"?")]),
    ("preset = 'robot'", "preset = 'robot'\norientation = 90", &[(9, 15, "must be one of \"isotropic\", \"euler-angles\", {tilt_deg = …}, {axis = …}, found an integer: `90`")]),
    ("preset = 'robot'", "preset = 'robot'\norientation = { axis = [0, 0, 0] }", &[(9, 24, "an axis of length 0 has no direction")]),
    ("preset = 'robot'", "preset = 'robot'\nspin = { about = { axis = [0, 1, 0] } }", &[(9, 18, "`rate_rad_s` is missing in `launch.spin.about`")]),
    ("preset = 'robot'", "preset = 'robot'\nspin = { abuot = 1 }", &[(9, 10, "did you mean `about`?")]),
    ("preset = 'robot'", "preset = 'robot'\nspin = { about = { axis = [0, 1, 0], rate_rad_s = 1e10 } }", &[(9, 51, "from -1e9 to 1e9")]),
];

#[rustfmt::skip]
const TABLES: &[Case] = &[
    ("seed = 1", "sede = 1", &[(1, 1, "did you mean `seed`?")]),
    ("seed = 1", "friction = 0.3", &[(1, 1, "`friction` belongs in [surface]")]),
    ("seed = 1", "'a\\nb' = 1\n'' = 2", &[(1, 1, "unknown key `a\\\\nb`"), (2, 1, "unknown key ``")]),
    ("ratio = 1.2", "ratoi = 1.2", &[(3, 1, "did you mean `ratio`?")]),
    ("ratio = 1.2", "ratio = 1.2\ncolour = 3", &[(4, 1, "allowed: `ratio`, ")]),
    // what is in a table of a wrong name is checked, too, where no other can be meant
    ("[coin]\nratio = 1.2", "[Coin]\nratoi = 1\nradius = 4", &[(2, 2, "did you mean `coin`?"), (3, 1, "unknown key `ratoi` in `coin` did you mean `ratio`?"), (4, 1, "did you mean `radius_m`?")]),
    ("[surface]\nrestitution = 0.5", "[surfce]\nrestitution = 1.5", &[(4, 2, "did you mean `surface`?"), (5, 15, "`surface.restitution` must be from 0 to 1")]),
    ("[surface]\nrestitution = 0.5", "[srufaec]\nrestitution = 1.5", &[(4, 2, "did you mean `surface`?")]),
    ("ratio = 1.2\n", "ratio = 1.2\n[Coin]\nratio = -1\n", &[(4, 2, "did you mean `coin`?")]),
    ("[engine.flat]\nlaw = 'moreau'", "[engine.Flat]\nlawv = 'moreau'", &[(9, 9, "did you mean `flat`?"), (10, 1, "did you mean `law`?")]),
    ("[engine.flat]\nlaw = 'moreau'", "[Engine.flat]\nlaw = 'moro'", &[(9, 2, "did you mean `engine`?"), (10, 7, "found `moro`")]),
    ("[coin]\nratio = 1.2\n", "", &[(10, 14, "`coin` is missing")]),
    ("ratio = 1.2\n", "", &[(2, 1, "`ratio` is missing in `coin`")]),
    ("seed = 1\n[coin]\nratio = 1.2", "coin = 3", &[(1, 8, "`coin` must be a table, found an integer: `3`")]),
    ("[coin]", "[[coin]]", &[(2, 1, "`coin` must be a table, found a list")]),
    ("[surface]\nrestitution = 0.5\nfriction = 0.3\n", "", &[(9, 14, "`surface` is missing (required unless the engine is analytic)")]),
    ("restitution = 0.5\n", "", &[(4, 1, "`restitution` is missing in `surface` (required unless landing = \"adhesive\" or `material` is given)")]),
    ("friction = 0.3", "friction = 0.3\nlanding = 'sticky'", &[(7, 11, "must be one of \"bouncing\", \"adhesive\", found `sticky`")]),
    ("[launch]\npreset = 'robot'\n", "", &[(10, 14, "`launch` is missing")]),
    ("[stop]\ntosses = 1000\n", "", &[(10, 15, "`stop` is missing")]),
    ("tosses = 1000\n", "", &[(11, 1, "`tosses` is missing in `stop` (required unless `half_width` is given or `relative_error` is given or `events` is given)")]),
    ("tosses = 1000", "tosses = 1000\nhalf_width = 0.01", &[(13, 14, "only one of `tosses`, `half_width` is allowed")]),
    ("tosses = 1000", "tosses = 1000\nmax_tosses = 2000", &[(13, 14, "`max_tosses` goes with `half_width` or `relative_error` or `events` only")]),
    ("tosses = 1000", "relative_error = 0.1\ntosses = 5", &[(13, 10, "only one of `tosses`, `relative_error` is allowed")]),
    ("tosses = 1000", "relative_error = 1.0", &[(12, 18, "`stop.relative_error` must be at least 1e-6 and below 1")]),
    ("tosses = 1000", "events = 0", &[(12, 10, "`stop.events` must be a whole number from 1")]),
    ("[engine.flat]\nlaw = 'moreau'\n", "", &[(10, 14, "One of `flat`, `volumetric`, `rapier`, `analytic`.")]),
    ("[engine.flat]\nlaw = 'moreau'", "[engine]", &[(9, 1, "`engine` is empty: it needs one of `flat`, `volumetric`, `rapier`, `analytic`")]),
    ("[engine.flat]", "[engine.falt]", &[(9, 9, "did you mean `flat`?")]),
    ("[engine.flat]", "[engine.analytic]\nrule = 'arc'\n[engine.flat]", &[(11, 9, "`engine` is already `analytic`: exactly one of `flat`, `volumetric`, `rapier`, `analytic`")]),
    ("[engine.flat]\nlaw = 'moreau'", "[engine.analytic]\nrule = 'arcs'", &[(10, 8, "did you mean \"arc\"?")]),
    ("[engine.flat]\nlaw = 'moreau'", "[engine.analytic]", &[(9, 1, "`rule` is missing in `engine.analytic`")]),
    ("[engine.flat]\nlaw = 'moreau'", "[engine]\nflat = 1", &[(10, 8, "`engine.flat` must be a table")]),
    ("'moreau'", "'moro'", &[(10, 7, "must be one of \"moreau\", \"chatterjee-ruina\", {gaek-sukhov = …}, {half-sine = …}, {line-contact = …}, found `moro`")]),
    ("law = 'moreau'", "decision = 'maybe'", &[(10, 12, "must be one of \"energy\", {energy_fraction = …}, found `maybe`")]),
];

#[rustfmt::skip]
const MOMENTS: &[Case] = &[
    ("1.2", "1.2\naxial_moment_kg_m2 = 1", &[(4, 22, "axial moment 1e0 kg m² is impossible")]),
    ("1.2", "1.2\ntransverse_moment_kg_m2 = [3e-7, 1, 2]", &[(4, 27, "transverse moment 1e0 kg m² is impossible")]),
    ("1.2", "[1.2, 1e-3]\naxial_moment_kg_m2 = 1e-9", &[(4, 22, "transverse moment")]),
];

#[rustfmt::skip]
const SYNTAX: &[Case] = &[
    ("1.2", "", &[(3, 9, "this is no TOML")]),
    ("1.2", "one", &[(3, 9, "this is no TOML: string values must be quoted")]),
    ("1.2", "[1, 2", &[(4, 1, "this is no TOML")]),
    ("[coin]", "[coin", &[(2, 6, "this is no TOML")]),
    ("seed = 1", "seed = 1\nseed = 2\npaired = 3", &[(2, 1, "`seed` is given twice"), (3, 10, "true or false")]),
    ("seed = 1", "seed == 1\nsede = 1", &[(1, 7, "this is no TOML")]),
    ("seed = 1", "seed = \"\u{1}\"", &[(1, 9, "this is no TOML")]),
    ("1.2", "010", &[(3, 9, "a number has no zeros in front: `10`")]),
    ("ratio = 1.2", "ratio := 1", &[(3, 7, "`ratio = 1`")]),
    ("ratio = 1.2", "ratio: 1", &[(3, 6, "`ratio = 1`")]),
    // a line without a value leaves the others as they are
    ("ratio = 1.2\n[surface]\nrestitution = 0.5\nfriction = 0.3", "ratio 1\n[surface]\nrestitution = 50%\nfriction = 3mm", &[(3, 7, "`ratio = 1`"), (5, 15, "`0.5`"), (6, 12, "unit")]),
];

fn check((from, to, expected): &Case) -> Result<(), String> {
    assert_eq!(
        GOOD.matches(from).count(),
        1,
        "a case replaces one piece: {from}"
    );
    let text = GOOD.replacen(from, to, 1);
    let Err(diagnostics) = config::parse("bad.toml", &text, &[]) else {
        return Err(format!("accepted:\n{text}"));
    };
    let found: Vec<_> = diagnostics
        .problems()
        .iter()
        .map(|p| {
            (
                p.line,
                p.column,
                format!("{} {}", p.message, p.help.as_deref().unwrap_or("")),
            )
        })
        .collect();
    let same = found.len() == expected.len()
        && found
            .iter()
            .zip(*expected)
            .all(|((line, column, message), (l, c, fragment))| {
                (line, column) == (l, c) && message.contains(fragment)
            });
    // rendering quotes the same places
    let rendered = diagnostics.render(false);
    let quoted = found
        .iter()
        .all(|(l, c, _)| rendered.contains(&format!("bad.toml:{l}:{c}\n")));
    if same && quoted {
        Ok(())
    } else {
        Err(format!(
            "{to:?}\n  expected {expected:?}\n  found    {found:?}\n{rendered}"
        ))
    }
}

fn check_all(cases: &[Case]) {
    let wrong: Vec<String> = cases.iter().filter_map(|case| check(case).err()).collect();
    assert!(
        wrong.is_empty(),
        "{} of {}:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n\n")
    );
}

#[test]
fn the_base_config_is_valid() {
    config::parse("good.toml", GOOD, &[]).unwrap();
}

#[test]
fn numbers_out_of_range_or_of_the_wrong_type() {
    check_all(NUMBERS);
}

#[test]
fn settings_of_the_engine_in_space() {
    check_all(VOLUMETRIC);
}

#[test]
fn unmodelled_physics_of_the_flat_engine() {
    check_all(NOT_FLAT);
}

#[test]
fn invalid_sweeps() {
    check_all(SWEEPS);
}

#[test]
fn invalid_launches() {
    check_all(LAUNCHES);
}

#[test]
fn missing_unknown_and_excess_tables_and_keys() {
    check_all(TABLES);
}

#[test]
fn impossible_moments_of_inertia() {
    check_all(MOMENTS);
}

#[test]
fn text_that_is_not_toml() {
    check_all(SYNTAX);
}

#[test]
fn all_problems_are_reported_at_once_sorted_by_location() {
    let text = "\
sede = 1
[coin]
ratio = 0
radius = 1
[surface]
restitution = 1.5
[launch]
preset = 'robt'
[engine.flat]
law = 'newton'
zeno = 7
[stop]
tosses = 1
half_width = 1
";
    let diagnostics = config::parse("bad.toml", text, &[]).unwrap_err();
    let places: Vec<_> = diagnostics
        .problems()
        .iter()
        .map(|p| (p.line, p.column))
        .collect();
    assert_eq!(
        places,
        [
            (1, 1),
            (3, 9),
            (4, 1),
            (5, 1),
            (6, 15),
            (8, 10),
            (10, 7),
            (11, 8),
            (14, 14),
            (14, 14)
        ]
    );
}

#[test]
fn an_empty_config_lists_everything_required() {
    let diagnostics = config::parse("empty.toml", "", &[]).unwrap_err();
    let messages: Vec<_> = diagnostics
        .problems()
        .iter()
        .map(|p| p.message.as_str())
        .collect();
    assert_eq!(messages.len(), 5, "{messages:?}");
    for (message, key) in messages
        .iter()
        .zip(["coin", "engine", "surface", "launch", "stop"])
    {
        assert!(
            message.starts_with(&format!("`{key}` is missing")),
            "{message}"
        );
    }
}

#[test]
fn thousands_of_problems_are_truncated() {
    let list = vec!["-1"; 50_000].join(", ");
    let text = GOOD.replace("1.2", &format!("[{list}]"));
    let diagnostics = config::parse("bad.toml", &text, &[]).unwrap_err();
    assert_eq!(diagnostics.problems().len(), 100);
    assert!(diagnostics.render(false).ends_with("and 49900 more"));
}

/// `coinmc calibrate` reads more tables than a run has.
#[test]
fn tables_of_measurements_are_told_from_mistyped_ones() {
    let helps = |table: &str| {
        let text = format!("{GOOD}\n{table}\nmaterial = 'wood'\n");
        let diagnostics = config::parse("bad.toml", &text, &[]).unwrap_err();
        let problems = diagnostics.problems().iter();
        problems
            .map(|problem| problem.help.clone().unwrap_or_default())
            .collect::<Vec<_>>()
    };
    for table in ["[prior]", "[[counts]]", "[[film]]", "[predict]"] {
        let [help] = &helps(table)[..] else {
            panic!("one problem of {table}")
        };
        assert!(help.starts_with("`coinmc calibrate` reads ["), "{help}");
    }
    assert!(helps("[priro]")[0].starts_with("allowed: "));
}

/// The other numbers of a preset stand in no text.
#[test]
fn a_distribution_that_an_override_empties_is_told_of_its_value() {
    let set = "launch.orientation.tilt_deg.uniform.from=200";
    let found = config::parse("good.toml", GOOD, &[set.parse().unwrap()]).unwrap_err();
    let [problem] = found.problems() else {
        panic!("{found}");
    };
    assert!(problem.message.contains("from 200 to 180 is empty"));
    assert_eq!((problem.source.as_str(), problem.column), ("--set", 42));
}

/// What beginners write instead of TOML is told at once, each with how to write it, and once a line.
#[test]
fn mistakes_of_syntax_are_told_at_once() {
    let text = "[coin]\nratio = 0,5\nradius_m = 1cm\n[surface]\nrestitution = .5\nfriction = 0.3\n[launch]\npreset = robot\n\
                [engine.flat]\n[stop]\ntosses = 1000\n";
    let found = config::parse("bad.toml", text, &[]).unwrap_err();
    let told = found.problems().iter().map(|problem| {
        let help = problem.help.as_deref().unwrap_or_default();
        (problem.line, help.to_owned())
    });
    let told: Vec<(usize, String)> = told.collect();
    let expected = [(2, "`0.5`"), (3, "unit"), (5, "`0.5`"), (8, "`\"robot\"`")];
    assert_eq!(told.len(), expected.len(), "{found}");
    for ((line, help), (expected, words)) in told.iter().zip(expected) {
        assert!(*line == expected && help.contains(words), "{found}");
    }
}
