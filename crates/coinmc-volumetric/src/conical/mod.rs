//! Coins with a conical edge: the frustum of a cone, of which heads and tails differ.
//!
//! A coin on one rim moves as the mirrored cylinder does, with R and h of that rim: nothing in the
//! equations of impact and contact asks for the other one. So there is a [`Model`] for each lower rim, and
//! this module changes between them. The frame's axis points away from the lower rim. It may lean up to
//! the tilt at which the edge lies on the surface: short of π/2 on the narrower rim, and beyond it on the
//! wider one.
//!
//! What is different: the flight looks for the first contact of both rims (`flight`), the impacts of the
//! two rims of a coin on its edge alternate at that tilt (`impacts`), and on its edge the coin rolls in a
//! circle about the apex of the cone (`edge`, `on_edge`).
//!
//! A cylinder whose centre of mass is off the middle is the case of equal radii: its edge is its side, upright,
//! and the apex of its cone is infinitely far, so that it rolls straight on. Only its h and h' differ.
//!
//! Tosses are followed one by one, not in lanes.

mod edge;
mod flight;
mod impacts;
mod on_edge;

#[cfg(test)]
mod tests;

use crate::contact::{Exit, Usage};
use crate::finished_toss::FinishedToss;
use crate::flight::Departure;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::settings::{Settings, SettingsError};
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Ended, EventKind, Launch, LowerRim, Observer, Scene};
use edge::Edge;
use on_edge::FromRim;

/// Contact of one rim that lasts no longer than this, in sqrt(D/g), is none.
const INSTANT: f64 = 1e-9;

/// A coin with a conical edge, or with its centre of mass off the middle.
#[derive(Debug, Clone)]
pub(crate) struct Conical<L> {
    /// With heads up, on the rim of tails, and with tails up.
    models: [Model<L>; 2],
    edges: [Edge; 2],
}

impl<L: ImpactLaw> Conical<L> {
    /// `None` if heads and tails are mirror images.
    pub(crate) fn new(
        scene: &Scene,
        settings: &Settings,
        law: L,
    ) -> Result<Option<Self>, SettingsError> {
        if scene.coin.has_like_faces() {
            return Ok(None);
        }
        let rims = LowerRim::of(&scene.coin);
        let model = Model::new(scene, settings, law)?;
        let models = rims.map(|rim| model.clone().on_lower_rim(scene, settings, &rim));
        let edges = rims.map(|rim| Edge::new(&rim));
        Ok(Some(Self { models, edges }))
    }

    /// Simulates one toss.
    pub(crate) fn run<O: Observer>(&self, launch: &Launch, observer: &mut O) -> FinishedToss {
        let mut toss = self.launch(launch);
        let mut usage = Usage::default();
        self.notify(&toss, EventKind::Launched, observer);
        let ended = match self.model(&toss).end_at_launch(&toss, launch) {
            Some(ended) => ended,
            None => self.follow(&mut toss, &mut usage, observer),
        };
        self.notify(&toss, EventKind::Ended, observer);
        FinishedToss::new(self.model(&toss), ended, &toss, &usage)
    }

    /// Alternates flight and contact with the surface until the toss ends.
    fn follow<O: Observer>(&self, toss: &mut Toss, usage: &mut Usage, observer: &mut O) -> Ended {
        let mut departure = Departure::Launched;
        loop {
            let gave_up = !self.fly(toss, usage, departure, observer);
            if gave_up || (O::ACTIVE && observer.has_seen_enough()) {
                return self.model(toss).end_given_up(toss);
            }
            if let Some(ended) = self.model(toss).end_at_landing(toss, usage.time) {
                return ended;
            }
            match self.on_surface(toss, usage, observer) {
                Ok(next) => departure = next,
                Err(ended) => return ended,
            }
        }
    }

    /// Impacts and sustained contact until the coin departs again, or the toss ends.
    fn on_surface<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        observer: &mut O,
    ) -> Result<Departure, Ended> {
        toss.rim_changes = 0;
        let mut next = Transition::Impact;
        loop {
            next = match next {
                Transition::Impact => self.impact(toss, usage, observer),
                // there is no rough ground
                Transition::Contact | Transition::NearGround => {
                    self.follow_contact(toss, usage, observer)
                }
                Transition::Flight(departure) => return Ok(departure),
                Transition::End(ended) => return Err(ended),
            }
        }
    }

    /// Follows sustained contact of the lowest point to its end.
    fn follow_contact<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        observer: &mut O,
    ) -> Transition {
        let model = self.model(toss);
        model.note_contact(toss);
        let before = usage.time;
        let mut solver = model.contact_solver(*usage);
        let (motion, spin, mut adapter) = toss.observed(&model.units, observer);
        let exit = solver.follow(motion, spin, &mut adapter);
        *usage = solver.usage;
        match exit {
            // The end or the beginning of a slip has turned the coin back. The impact that would follow could
            // lead here again, without end, and each time take energy.
            Exit::OtherRim if usage.time - before < INSTANT => {
                self.lie_on_edge(toss, usage, FromRim::AtOnce, observer)
            }
            Exit::OtherRim => {
                self.touch_with_edge(toss);
                toss.turn_over();
                Transition::Impact
            }
            Exit::LiftOff => {
                self.notify(toss, EventKind::LiftOff, observer);
                model.after_contact(toss, exit)
            }
            exit => model.after_contact(toss, exit),
        }
    }
}

impl<L> Conical<L> {
    /// The model of the rim on which the coin leans.
    pub(crate) fn model(&self, toss: &Toss) -> &Model<L> {
        &self.models[usize::from(!toss.heads_up)]
    }

    fn edge(&self, toss: &Toss) -> &Edge {
        &self.edges[usize::from(!toss.heads_up)]
    }

    fn notify<O: Observer>(&self, toss: &Toss, kind: EventKind, observer: &mut O) {
        self.model(toss).notify(toss, kind, observer);
    }

    /// A toss at its launch, in the frame of its lower rim.
    fn launch(&self, launch: &Launch) -> Toss {
        // by the sign of the axis first
        let heads_up = launch.axis.z.is_sign_positive();
        let model = &self.models[usize::from(!heads_up)];
        let mut toss = model.launch(launch);
        let (sin, cos) = (toss.motion.sin, toss.motion.cos);
        if self.edge(&toss).is_beyond(sin, cos) {
            toss.turn_over();
        }
        let body = &self.model(&toss).dynamics.body;
        toss.motion.z = toss.motion.z.max(toss.motion.rest_height(body));
        toss
    }

    /// Sets the tilt of a coin that is exactly on its edge.
    fn touch_with_edge(&self, toss: &mut Toss) {
        let edge = self.edge(toss);
        (toss.motion.sin, toss.motion.cos) = (edge.sin, edge.cos);
        toss.motion.z = edge.height;
    }
}
