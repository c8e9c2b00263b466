//! The coin that will be printed.

use super::DesignError;
use crate::{CoinNumbers, Template};
use coinmc_core::Coin;
use coinmc_solid::{Edge, Infill, Marks, Mass, MassError, Shape, ShapeError};

/// All of a printed coin but its thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedCoin {
    /// Diameter, m.
    pub diameter_m: f64,
    /// Its rims. Sharp ones are rounded where the config says so.
    pub edge: Edge,
    /// Angle of its side with the axis, degrees: above 0 heads is the wider face, whose diameter is given.
    /// `None`: that of the config.
    pub draft_deg: Option<f64>,
    /// Whether heads and tails have marks.
    pub marks: bool,
    /// Density of the material, kg/m³.
    pub density_kg_m3: f64,
    /// Walls and inside, if it is not full.
    pub infill: Option<Infill>,
}

impl PrintedCoin {
    /// The coin of this thickness.
    ///
    /// # Errors
    /// [`ShapeError`] if it cannot be.
    pub fn shape(&self, thickness_m: f64) -> Result<Shape, ShapeError> {
        let draft = self.draft_deg.unwrap_or(0.0);
        let plain = Shape::new(self.diameter_m, thickness_m, self.edge)?.with_draft(draft)?;
        if self.marks {
            plain.with_marks(Marks::fitting(&plain))
        } else {
            Ok(plain)
        }
    }

    /// Whether there can be such a coin at all.
    ///
    /// # Errors
    /// [`ShapeError`] if it cannot be, whatever its thickness.
    pub fn check(&self) -> Result<(), ShapeError> {
        // a coin as thick as wide shows what is wrong with all others; with a draft, one half as thick
        let is_conical = self.draft_deg.is_some_and(|draft| draft != 0.0);
        let share = if is_conical { 0.5 } else { 1.0 };
        self.shape(share * self.diameter_m).map(|_| ())
    }

    /// The same with the edge that the config gives where none is asked for.
    pub(super) fn with_edge_of(self, template: &Template) -> Result<Self, DesignError> {
        let mut values = vec![("coin.ratio", "1.0".to_owned())];
        let asked = self.draft_deg.map(|draft| format!("{draft:?}"));
        values.extend(asked.map(|draft| ("coin.draft_deg", draft)));
        let scene = template.plan(&values)?.points[0].scene;
        if scene.coin.centre_over_height() != 0.0 {
            return Err(DesignError::Loaded);
        }
        let rim = scene.coin.rim_radius_m();
        let edge = match self.edge {
            Edge::Sharp if rim > 0.0 => Edge::Rounded { radius_m: rim },
            edge => edge,
        };
        let draft = scene.coin.draft_deg();
        Ok(Self {
            edge,
            draft_deg: (self.draft_deg.is_some() || draft != 0.0).then_some(draft),
            ..self
        })
    }

    /// Its mass and moments of inertia.
    pub(super) fn mass(&self, shape: &Shape) -> Result<Mass, MassError> {
        shape.mass(self.density_kg_m3, self.infill)
    }

    /// What the engines are told of the coin of this ratio. A coin too thin for its marks or walls is
    /// taken as uniform: no answer lies there.
    pub(super) fn numbers(&self, coin: &Coin) -> CoinNumbers {
        let mut numbers = vec![];
        // a chamfer acts like a rounding of its size (docs/methods/space.md)
        if let Edge::Rounded { radius_m: size_m } | Edge::Chamfered { size_m } = self.edge {
            numbers.push(("rim_radius_m", size_m));
        }
        let shape = self.shape(coin.height_m());
        if let Some(mass) = shape.ok().and_then(|shape| self.mass(&shape).ok()) {
            numbers.push(("mass_kg", mass.mass_kg));
            numbers.push(("axial_moment_kg_m2", mass.axial_kg_m2));
            numbers.push(("transverse_moment_kg_m2", mass.transverse_kg_m2));
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn conical(draft_deg: f64) -> PrintedCoin {
        PrintedCoin {
            diameter_m: 0.024,
            edge: Edge::Sharp,
            draft_deg: Some(draft_deg),
            marks: false,
            density_kg_m3: 1240.0,
            infill: None,
        }
    }

    /// The solid's radii, centre of mass and moments are those of the coin that the engine tosses.
    #[test]
    fn a_conical_solid_is_the_coin_that_is_tossed() {
        for (ratio, draft) in [(0.85, 10.0), (1.3, -20.0), (0.2, 3.0)] {
            let coin = Coin::cylinder(ratio, 0.012).and_then(|coin| coin.with_draft(draft));
            let coin = coin.expect("a coin that rests on its edge");
            let printed = conical(draft);
            let shape = printed.shape(coin.height_m()).expect("a solid");
            let half = 0.5 * coin.height_m();
            let distances = [half - shape.centre_m(), half + shape.centre_m()];
            for (i, rim) in coin.rims().iter().enumerate() {
                assert!((shape.face_radii_m()[i] / rim.radius_m - 1.0).abs() < 1e-12);
                assert!((distances[i] / rim.distance_m - 1.0).abs() < 1e-12);
            }
            let mass = printed.mass(&shape).expect("a mass");
            let axial = mass.axial_kg_m2 / mass.mass_kg;
            let transverse = mass.transverse_kg_m2 / mass.mass_kg;
            assert!((axial / coin.axial_gyration_m2() - 1.0).abs() < 1e-12);
            assert!((transverse / coin.transverse_gyration_m2() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_config_gives_the_edge_that_is_not_asked_for() {
        let template = |coin: &str| {
            let text = format!(
                "coin = {{ {coin} }}\nsurface = {{ restitution = 0.5, friction = 0.3 }}\n\
                 launch.preset = 'drop'\nengine.volumetric = {{}}"
            );
            Template::new("inline", text, &[])
        };
        let sharp = PrintedCoin {
            draft_deg: None,
            ..conical(0.0)
        };
        let edge_of = |coin: PrintedCoin, text: &str| {
            let coin = coin.with_edge_of(&template(text)).expect("a scene");
            (coin.edge, coin.draft_deg)
        };
        let rounded = Edge::Rounded { radius_m: 1e-3 };
        assert_eq!(edge_of(sharp, "rim_radius_m = 1e-3"), (rounded, None));
        assert_eq!(edge_of(sharp, "draft_deg = 5"), (Edge::Sharp, Some(5.0)));
        assert_eq!(edge_of(conical(0.0), "draft_deg = 5").1, Some(0.0));
        assert_eq!(edge_of(sharp, "mass_kg = 1"), (Edge::Sharp, None));
        let loaded = sharp.with_edge_of(&template("centre_of_mass_over_height = 0.1"));
        assert!(matches!(loaded, Err(DesignError::Loaded)));
    }
}
