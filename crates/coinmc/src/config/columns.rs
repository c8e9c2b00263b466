//! The parameters that results show for each point.

use super::sweep::Sweep;
use coinmc_core::Scene;
use std::sync::Arc;

/// The parameter columns of results: those of every scene, then the other axes of the sweep. All points
/// share the names.
pub(super) struct Columns {
    scene: [Arc<str>; Scene::PARAMETERS.len()],
    /// The other axes: number and name.
    swept: Vec<(usize, Arc<str>)>,
}

impl Columns {
    pub(super) fn new(sweep: &Sweep) -> Self {
        let in_every_scene = |name: &str| {
            Scene::PARAMETERS
                .iter()
                .any(|parameter| parameter.name == name)
        };
        let swept = sweep.axes.iter().enumerate();
        Self {
            scene: Scene::PARAMETERS.map(|parameter| parameter.name.into()),
            swept: swept
                .filter(|(_, axis)| !in_every_scene(&axis.name))
                .map(|(number, axis)| (number, axis.name.as_str().into()))
                .collect(),
        }
    }

    pub(super) fn parameters(
        &self,
        scene: &Scene,
        sweep: &Sweep,
        indices: &[usize],
    ) -> Vec<(Arc<str>, f64)> {
        let of_scene = self.scene.iter().zip(Scene::PARAMETERS);
        let swept = self.swept.iter().map(|(number, name)| {
            let value = sweep.axes[*number].values[indices[*number]];
            (Arc::clone(name), value)
        });
        of_scene
            .map(|(name, parameter)| (Arc::clone(name), (parameter.value)(scene)))
            .chain(swept)
            .collect()
    }
}
