//! How often a caught coin shows the side it started with: the flips of 48 people, and the angle ψ
//! between axis and angular momentum that each must have given the coin.
//!
//! By Diaconis, Holmes & Montgomery (SIAM Rev. 49 (2007) 211) a thin coin that is tossed level and caught
//! shows the same side with the probability ½ + asin(cot²ψ)/π, never below ½. The fitted ψ of each person
//! is then tossed, and the share of the same side compared with the person's.

use anyhow::Context;
use clap::Args;
use coinmc::config;
use coinmc::run::{Count, count};
use coinmc_analytic::precession::thin::{p_same_side, psi_rad};
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Estimate, IntervalMethod};
use std::sync::atomic::AtomicBool;

/// Counts of Bartoš et al., arXiv 2310.04153; see data/README.md.
const FLIPS: &str = include_str!("../../data/same-side.csv");

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SameSide {
    /// Tosses with the angle of each person
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,
}

/// The flips of a person.
struct Person {
    name: &'static str,
    same: u64,
    flips: u64,
}

impl SameSide {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let people = people()?;
        let columns = [
            "person",
            "flips",
            "same",
            "p_same",
            "psi_deg",
            "psi_lo_deg",
            "psi_hi_deg",
            "chi2",
            "tossed_p_same",
            "z",
        ];
        let title = format!("The same side as at the start, {} tosses each", self.tosses);
        let mut table = Table::new(title, &columns);
        let [mut own, mut engine] = [0.0; 2];
        for (person, index) in people.iter().zip(0..) {
            let psi = psi_deg(person.p());
            // each with random numbers of their own
            let tossed = self.toss(psi, seed + index)?;
            let chi2 = person.chi2(p_same_side(psi.to_radians()));
            let z = person.z(&tossed);
            own += chi2;
            engine += z * z;
            table.push(person.row(psi, chi2, &tossed, z));
        }
        let [same, flips] = people.iter().fold([0, 0], |[same, flips], person| {
            [same + person.same, flips + person.flips]
        });
        let common = same as f64 / flips as f64;
        let of_common: f64 = people.iter().map(|person| person.chi2(common)).sum();
        let below = people.iter().filter(|person| person.p() < 0.5).count();
        let mut report = Report::new(table);
        report.remark(format!(
            "all: {same} of {flips}, psi = {:.2} degrees; chi2 = {of_common:.1} with one psi for all of {} people",
            psi_deg(common),
            people.len()
        ));
        report.remark(format!(
            "a psi for each: chi2 = {own:.1}, all of it from the {below} people below 1/2, whose psi is 90 degrees"
        ));
        report.remark(format!(
            "tosses with these psi against the flips: chi2 = {engine:.1}"
        ));
        Ok(report)
    }

    /// The share of the same side of a thin coin that is tossed with this ψ and caught.
    fn toss(&self, psi_deg: f64, seed: u64) -> anyhow::Result<Estimate> {
        let text = format!(
            "seed = {seed}\ncoin = {{ ratio = 1e-6, radius_m = 0.012 }}\nstop.tosses = {}\n\
             surface = {{ landing = 'adhesive', restitution = 0.0, friction = 0.3 }}\n\
             engine.volumetric = {{}}\nsampling.method = 'random'\n[launch]\nheight_m = 1.0\n\
             velocity_m_s = [0, 0, 2.4]\norientation.tilt_deg = 0\n\
             spin.precessing.rate_rad_s.normal = {{ mean = 238.6, sd = 50.0 }}\n\
             spin.precessing.psi_deg = {psi_deg:?}\n",
            self.tosses
        );
        let plan = config::parse("same-side", &text, &[]);
        let plan = plan.map_err(|found| anyhow::anyhow!("{found}"))?;
        let cancel = AtomicBool::new(false);
        let options = Count {
            threads: None,
            cancel: &cancel,
            sink: &(),
        };
        let rows = count(&plan, &options)?.results.rows;
        rows[0].same.context("tosses tell it")
    }
}

/// The angle with which the coin shows the same side with this probability, or the nearest, degrees.
fn psi_deg(p_same: f64) -> f64 {
    psi_rad(p_same.clamp(0.5, 1.0)).to_degrees()
}

impl Person {
    fn p(&self) -> f64 {
        self.same as f64 / self.flips as f64
    }

    fn interval(&self) -> Estimate {
        Estimate::new(self.same, 0, self.flips, 0.95, IntervalMethod::Wilson)
    }

    /// The part of this person in χ² if the same side has this probability.
    fn chi2(&self, p: f64) -> f64 {
        let (n, x) = (self.flips as f64, self.same as f64);
        (x - n * p) * (x - n * p) / (n * p * (1.0 - p))
    }

    /// The standard normal deviate of the difference from tosses.
    fn z(&self, tossed: &Estimate) -> f64 {
        let variance = |p: f64, n: u64| p * (1.0 - p) / n as f64;
        let p = tossed.p;
        (self.p() - p) / (variance(p, self.flips) + variance(p, tossed.n)).sqrt()
    }

    fn row(&self, psi: f64, chi2: f64, tossed: &Estimate, z: f64) -> Vec<String> {
        let interval = self.interval();
        vec![
            self.name.to_owned(),
            self.flips.to_string(),
            self.same.to_string(),
            number::probability(self.p()),
            format!("{psi:.2}"),
            // the more precession the smaller the angle
            format!("{:.2}", psi_deg(interval.hi)),
            format!("{:.2}", psi_deg(interval.lo)),
            format!("{chi2:.2}"),
            number::probability(tossed.p),
            format!("{z:.2}"),
        ]
    }
}

/// The people in the order of the file.
fn people() -> anyhow::Result<Vec<Person>> {
    let person = |line: &'static str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, counts @ ..] = &cells[..] else {
            anyhow::bail!("an empty line");
        };
        let counts: Vec<u64> = counts
            .iter()
            .map(|count| count.parse())
            .collect::<Result<_, _>>()?;
        let [heads_same, heads_other, tails_same, tails_other] = counts[..] else {
            anyhow::bail!("four counts are needed: {line}");
        };
        Ok(Person {
            name,
            same: heads_same + tails_same,
            flips: heads_same + heads_other + tails_same + tails_other,
        })
    };
    FLIPS.lines().skip(1).map(person).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The totals that the paper states.
    #[test]
    fn all_flips_are_there() {
        let people = people().expect("a table");
        let same: u64 = people.iter().map(|person| person.same).sum();
        let flips: u64 = people.iter().map(|person| person.flips).sum();
        assert_eq!((people.len(), same, flips), (48, 178_078, 350_757));
    }
}
