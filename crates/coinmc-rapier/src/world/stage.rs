//! The world of one precision: `super::rapier` is that precision's crate.

// `Real` is f64 in one of the two precisions and f32 in the other: the casts are those of the other
#![allow(
    clippy::unnecessary_cast,
    clippy::cast_possible_truncation,
    clippy::cast_lossless
)]

use super::rapier::dynamics::{
    CoefficientCombineRule, FrictionModel as Friction, MassProperties, RigidBodyBuilder,
    RigidBodyHandle,
};
use super::rapier::geometry::{ColliderBuilder, ColliderHandle};
use super::rapier::math::{Pose, Real, Rotation, Vector};
use super::rapier::pipeline::PhysicsWorld;
use crate::body::Scaled;
use crate::motion::Motion;
use crate::settings::{FrictionModel, Settings};
use crate::world::World;
use nalgebra::{Unit, Vector3};

/// A half-space, a cylinder above it, and Rapier's pipeline.
pub(crate) struct Stage {
    world: PhysicsWorld,
    ground: ColliderHandle,
    coin: RigidBodyHandle,
    shell: ColliderHandle,
    shape: ColliderBuilder,
    restitution: Real,
    /// A step was made since the coin was placed: there may be contacts that remember it.
    marked: bool,
}

impl Stage {
    pub(crate) fn new(scaled: &Scaled, settings: &Settings, step: f64) -> Self {
        let mut world = PhysicsWorld {
            gravity: Vector::new(0.0, 0.0, -1.0),
            ..PhysicsWorld::default()
        };
        let parameters = &mut world.integration_parameters;
        parameters.dt = step as Real;
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
        let body = &scaled.body;
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
        let ground = ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Z))
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .friction(0.0)
            .restitution(0.0);
        let shape = ColliderBuilder::cylinder(body.half as Real, body.radius as Real)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .density(0.0)
            .friction(scaled.friction as Real)
            .restitution(scaled.restitution as Real);
        let ground = world.insert_collider(ground, None);
        let (coin, shell) = world.insert(coin, shape.clone());
        Self {
            world,
            ground,
            coin,
            shell,
            shape,
            restitution: scaled.restitution as Real,
            marked: false,
        }
    }
}

impl World for Stage {
    fn place(&mut self, motion: &Motion) {
        if self.marked {
            // contacts belong to the pair of colliders: a new one has none
            self.world.remove_collider(self.shell);
            let shape = self.shape.clone().restitution(self.restitution);
            self.shell = self.world.insert_collider(shape, Some(self.coin));
            self.marked = false;
        }
        let body = &mut self.world.bodies[self.coin];
        let pose = Pose::from_parts(vector(&motion.position), rotation(&motion.axis));
        body.set_position(pose, true);
        self.set_velocities(motion);
    }

    fn set_velocities(&mut self, motion: &Motion) {
        let body = &mut self.world.bodies[self.coin];
        body.set_linvel(vector(&motion.velocity), true);
        body.set_angvel(vector(&motion.spin), true);
    }

    fn step(&mut self, restitution: f64) {
        let restitution = restitution as Real;
        if restitution != self.restitution {
            self.restitution = restitution;
            self.world.colliders[self.shell].set_restitution(restitution);
        }
        self.world.step();
        self.marked = true;
    }

    fn motion(&self) -> Motion {
        let body = &self.world.bodies[self.coin];
        let axis = wide(*body.rotation() * Vector::Y);
        Motion {
            position: wide(body.translation()),
            velocity: wide(body.linvel()),
            // 1 but for the rounding of the quaternion
            axis: axis * (1.5 - 0.5 * axis.norm_squared()),
            spin: wide(body.angvel()),
        }
    }

    fn impulse(&self) -> f64 {
        let Some(pair) = self
            .world
            .narrow_phase
            .contact_pair(self.ground, self.shell)
        else {
            return 0.0;
        };
        let points = pair
            .manifolds()
            .iter()
            .flat_map(|manifold| &manifold.points);
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
