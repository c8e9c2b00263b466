//! What all tosses of one scene under one law of impact have in common.

use crate::contact::ContactParameters;
use crate::dead_contact::DeadContact;
use crate::impact_law::ImpactLaw;
use crate::motion::Units;
use crate::observer_adapter::ObserverAdapter;
use crate::settings::Settings;
use crate::settings_error::SettingsError;
use crate::shape::Shape;
use coinmc_core::{Landing, Scene};

/// The scene in units of D, sqrt(D/g) and m, the law of impact and the settings.
///
/// The single steps of a toss are its methods, each in a file of its own: `toss` launches it,
/// `impact` resolves an impact, `transition` says what follows. The `scalar` driver and the `batch`
/// driver combine them into tosses.
#[derive(Debug, Clone)]
pub(crate) struct Parameters<L> {
    pub(crate) law: L,
    pub(crate) settings: Settings,
    pub(crate) units: Units,
    pub(crate) shape: Shape,
    pub(crate) contact: ContactParameters,
    pub(crate) mass_kg: f64,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) landing: Landing,
    /// Half the length of the shorter edge, in D: the scale of all angles near an edge.
    pub(crate) half_short_edge: f64,
}

impl<L: ImpactLaw> Parameters<L> {
    pub(crate) fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        settings.validate()?;
        let shape = Shape::new(&scene.coin);
        let (height, half_width) = shape.base(0, true);
        let friction = scene.surface.friction();
        // proven for impacts that are an impulse within the cone of friction
        let dead = if L::BATCHED && scene.surface.restitution() == 0.0 && friction > 0.0 {
            DeadContact::new(&shape, friction)
        } else {
            DeadContact::NONE
        };
        Ok(Self {
            law,
            settings: *settings,
            units: Units::new(scene),
            shape,
            contact: ContactParameters {
                shape,
                friction,
                dead,
                tolerance: settings.tolerance,
                max_steps: settings.max_impacts,
            },
            mass_kg: scene.coin.mass_kg(),
            restitution: scene.surface.restitution(),
            friction,
            landing: scene.surface.landing(),
            half_short_edge: height.min(half_width),
        })
    }

    /// Shows motions to `observer` in SI units.
    pub(crate) fn adapter<'a, O>(&'a self, observer: &'a mut O) -> ObserverAdapter<'a, O> {
        ObserverAdapter {
            observer,
            units: &self.units,
            shape: &self.shape,
        }
    }
}
