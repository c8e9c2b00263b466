//! What is not computed for the tosses of a point, and why that loses nothing.

use crate::plan::Point;
use coinmc_core::{EngineKind, Landing};
use coinmc_quadrature::Method;

/// Something that is not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Omission {
    Tosses,
    RandomTosses,
    FirstContact,
    OutOfPlane,
    Drag,
    GyroscopicTorque,
    Contact { rolling: bool },
    Tangential,
    Bounces,
    Contour,
    Pivoting,
}

impl Omission {
    /// What is omitted, and the reason.
    pub(super) fn reason(self) -> &'static str {
        match self {
            Self::Tosses => "tosses: the probability is known without them",
            Self::RandomTosses => {
                "random tosses: nothing bounces, and quadrature is sharper (sampling.method = \
                 \"random\" tosses all the same)"
            }
            Self::FirstContact => "the search for the first contact: its face is known before it",
            Self::OutOfPlane => "motion out of the xz plane: no launch of this config leaves it",
            Self::Drag => "drag: both of its rates are 0",
            Self::GyroscopicTorque => {
                "gyroscopic torque: switched off, the coin flies with a fixed angular velocity"
            }
            Self::Contact { rolling: false } => {
                "impacts, sliding and rocking: the first contact decides"
            }
            Self::Contact { rolling: true } => {
                "impacts, sliding, rolling and rocking: the first contact decides"
            }
            Self::Tangential => "the tangential half of impacts and contacts: friction is 0",
            Self::Bounces => "sequences of bounces: restitution is 0",
            Self::Contour => {
                "contour (rolling) friction: rolling_friction_m is 0, pure rolling loses nothing"
            }
            Self::Pivoting => {
                "pivoting friction: pivoting_friction_m is 0, pure pivoting loses nothing"
            }
        }
    }
}

/// Everything that is omitted from the tosses of a point, or from its integration by a method.
pub(super) fn omissions(point: &Point, integrated: Option<Method>) -> Vec<Omission> {
    let (scene, surface) = (&point.scene, &point.scene.surface);
    let mut omissions = Vec::new();
    let mut omit = |omission, holds: bool| {
        if holds {
            omissions.push(omission);
        }
    };
    let in_space = match point.engine.descriptor().kind {
        EngineKind::ClosedForm => return vec![Omission::Tosses],
        EngineKind::Planar => false,
        EngineKind::Spatial => true,
    };
    omit(Omission::RandomTosses, integrated.is_some());
    let decided = integrated.is_some_and(|method| method != Method::Tossed);
    omit(Omission::FirstContact, decided);
    omit(Omission::OutOfPlane, !in_space);
    omit(Omission::Drag, in_space && scene.drag().is_none());
    omit(Omission::GyroscopicTorque, !scene.has_gyroscopic_torque());
    if surface.landing() == Landing::Adhesive {
        omit(Omission::Contact { rolling: in_space }, true);
        return omissions;
    }
    omit(Omission::Tangential, surface.friction() == 0.0);
    omit(Omission::Bounces, surface.restitution() == 0.0);
    omit(
        Omission::Contour,
        in_space && surface.rolling_friction_m() == 0.0,
    );
    omit(
        Omission::Pivoting,
        in_space && surface.pivoting_friction_m() == 0.0,
    );
    omissions
}
