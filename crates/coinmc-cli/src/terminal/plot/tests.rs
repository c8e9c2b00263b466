use super::*;
use coinmc_analytic::Rule;

fn curve(label: &str, shift: f64, arm: f64, steps: u32) -> Curve {
    let marks = (0..=steps)
        .map(|i| {
            let x = 0.5 + 2.0 * f64::from(i) / f64::from(steps);
            let y = Rule::Arc.p_side(x) - shift;
            Mark {
                x,
                y,
                lo: y - arm,
                hi: y + arm,
            }
        })
        .collect();
    Curve {
        label: label.to_owned(),
        marks,
    }
}

fn plot<'a>(curves: &'a [Curve], arc: &'a dyn Fn(f64) -> f64) -> Plot<'a> {
    Plot {
        x_label: "ratio H/R",
        y_label: "P(side)",
        curves,
        reference: Some(Reference {
            label: "arc rule",
            y: arc,
        }),
        level: Some(Level {
            label: "1/3",
            y: 1.0 / 3.0,
        }),
    }
}

#[test]
fn two_curves_with_reference_level_and_legend() {
    let curves = [
        curve("restitution 0.3", 0.05, 0.001, 5),
        curve("restitution 0.5", 0.1, 0.04, 5),
    ];
    let text = plot(&curves, &|x| Rule::Arc.p_side(x))
        .render(&Style::plain(60))
        .unwrap();
    assert_eq!(text, include_str!("two_curves.txt"), "\n{text}");
}

#[test]
fn ascii_is_ascii() {
    let curves = [curve("a", 0.1, 0.04, 5)];
    let text = plot(&curves, &|x| Rule::Arc.p_side(x))
        .render(&Style::ascii(60))
        .unwrap();
    assert!(text.is_ascii(), "{text}");
    assert!(text.contains('|') && text.contains("o a"));
}

#[test]
fn every_line_fits() {
    let curves: Vec<Curve> = (0..12)
        .map(|i| curve(&format!("restitution {i}, friction {i}"), 0.01, 0.0, 40))
        .collect();
    for width in [60, 61, 80, 133, 500] {
        let text = plot(&curves, &|x| Rule::Arc.p_side(x))
            .render(&Style::plain(width))
            .unwrap();
        for line in text.lines() {
            assert!(line.chars().count() <= width, "{width}: {line}");
        }
        assert!(text.contains("(4 more curves not drawn)"));
    }
}

#[test]
fn a_single_ratio_or_no_finite_point_is_not_drawn() {
    let mut single = curve("", 0.0, 0.0, 1);
    single.marks.truncate(1);
    assert!(
        plot(&[single], &|_| 0.5)
            .render(&Style::plain(80))
            .is_none()
    );
    let mut gone = curve("", 0.0, 0.0, 3);
    gone.marks.iter_mut().for_each(|mark| mark.x = f64::NAN);
    assert!(plot(&[gone], &|_| 0.5).render(&Style::plain(80)).is_none());
    assert!(plot(&[], &|_| 0.5).render(&Style::plain(80)).is_none());
}

#[test]
fn points_without_a_probability_are_skipped() {
    let mut partly = curve("", 0.0, 0.0, 3);
    partly.marks[1].y = f64::NAN;
    partly.marks[1].lo = f64::NAN;
    let text = plot(&[partly], &|_| f64::NAN)
        .render(&Style::plain(80))
        .unwrap();
    assert_eq!(text.matches('●').count(), 3);
}
