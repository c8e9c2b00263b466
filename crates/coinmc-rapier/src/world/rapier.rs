//! The world, made with Rapier.

use crate::motion::Motion;
use crate::scaled::Scaled;
use crate::settings::{FrictionModel, Settings};
use nalgebra::{Unit, Vector3};
use rapier3d_f64::dynamics::{
    CoefficientCombineRule, FrictionModel as RapierFriction, IntegrationParameters, MassProperties,
    RigidBodyBuilder, RigidBodyHandle,
};
use rapier3d_f64::geometry::{
    BroadPhaseBvh, BvhOptimizationStrategy, ColliderBuilder, ColliderHandle, ContactPair, Group,
    InteractionGroups, InteractionTestMode,
};
use rapier3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::pipeline::PhysicsWorld;

/// A half-space, coins above it, and Rapier's pipeline.
pub(crate) struct World {
    physics: PhysicsWorld,
    body: RigidBodyBuilder,
    shape: ColliderBuilder,
    slots: Vec<Option<Coin>>,
}

/// A coin in the world.
#[derive(Clone, Copy)]
struct Coin {
    body: RigidBodyHandle,
    collider: ColliderHandle,
    restitution: f64,
    /// The world has made a step since the coin was placed, so Rapier may remember contacts of it.
    stepped: bool,
}

/// Coins interact with the surface but not with one another.
const SURFACE: Group = Group::GROUP_1;
const COINS: Group = Group::GROUP_2;

impl World {
    pub(crate) fn new(scaled: &Scaled, settings: &Settings, step: f64) -> Self {
        // a tree of a few boxes that all overlap is not worth optimizing
        let mut broad_phase =
            BroadPhaseBvh::with_optimization_strategy(BvhOptimizationStrategy::None);
        broad_phase.adaptive_change_detection_margin = true;
        let mut physics = PhysicsWorld {
            gravity: Vector::new(0.0, 0.0, -1.0),
            broad_phase,
            ..PhysicsWorld::default()
        };
        set_parameters(&mut physics.integration_parameters, settings, step);
        let ground = ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Z))
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups(SURFACE, COINS))
            .friction(0.0)
            .restitution(0.0);
        physics.insert_collider(ground, None);
        let body = &scaled.body;
        let shape = ColliderBuilder::cylinder(body.half, body.radius)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups(COINS, SURFACE))
            .density(0.0)
            .friction(scaled.friction)
            .restitution(scaled.restitution);
        let inertia = Vector::new(body.kt, body.ka, body.kt);
        let coin = RigidBodyBuilder::dynamic()
            .additional_mass_properties(MassProperties::new(Vector::ZERO, 1.0, inertia))
            .linear_damping(scaled.linear_drag)
            .angular_damping(scaled.angular_drag)
            .gyroscopic_forces_enabled(
                settings.gyroscopic.is_rapiers() && scaled.axial_factor != 1.0,
            )
            .allow_fast_rotation(true)
            .ccd_enabled(settings.ccd)
            .can_sleep(false);
        Self {
            physics,
            body: coin,
            shape,
            slots: Vec::new(),
        }
    }

    /// Puts the coin of a slot where `motion` says, a new coin if the slot is empty. Rapier forgets
    /// its earlier contacts.
    pub(crate) fn place(&mut self, slot: usize, motion: &Motion) {
        let mut coin = self.coin_or_new(slot);
        if coin.stepped {
            // Rapier keeps contacts by pairs of colliders: a new collider has none
            self.physics.remove_collider(coin.collider);
            let shape = self.shape.clone().restitution(coin.restitution);
            coin.collider = self.physics.insert_collider(shape, Some(coin.body));
            coin.stepped = false;
            self.slots[slot] = Some(coin);
        }
        let pose = Pose::from_parts(to_rapier(&motion.position), rotation(&motion.axis));
        self.physics.bodies[coin.body].set_position(pose, true);
        self.set_velocities(slot, motion);
    }

    /// Removes the coin of a slot, if there is one.
    pub(crate) fn clear(&mut self, slot: usize) {
        if let Some(coin) = self.slots.get_mut(slot).and_then(Option::take) {
            self.physics.remove_body(coin.body);
        }
    }

    /// Sets the velocities of a coin to those of `motion`, and nothing else.
    pub(crate) fn set_velocities(&mut self, slot: usize, motion: &Motion) {
        if let Some(coin) = self.coin(slot) {
            let body = coin.body;
            let body = &mut self.physics.bodies[body];
            body.set_linvel(to_rapier(&motion.velocity), true);
            body.set_angvel(to_rapier(&motion.spin), true);
        }
    }

    /// Sets the restitution of this coin's contacts that begin in the next step.
    pub(crate) fn set_restitution(&mut self, slot: usize, restitution: f64) {
        if let Some(Some(coin)) = self.slots.get_mut(slot)
            && coin.restitution != restitution
        {
            coin.restitution = restitution;
            self.physics.colliders[coin.collider].set_restitution(restitution);
        }
    }

    /// Makes one step of all coins.
    pub(crate) fn step(&mut self) {
        self.physics.step();
        for coin in self.slots.iter_mut().flatten() {
            coin.stepped = true;
        }
    }

    /// How a coin moves now; NaN for an empty slot.
    pub(crate) fn motion(&self, slot: usize) -> Motion {
        let Some(coin) = self.coin(slot) else {
            return Motion::NAN;
        };
        let body = &self.physics.bodies[coin.body];
        let axis = from_rapier(*body.rotation() * Vector::Y);
        Motion {
            position: from_rapier(body.translation()),
            velocity: from_rapier(body.linvel()),
            // of length 1 but for the rounding of the quaternion
            axis: axis * (1.5 - 0.5 * axis.norm_squared()),
            spin: from_rapier(body.angvel()),
        }
    }

    /// Sum of the normal impulses on a coin in the last step, in m sqrt(g D).
    pub(crate) fn normal_impulse(&self, slot: usize) -> f64 {
        let Some(coin) = self.coin(slot) else {
            return 0.0;
        };
        // the coin's only contact pair is the one with the surface
        let pairs = self.physics.narrow_phase.contact_pairs_with(coin.collider);
        let manifolds = pairs.flat_map(ContactPair::manifolds);
        let points = manifolds.flat_map(|manifold| &manifold.points);
        points.map(|point| point.data.impulse).sum()
    }

    fn coin(&self, slot: usize) -> Option<&Coin> {
        self.slots.get(slot)?.as_ref()
    }

    /// The coin of a slot; a new one if the slot is empty.
    fn coin_or_new(&mut self, slot: usize) -> Coin {
        if self.slots.len() <= slot {
            self.slots.resize_with(slot + 1, || None);
        }
        let Self {
            physics,
            body,
            shape,
            ..
        } = self;
        *self.slots[slot].get_or_insert_with(|| {
            let (body, collider) = physics.insert(body.clone(), shape.clone());
            Coin {
                body,
                collider,
                restitution: shape.restitution,
                stepped: false,
            }
        })
    }
}

