//! Fits of laws with parameters of their own.

use coinmc_core::Coin;
use coinmc_film::{
    FilmedDrop, Fit, GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, Model, Options,
    Parameter, PulseTime, Shared, Synthetic, compare, fit, fit_all, parameters,
};

fn model(law: Law) -> Model {
    Model {
        law,
        coin: Coin::cylinder(1.0, 0.01).unwrap().with_mass(0.01).unwrap(),
        gravity_m_s2: 9.81,
    }
}

fn gaek_sukhov(eta_n_s: f64) -> Law {
    Law::GaekSukhov(GaekSukhov {
        eta_n_s,
        lever: Lever::Height,
    })
}

fn pulse(time_s: f64) -> Law {
    Law::HalfSine(HalfSine {
        time: PulseTime::Given(time_s),
        peak_n: None,
    })
}

fn line() -> Law {
    let materials = Materials {
        coin_young_pa: 3e9,
        coin_poisson: 0.35,
        surface_young_pa: 1e10,
        surface_poisson: 0.35,
        length_m: 0.02,
    };
    Law::LineContact(LineContact {
        materials,
        tangential: LineContact::mindlin(0.35),
    })
}

/// A film of a tilted, turning coin until after its first bounce.
fn film(law: Law) -> FilmedDrop {
    let drop = Synthetic {
        start: [0.0, 0.3, 0.1, 0.0, 0.9, -2.0],
        duration_s: 0.22,
        ..Synthetic::default()
    };
    drop.film(&model(law)).unwrap()
}

fn one_bounce() -> Options {
    Options {
        bounces: 1,
        ..Options::default()
    }
}

/// Within twice the 95 % interval: fails by chance once in ten thousand.
fn is_found(fit: &Fit, parameter: Parameter, truth: f64) -> bool {
    let found = fit.estimate(parameter).unwrap();
    let (lo, hi) = (found.lo.unwrap(), found.hi.unwrap());
    println!("{}: {found:?}", parameter.name());
    (found.value - truth).abs() < hi - lo && hi - lo < 0.5 * truth
}

#[test]
fn restitution_and_eta_of_gaek_and_sukhovs_law_are_found() {
    let drop = film(gaek_sukhov(2e-3));
    // from a wrong initial η
    let fit = fit(&model(gaek_sukhov(1e-3)), &[drop], &one_bounce()).unwrap();
    let names: Vec<_> = fit.parameters.iter().map(|e| e.parameter).collect();
    assert_eq!(names, [Parameter::Restitution, Parameter::Eta]);
    assert!(is_found(&fit, Parameter::Restitution, 0.5));
    assert!(is_found(&fit, Parameter::Eta, 2e-3));
    assert_eq!(
        fit.shared.eta_n_s,
        fit.estimate(Parameter::Eta).unwrap().value
    );
}

/// η is kept if it is not fitted.
#[test]
fn parameters_that_are_not_fitted_keep_their_values() {
    let drop = film(gaek_sukhov(2e-3));
    let options = Options {
        free: vec![Parameter::Restitution, Parameter::Friction],
        ..one_bounce()
    };
    let fit = fit(&model(gaek_sukhov(2e-3)), &[drop], &options).unwrap();
    assert_eq!(fit.parameters.len(), 1);
    assert_eq!(fit.shared.eta_n_s, 2e-3);
    assert!(is_found(&fit, Parameter::Restitution, 0.5));
}

/// The duration of a pulse of 5 ms, longer than a frame, is found.
#[test]
fn the_length_of_a_half_sine_is_found() {
    let drop = film(pulse(5e-3));
    let options = Options {
        free: vec![
            Parameter::Restitution,
            Parameter::Friction,
            Parameter::PulseTime,
        ],
        ..one_bounce()
    };
    let fit = fit(&model(pulse(2e-3)), &[drop], &options).unwrap();
    let found = fit.estimate(Parameter::PulseTime).unwrap();
    let (lo, hi) = (found.lo.unwrap(), found.hi.unwrap());
    assert!((found.value - 5e-3).abs() < hi - lo, "{found:?}");
    assert!(hi - lo < 5e-3, "{found:?}");
}

/// The line contact from its own film. (A film cannot distinguish stiff contact from stiffer.)
#[test]
fn restitution_of_a_line_contact_is_found() {
    let drop = film(line());
    let options = Options {
        free: vec![Parameter::Restitution],
        shared: Shared {
            friction: 0.2,
            ..Shared::default()
        },
        ..one_bounce()
    };
    let fit = fit(&model(line()), &[drop], &options).unwrap();
    assert!(is_found(&fit, Parameter::Restitution, 0.5));
}

/// Each drop is described best by the law that made it, by a decisive margin.
#[test]
fn the_law_that_made_the_drop_is_preferred() {
    for [truth, other] in [[gaek_sukhov(2e-3), Law::Moreau], [pulse(5e-3), Law::Moreau]] {
        let models = [other, truth].map(model);
        let fits = fit_all(&models, &[film(truth)], &one_bounce()).unwrap();
        let ranked = compare(&fits);
        assert_eq!(fits[ranked[0].fit].model.law.name(), truth.name());
        assert!(ranked[1].delta_aic > 10.0, "{}: {ranked:?}", truth.name());
    }
}

#[test]
fn each_law_has_its_own_parameters() {
    let names = |law| parameters(law).iter().map(|p| p.name()).collect::<Vec<_>>();
    assert_eq!(
        names(gaek_sukhov(1.0)),
        ["restitution", "eta_n_s", "floor_m"]
    );
    assert_eq!(
        names(pulse(1.0)),
        ["restitution", "friction", "time_s", "floor_m"]
    );
    assert_eq!(
        names(line()),
        ["restitution", "friction", "stiffness", "floor_m"]
    );
    assert!(model(gaek_sukhov(-1.0)).validate().is_err() && model(line()).validate().is_ok());
}
