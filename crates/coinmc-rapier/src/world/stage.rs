//! The world of one precision: `super::rapier` is that precision's crate.

// `Real` is f64 in one of the two precisions and f32 in the other: the casts are those of the other
#![allow(
    clippy::unnecessary_cast,
    clippy::cast_possible_truncation,
    clippy::cast_lossless
)]

use super::rapier::dynamics::{
    CoefficientCombineRule, FrictionModel as Friction, IntegrationParameters, MassProperties,
    RigidBodyBuilder, RigidBodyHandle,
};
use super::rapier::geometry::{
    BroadPhaseBvh, BvhOptimizationStrategy, ColliderBuilder, ColliderHandle, ContactPair, Group,
    InteractionGroups, InteractionTestMode,
};
use super::rapier::math::{Pose, Real, Rotation, Vector};
use super::rapier::pipeline::PhysicsWorld;
use crate::body::Scaled;
use crate::motion::Motion;
use crate::settings::{FrictionModel, Settings};
use crate::world::World;
use nalgebra::{Unit, Vector3};

/// A half-space, coins above it, and Rapier's pipeline.
pub(crate) struct Stage {
    world: PhysicsWorld,
    body: RigidBodyBuilder,
    shape: ColliderBuilder,
    seats: Vec<Option<Seat>>,
}

/// A coin.
struct Seat {
    coin: RigidBodyHandle,
    shell: ColliderHandle,
    restitution: Real,
    /// A step was made since the coin was placed: there may be contacts that remember it.
    marked: bool,
}

/// The group of the surface and that of coins: a coin meets the surface alone.
const SURFACE: Group = Group::GROUP_1;
const COINS: Group = Group::GROUP_2;

impl Stage {
    pub(crate) fn new(scaled: &Scaled, settings: &Settings, step: f64) -> Self {
        // a tree of a few boxes that all overlap needs no care
        let mut broad_phase =
            BroadPhaseBvh::with_optimization_strategy(BvhOptimizationStrategy::None);
        broad_phase.adaptive_change_detection_margin = true;
        let mut world = PhysicsWorld {
            gravity: Vector::new(0.0, 0.0, -1.0),
            broad_phase,
            ..PhysicsWorld::default()
        };
        set_parameters(&mut world.integration_parameters, settings, step as Real);
        let ground = ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Z))
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups(SURFACE, COINS))
            .friction(0.0)
            .restitution(0.0);
        world.insert_collider(ground, None);
        let body = &scaled.body;
        let shape = ColliderBuilder::cylinder(body.half as Real, body.radius as Real)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups(COINS, SURFACE))
            .density(0.0)
            .friction(scaled.friction as Real)
            .restitution(scaled.restitution as Real);
        let inertia = Vector::new(body.kt as Real, body.ka as Real, body.kt as Real);
        let coin = RigidBodyBuilder::dynamic()
            .additional_mass_properties(MassProperties::new(Vector::ZERO, 1.0, inertia))
            .linear_damping(scaled.linear_drag as Real)
            .angular_damping(scaled.angular_drag as Real)
            .gyroscopic_forces_enabled(
                settings.gyroscopic.is_rapiers() && scaled.axial_factor != 1.0,
            )
            .allow_fast_rotation(true)
            .ccd_enabled(settings.ccd)
            .can_sleep(false);
        Self {
            world,
            body: coin,
            shape,
            seats: Vec::new(),
        }
    }

    fn seat(&self, seat: usize) -> Option<&Seat> {
        self.seats.get(seat)?.as_ref()
    }

    /// The coin of a seat; a new one if the seat is empty.
    fn take(&mut self, seat: usize) -> &mut Seat {
        if self.seats.len() <= seat {
            self.seats.resize_with(seat + 1, || None);
        }
        let Self {
            world, body, shape, ..
        } = self;
        self.seats[seat].get_or_insert_with(|| {
            let (coin, shell) = world.insert(body.clone(), shape.clone());
            Seat {
                coin,
                shell,
                restitution: shape.restitution,
                marked: false,
            }
        })
    }
}

