use super::*;
use crate::tosses::point_with;
use coinmc_core::Roughness;

fn parsed(surface: &str, more: &str) -> Result<Observations, CalibrationError> {
    let text = format!(
        "coin.ratio = 0.2\ncoin.radius_m = 0.01\nsurface = {surface}\nlaunch.preset = 'hand'\n\
         engine.volumetric = {{}}\n{more}"
    );
    Observations::parse("inline", &text, &[], "".as_ref())
}

/// The slope of rough ground is believed to be that of the material within a factor of 3, and surfaces of
/// the design have theirs and the wavelength of the scene.
#[test]
fn the_slope_of_rough_ground_is_calibrated() {
    let observed = parsed("{ material = 'wood' }", "").unwrap();
    assert_eq!(observed.parameters(), Parameter::ALL);
    let slope = &observed.priors[4];
    assert!((slope.low - 0.05 / 3.0).abs() < 1e-12 && (slope.high - 0.15).abs() < 1e-12);
    let values = [0.4, 0.2, 1e-5, 1e-6, 0.02];
    let point = point_with(&observed.plan, &observed.parameters(), &values).unwrap();
    let ground = point.scene.surface.roughness().unwrap();
    assert_eq!((ground.slope(), ground.wavelength_m()), (0.02, 3e-3));
    // beyond the model's range it is at its end
    let carpet = parsed("{ material = 'carpet' }", "").unwrap();
    assert_eq!(carpet.priors[4].high, Roughness::MAX_SLOPE);
    assert_eq!(carpet.priors[4].value(9.0), Roughness::MAX_SLOPE);
    let known = observed.with_known_ground();
    assert_eq!(known.parameters(), Parameter::ALL[..4]);
    let point = point_with(&known.plan, &known.parameters(), &values[..4]).unwrap();
    let ground = point.scene.surface.roughness().unwrap();
    assert_eq!(ground.slope(), 0.05);
}

#[test]
fn a_plane_has_no_slope_to_calibrate() {
    let plane = "{ restitution = 0.5, friction = 0.3 }";
    assert_eq!(parsed(plane, "").unwrap().parameters(), Parameter::ALL[..4]);
    let error = parsed(plane, "prior.roughness_slope = { low = 0.01, high = 0.1 }");
    let message = error.unwrap_err().to_string();
    assert!(message.contains("a plane, which has no slope"), "{message}");
    let wide = "prior.roughness_slope = { low = 0.01, high = 0.3 }";
    assert!(parsed("{ material = 'wood' }", wide).is_err());
}

/// A prior of what the tosses do not depend on is refused, all of it at once.
#[test]
fn an_engine_in_the_plane_has_no_friction_lengths() {
    let config = "coin.ratio = 0.2\ncoin.radius_m = 0.01\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                  launch.preset = 'robot'\nengine.flat = {}\n";
    let parsed = |prior: &str| {
        let text = format!("{config}[prior]\n{prior}");
        Observations::parse("inline", &text, &[], "".as_ref())
    };
    assert_eq!(parsed("").unwrap().parameters(), Parameter::ALL[..2]);
    let error = parsed(
        "rolling_friction_m = { low = 1e-5, high = 1e-4 }\npivoting_friction_m = { low = 1e-6, high = 1e-5 }",
    );
    let message = error.unwrap_err().to_string();
    let expected = "this engine knows no rolling friction, no pivoting friction";
    assert!(message.contains(expected), "{message}");
}

/// Where a key says readings, it takes as many as the others, or one for all.
#[test]
fn one_reading_stands_for_all() {
    let plane = "{ restitution = 0.5, friction = 0.3 }";
    let value = |table: &str| parsed(plane, table).unwrap().readings[0].value;
    let many = "[[spin_down]]\nfrom_rad_s = [40, 40, 40]\nto_rad_s = [20, 21, 22]\ntime_s = [9.5, 9.5, 9.5]";
    for one in ["from_rad_s = 40", "time_s = 9.5"] {
        let key = one.split(' ').next().unwrap();
        let lines = many
            .lines()
            .map(|line| if line.starts_with(key) { one } else { line });
        let lines: Vec<&str> = lines.collect();
        assert_eq!(value(&lines.join("\n")), value(many), "{one}");
    }
    let there = "[[roll_out]]\nramp_height_m = 0.01\ndistance_m = 3\ndistance_back_m = [3, 3.1]";
    let both =
        "[[roll_out]]\nramp_height_m = 0.01\ndistance_m = [3, 3]\ndistance_back_m = [3, 3.1]";
    assert_eq!(value(there), value(both));
    let told = parsed(
        plane,
        "[[roll_out]]\nramp_height_m = [0.01, 0.02]\ndistance_m = [3, 3, 3]",
    );
    let told = told.unwrap_err().to_string();
    assert!(
        told.contains("`ramp_height_m` has 2 readings, but another key of this table has 3"),
        "{told}"
    );
}

/// All problems of all tables at once.
#[test]
fn every_table_says_what_is_wrong_with_it() {
    let plane = "{ restitution = 0.5, friction = 0.3, restitution_exponent = 0.1 }";
    let bounces = "[[bounces]]\ntime_s = [0.0, 0.2, 0.3]\n";
    let Err(CalibrationError::Config(found)) = parsed(plane, &bounces.repeat(2)) else {
        panic!("refused");
    };
    assert_eq!(found.problems().len(), 2, "{found}");
    let told =
        "[prior]\nrestitution = { low = 0.7, high = 0.3 }\nfriction = { low = 0.2, high = 0.2 }";
    let told = parsed("{ restitution = 0.5, friction = 0.3 }", told)
        .unwrap_err()
        .to_string();
    assert!(
        told.contains("`low` must be below `high`, here of restitution, friction"),
        "{told}"
    );
}

