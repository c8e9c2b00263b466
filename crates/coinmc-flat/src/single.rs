//! Single impacts, to study a law or to compare it with film.

use crate::engine::FlatEngine;
use crate::impact_law::{ImpactLaw, Resolution};
use crate::motion::Motion;
use crate::parameters::Parameters;
use coinmc_core::{Breaks, Launch, State};

/// One impact: the coin just before and just after, and measurements of what happened in between.
#[derive(Debug, Clone, Copy)]
pub struct SingleImpact {
    /// The coin with its lowest corner on the surface, just before.
    pub before: State,
    /// The coin just after; its time is the duration of the impact.
    pub after: State,
    /// Whether the corner stays on the surface.
    pub stays: bool,
    /// Largest normal force at any step, N; 0 for laws without duration.
    pub peak_force_n: f64,
    /// Steps of the integration; 0 for laws without duration.
    pub steps: u32,
    /// Error of the energy balance, J: energy before, minus after, minus stored, minus taken by
    /// damping and friction.
    pub imbalance_j: f64,
    /// Energy gained by the law, J, before it was removed from the velocities; 0 if there was none.
    pub gain_j: f64,
    /// Where the law broke down.
    pub breaks: Breaks,
}

impl<L: ImpactLaw> FlatEngine<L> {
    /// The impact of a coin with this velocity, spin and tilt whose lowest corner has just touched.
    /// The height of the launch is ignored. This is the law itself: no bounces are collapsed.
    pub fn impact_once(&self, launch: &Launch) -> SingleImpact {
        let Parameters {
            units,
            shape,
            mass_kg,
            ..
        } = &self.parameters;
        let mut motion = Motion::new(launch, units, shape);
        motion.z = coinmc_lanes::sin_cos(motion.delta).1;
        let before = motion;
        let mut breaks = Breaks::default();
        let energy = before.energy(shape.k);
        let (resolution, record) = self.parameters.apply_law(&mut motion, &mut breaks);
        let gain = (motion.energy(shape.k) - energy).max(0.0);
        if resolution == Resolution::StaysInContact {
            self.parameters.stop_normal_motion(&mut motion, energy);
        }
        motion.cap_energy(shape.k, energy);
        let force = mass_kg * units.length_m / (units.time_s * units.time_s);
        SingleImpact {
            before: before.state(units, shape),
            after: motion.state(units, shape),
            stays: resolution == Resolution::StaysInContact,
            peak_force_n: record.peak_force * force,
            steps: record.steps,
            imbalance_j: record.imbalance * force * units.length_m,
            gain_j: gain * force * units.length_m,
            breaks,
        }
    }
}
