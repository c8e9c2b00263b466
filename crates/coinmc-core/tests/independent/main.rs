//! Intervals, quantiles and launches of presets against tables that SciPy made of their definitions and
//! sources (`make.py`), without a line of ours.

use coinmc_core::{
    Coin, Estimate, IntervalMethod, Launch, Preset, UniformSource, student_t_quantile,
};

/// The rows of a table, without its header.
fn rows(table: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    table.lines().skip(1).map(|line| line.split(',').collect())
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// SciPy solves for Clopper and Pearson's ends to 1e-11 or so.
#[test]
fn intervals_are_those_of_scipy() {
    let mut compared = 0;
    for row in rows(include_str!("intervals.csv")) {
        let method = [IntervalMethod::Wilson, IntervalMethod::ClopperPearson]
            .into_iter()
            .find(|method| method.name() == row[0])
            .expect("one of ours");
        let [k, n] = [1, 2].map(|i: usize| row[i].parse().expect("a count"));
        let found = Estimate::new(k, 0, n, number(row[3]), method);
        let (lo, hi) = (number(row[4]), number(row[5]));
        assert!((found.lo - lo).abs() < 1e-10, "{row:?}: {found:?}");
        assert!((found.hi - hi).abs() < 1e-10, "{row:?}: {found:?}");
        let arm = (hi - found.p).max(found.p - lo);
        assert!((found.half_width() - arm).abs() < 1e-10, "{row:?}");
        compared += 1;
    }
    assert!(compared > 200);
}

#[test]
fn students_quantiles_are_those_of_scipy() {
    for row in rows(include_str!("student.csv")) {
        let (dof, tail, t) = (number(row[0]), number(row[1]), number(row[2]));
        let found = student_t_quantile(dof, tail);
        assert!((found / t - 1.0).abs() < 1e-9, "{row:?}: {found}");
    }
}

/// Uniforms from a table.
struct Given(Vec<f64>);

impl UniformSource for Given {
    fn uniform(&mut self, dimension: u32) -> f64 {
        self.0[dimension as usize]
    }
}

/// What presets are, to the turn of every angle: their constants from the sources that they name.
#[test]
fn presets_launch_as_their_sources_say() {
    let coin = Coin::cylinder(1.5, 0.01).expect("a coin");
    for preset in Preset::ALL {
        let mut compared = 0;
        for row in rows(include_str!("launches.csv")).filter(|row| row[0] == preset.name()) {
            let numbers: Vec<f64> = row[1..].iter().map(|text| number(text)).collect();
            let (uniforms, expected) = numbers.split_at(10);
            let Launch {
                height_m,
                velocity_m_s: v,
                axis: u,
                spin_rad_s: w,
            } = preset
                .distribution()
                .launch(&coin, &mut Given(uniforms.to_vec()));
            let found = [height_m, v.x, v.y, v.z, u.x, u.y, u.z, w.x, w.y, w.z];
            for (found, expected) in found.iter().zip(expected) {
                let scale = expected.abs().max(1.0);
                assert!((found - expected).abs() < 1e-9 * scale, "{row:?}: {found}");
            }
            compared += 1;
        }
        assert_eq!(compared, 12, "{preset}");
    }
}
