//! Plans of every engine that tosses.

use coinmc::config;
use coinmc::plan::Plan;

/// A plan with these tables.
pub(crate) fn plan(engine: &str, launch: &str, tosses: u64) -> Plan {
    let text = format!(
        "seed = 7\n[coin]\nradius_m = 0.01\nratio = [0.4, 1.2]\n[surface]\nrestitution = 0.5\n\
         friction = 0.3\n{engine}\n[launch]\npreset = \"{launch}\"\n[stop]\ntosses = {tosses}\n"
    );
    config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// In the plane.
pub(crate) fn flat(law: &str, tosses: u64) -> Plan {
    plan(&format!("[engine.flat]\nlaw = \"{law}\""), "robot", tosses)
}

/// In space, with all kinds of friction.
pub(crate) fn space(law: &str, tosses: u64) -> Plan {
    let engine = format!(
        "rolling_friction_m = 1e-4\npivoting_friction_m = 1e-4\n[engine.volumetric]\nlaw = \"{law}\""
    );
    plan(&engine, "clean", tosses)
}

/// In space, onto a table that most coins leave.
pub(crate) fn table(tosses: u64) -> Plan {
    let engine = "rolling_friction_m = 1e-4\npivoting_friction_m = 1e-4\ntable_radius_m = 0.05\n\
                  [engine.volumetric]";
    plan(engine, "clean", tosses)
}

/// In space, with drag and without gyroscopic torque.
pub(crate) fn dragged(tosses: u64) -> Plan {
    let engine = "[environment]\nlinear_drag_per_s = 0.7\nangular_drag_per_s = 0.3\n\
                  gyroscopic_torque = false\n[engine.volumetric]";
    plan(engine, "clean", tosses)
}

/// In time steps.
#[cfg(feature = "rapier")]
fn stepped(tosses: u64) -> Plan {
    plan("[engine.rapier]", "clean", tosses)
}

/// One plan of each kind, with this many tosses per point.
pub(crate) fn all(tosses: u64) -> Vec<Plan> {
    #[allow(unused_mut, reason = "without Rapier there are no more")]
    let mut plans = event_driven(tosses);
    #[cfg(feature = "rapier")]
    plans.push(stepped(tosses));
    plans
}

/// The plans with exact events.
pub(crate) fn event_driven(tosses: u64) -> Vec<Plan> {
    vec![
        flat("moreau", tosses),
        flat("chatterjee-ruina", tosses),
        space("moreau", tosses),
        space("chatterjee-ruina", tosses),
        space("stronge", tosses),
        dragged(tosses),
    ]
}
