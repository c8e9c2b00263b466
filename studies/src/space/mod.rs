//! Studies of the toss in space, one a file.

mod decision;
mod laws;
mod peers;
mod references;
mod sequential;

pub(crate) use decision::SpaceDecision;
pub(crate) use laws::SpaceLaws;
pub(crate) use peers::SpacePeers;
pub(crate) use references::SpaceReferences;

use coinmc_volumetric::Settings;

/// Every setting that trades error for time, tightened tenfold.
pub(crate) fn tightened(settings: &Settings) -> Settings {
    Settings {
        zeno: settings.zeno / 10.0,
        tolerance: settings.tolerance / 10.0,
        stick_speed: settings.stick_speed / 10.0,
        smoothing_time: settings.smoothing_time / 10.0,
        ..*settings
    }
}
