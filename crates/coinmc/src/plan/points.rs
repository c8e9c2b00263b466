//! The points of a plan.

use super::Point;
use crate::OnDemand;
use coinmc_quadrature::Method;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// The points of a plan, in order. Those of a large sweep are made when they are asked for: see
/// [`OnDemand`].
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    points: OnDemand<Point>,
    /// How each can be answered. It is asked for again and again, and fits into a few bytes a point.
    ways: Arc<[Way]>,
}

/// How a point can be answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Way {
    /// Its engine makes tosses.
    pub(super) makes_tosses: bool,
    /// How it can be answered without counting them.
    pub(super) method: Option<Method>,
    /// That is a rule in closed form.
    pub(super) by_rule: bool,
}

impl Points {
    pub(crate) fn new(points: OnDemand<Point>, ways: Vec<Way>) -> Self {
        debug_assert_eq!(points.len(), ways.len());
        let ways = ways.into();
        Self { points, ways }
    }

    pub(super) fn way(&self, index: usize) -> Way {
        self.ways[index]
    }

    pub(super) fn ways(&self) -> &[Way] {
        &self.ways
    }
}

impl Way {
    pub(crate) fn of(point: &Point) -> Self {
        let limit_s = point.engine.flight_limit_s(&point.scene);
        let method = limit_s.and_then(|s| Method::of(&point.scene, &point.launches, s));
        Self {
            makes_tosses: point.engine.makes_tosses(),
            method,
            by_rule: method.is_some_and(|method| method.by_rule(&point.scene).is_some()),
        }
    }
}

impl Deref for Points {
    type Target = OnDemand<Point>;

    fn deref(&self) -> &OnDemand<Point> {
        &self.points
    }
}

impl DerefMut for Points {
    fn deref_mut(&mut self) -> &mut OnDemand<Point> {
        &mut self.points
    }
}