#[test]
fn a_prior_says_whether_the_config_gives_its_number() {
    let observed = parsed(
        "{ restitution = 0.5, friction = 0.31, rolling_friction_m = 4e-5 }",
        "",
    )
    .unwrap();
    let sources: Vec<&str> = observed.priors.iter().map(|prior| &*prior.source).collect();
    assert_eq!(sources[2], "around the rolling_friction_m of the config");
    assert_eq!(
        sources[3],
        "around the usual pivoting friction: the config gives none"
    );
}

/// Each file of filmed drops has a message of its own, on one line; what is no plain file is not opened.
#[cfg(unix)]
#[test]
fn every_bad_film_is_told() {
    let text = "coin.ratio = 0.2\ncoin.radius_m = 0.01\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
                engine.volumetric = {}\n[[film]]\nfiles = ['no.txt', '/dev/zero', '', 'src', 'README.md']\n";
    let folder = env!("CARGO_MANIFEST_DIR").as_ref();
    let Err(CalibrationError::Config(found)) = Observations::parse("inline", text, &[], folder)
    else {
        panic!("films that are none");
    };
    let messages: Vec<&str> = found
        .problems()
        .iter()
        .map(|one| one.message.as_str())
        .collect();
    assert!(messages[0].contains("no.txt: No such file"), "{messages:?}");
    assert_eq!(messages[1], "/dev/zero: it is not a plain file");
    assert_eq!(messages[2], "`files` has an empty name");
    assert!(messages[3].contains("src: is a directory"), "{messages:?}");
    assert!(
        messages[4].contains("README.md: no line names columns"),
        "{messages:?}"
    );
    assert_eq!(messages.len(), 5);
    assert!(
        found
            .problems()
            .iter()
            .all(|one| one.line == 6 && !one.message.contains('\n'))
    );
}

/// Lists are read up to a length, beyond which a few kilobytes would cost gigabytes.
#[test]
fn the_length_of_a_list_of_readings_is_bounded() {
    let list = |count: u32| {
        let times: Vec<String> = (0..count).map(|i| format!("{}.0", 3 * i)).collect();
        times.join(", ")
    };
    let wood = "{ material = 'wood' }";
    let bounces = |count| parsed(wood, &format!("[[bounces]]\ntime_s = [{}]", list(count)));
    assert_eq!(bounces(200).unwrap().readings.len(), 1);
    let message = bounces(201).unwrap_err().to_string();
    assert!(
        message.contains("at most 200 impacts are allowed"),
        "{message}"
    );
    let tilts = format!("[[tilt]]\nangle_deg = [{}]", vec!["17"; 10_001].join(", "));
    let message = parsed(wood, &tilts).unwrap_err().to_string();
    assert!(message.contains("10000 at most are allowed"), "{message}");
}

/// A table with a sweep of its own is refused, and those after it are not even built: each could have a million points.
#[test]
fn a_table_with_a_sweep_of_its_own_is_refused_before_those_after_it() {
    let table =
        "[[tilt]]\nangle_deg = 17\ncoin.ratio = { from = 0.1, to = 1.0, steps = 1000000 }\n";
    let error = parsed("{ material = 'wood' }", &table.repeat(900));
    let message = error.unwrap_err().to_string();
    let told = message.matches("one scene, but sweeps ratio").count();
    assert_eq!(told, 1, "{message}");
}

/// The tangent has no value beyond 90 degrees, and so no error there.
#[test]
fn an_error_that_reaches_ninety_degrees_is_refused() {
    let wood = "{ material = 'wood' }";
    let tilt = |readings: &str| parsed(wood, &format!("[[tilt]]\n{readings}"));
    for readings in [
        "angle_deg = 75\nangle_error_deg = 20",
        "angle_deg = 89.999\nangle_error_deg = 45",
        "angle_deg = [88.9, 89.9]\nangle_error_deg = 1",
    ] {
        let message = tilt(readings).unwrap_err().to_string();
        assert!(message.contains("reach 90 degrees"), "{message}");
    }
    assert!(tilt("angle_deg = 75\nangle_error_deg = 14.9").is_ok());
    let message = tilt("angle_deg = []").unwrap_err().to_string();
    assert!(message.contains("at least one number"), "{message}");
}

/// The examples' film by a law that is not its own: what its fit says of itself is passed on. Without a law it is the
/// engine's, which made the film with a restitution of ½.
#[test]
fn doubts_of_a_film_are_passed_on() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let film = |files: &str| {
        let text = format!(
            "coin.ratio = 1\ncoin.radius_m = 0.01\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
             engine.volumetric = {{}}\n{files}"
        );
        Observations::parse("inline", &text, &[], examples.as_ref())
    };
    let own = film("[[film]]\nfiles = ['drop-film.txt']").unwrap();
    assert!(own.film_remarks.is_empty(), "{:?}", own.film_remarks);
    assert!((own.readings[0].value - 0.5).abs() < 2e-3);
    let other = "[[film]]\nlaw = 'chatterjee-ruina'\nfiles = ['drop-film.txt']";
    let observed = film(other).unwrap();
    assert!((observed.readings[0].value - 0.5).abs() > 4e-3);
    let remark = &observed.film_remarks[0];
    assert!(
        remark.starts_with("film 1: residuals of x_m are correlated"),
        "{remark}"
    );
    for twice in [
        "[[film]]\nfiles = ['drop-film.txt', './drop-film.txt']",
        "[[film]]\nfiles = ['drop-film.txt']\n[[film]]\nfiles = ['drop-film.txt']",
    ] {
        let message = film(twice).unwrap_err().to_string();
        assert!(message.contains("give each film once"), "{message}");
    }
}