fn set_parameters(parameters: &mut IntegrationParameters, settings: &Settings, step: Real) {
    parameters.dt = step;
    parameters.num_solver_iterations = settings.substeps as usize;
    parameters.normalized_prediction_distance = settings.prediction as Real;
    // coins fall as fast as they are dropped from high up
    parameters.normalized_max_linear_velocity = Real::MAX;
    parameters.max_ccd_substeps = usize::from(settings.ccd);
    // both serve stacks: they keep contacts where they were
    parameters.contact_recycling = false;
    parameters.contact_clustering = false;
    parameters.friction_model = match settings.friction_model {
        FrictionModel::Coulomb => Friction::Coulomb,
        FrictionModel::Simplified => Friction::Simplified,
    };
}

fn groups(member: Group, meets: Group) -> InteractionGroups {
    InteractionGroups::new(member, meets, InteractionTestMode::And)
}

impl World for Stage {
    fn place(&mut self, seat: usize, motion: &Motion) {
        let &mut Seat {
            coin,
            shell,
            restitution,
            marked,
        } = self.take(seat);
        if marked {
            // contacts belong to the pair of colliders: a new one has none
            self.world.remove_collider(shell);
            let shape = self.shape.clone().restitution(restitution);
            let shell = self.world.insert_collider(shape, Some(coin));
            self.seats[seat] = Some(Seat {
                coin,
                shell,
                restitution,
                marked: false,
            });
        }
        let pose = Pose::from_parts(vector(&motion.position), rotation(&motion.axis));
        self.world.bodies[coin].set_position(pose, true);
        self.set_velocities(seat, motion);
    }

    fn leave(&mut self, seat: usize) {
        if let Some(gone) = self.seats.get_mut(seat).and_then(Option::take) {
            self.world.remove_body(gone.coin);
        }
    }

    fn set_velocities(&mut self, seat: usize, motion: &Motion) {
        if let Some(seat) = self.seat(seat) {
            let coin = seat.coin;
            let body = &mut self.world.bodies[coin];
            body.set_linvel(vector(&motion.velocity), true);
            body.set_angvel(vector(&motion.spin), true);
        }
    }

    fn set_restitution(&mut self, seat: usize, restitution: f64) {
        let restitution = restitution as Real;
        if let Some(Some(seat)) = self.seats.get_mut(seat)
            && seat.restitution != restitution
        {
            seat.restitution = restitution;
            self.world.colliders[seat.shell].set_restitution(restitution);
        }
    }

    fn step(&mut self) {
        self.world.step();
        for seat in self.seats.iter_mut().flatten() {
            seat.marked = true;
        }
    }

    fn motion(&self, seat: usize) -> Motion {
        let Some(seat) = self.seat(seat) else {
            return Motion::NONE;
        };
        let body = &self.world.bodies[seat.coin];
        let axis = wide(*body.rotation() * Vector::Y);
        Motion {
            position: wide(body.translation()),
            velocity: wide(body.linvel()),
            // 1 but for the rounding of the quaternion
            axis: axis * (1.5 - 0.5 * axis.norm_squared()),
            spin: wide(body.angvel()),
        }
    }

    fn impulse(&self, seat: usize) -> f64 {
        let Some(seat) = self.seat(seat) else {
            return 0.0;
        };
        // the coin's only pair is that with the surface
        let pairs = self.world.narrow_phase.contact_pairs_with(seat.shell);
        let manifolds = pairs.flat_map(ContactPair::manifolds);
        let points = manifolds.flat_map(|manifold| &manifold.points);
        points.map(|point| point.data.impulse as f64).sum()
    }
}

fn vector(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x as Real, v.y as Real, v.z as Real)
}

fn wide(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x as f64, v.y as f64, v.z as f64)
}

/// The shortest turn that takes y, a cylinder's axis in Rapier, to `axis`.
fn rotation(axis: &Vector3<f64>) -> Rotation {
    let (x, y, z, w) = if axis.y > -0.5 {
        (axis.z, 0.0, -axis.x, 1.0 + axis.y)
    } else {
        // half a turn about x first: y and z change sign
        let (x, z, w) = (-axis.z, axis.x, 1.0 - axis.y);
        // (x, 0, z, w)·(1, 0, 0, 0)
        (w, z, 0.0, -x)
    };
    Rotation::from_xyzw(x as Real, y as Real, z as Real, w as Real).normalize()
}