fn set_parameters(parameters: &mut IntegrationParameters, settings: &Settings, step: f64) {
    parameters.dt = step;
    parameters.num_solver_iterations = settings.substeps as usize;
    parameters.normalized_prediction_distance = settings.prediction;
    // coins dropped from high up may fall at any speed
    parameters.normalized_max_linear_velocity = f64::MAX;
    parameters.max_ccd_substeps = usize::from(settings.ccd);
    // both are made for stacks: they keep contacts where they were
    parameters.contact_recycling = false;
    parameters.contact_clustering = false;
    parameters.friction_model = match settings.friction_model {
        FrictionModel::Coulomb => RapierFriction::Coulomb,
        FrictionModel::Simplified => RapierFriction::Simplified,
    };
}

fn groups(member: Group, meets: Group) -> InteractionGroups {
    InteractionGroups::new(member, meets, InteractionTestMode::And)
}

fn to_rapier(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn from_rapier(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

/// The shortest rotation that takes y, the axis of Rapier's cylinders, to `axis`.
fn rotation(axis: &Vector3<f64>) -> Rotation {
    let (x, y, z, w) = if axis.y > -0.5 {
        (axis.z, 0.0, -axis.x, 1.0 + axis.y)
    } else {
        // half a turn about x first: y and z change sign
        let (x, z, w) = (-axis.z, axis.x, 1.0 - axis.y);
        // (x, 0, z, w)·(1, 0, 0, 0)
        (w, z, 0.0, -x)
    };
    Rotation::from_xyzw(x, y, z, w).normalize()
}
