//! Launch distributions as configs give them: the keys of `[launch]`, and vectors and angles in them.

use super::{LaunchDistribution, Marginal, Orientation, Preset, Spin};
use crate::schema::{
    Absent, Bounds, Condition, Kind, ReadError, Rule, TableKind, Value, Values, Word, field,
};
use nalgebra::{UnitVector3, Vector3};

/// Limit of every component of a velocity, m/s.
const SPEED: Bounds = Bounds::closed(-1e6, 1e6);

impl LaunchDistribution {
    /// The keys of the table `[launch]`. `preset` names a [`Preset`], which
    /// [`values`](Self::values) spells out.
    pub fn schema() -> TableKind {
        let presets = Preset::ALL.map(|preset| Word {
            name: preset.name(),
            doc: preset.source(),
        });
        TableKind {
            fields: vec![
                field(
                    "preset",
                    "A launch with a name and a source; the other keys replace parts of it.",
                    Kind::Word(presets.to_vec()),
                    Absent::Omitted,
                ),
                Marginal::field(
                    "height_m",
                    "Height of the centre above the surface, m. A coin that would begin inside the \
                     surface is lifted until it touches.",
                    Bounds::closed(0.0, 1e6),
                    Absent::Omitted,
                ),
                field(
                    "velocity_m_s",
                    "Velocity of the centre, m/s; z points up. At rest if neither this nor a preset is \
                     given.",
                    vector_kind(SPEED),
                    Absent::Omitted,
                ),
                field(
                    "orientation",
                    "How the coin is turned.",
                    Orientation::kind(),
                    Absent::Omitted,
                ),
                field("spin", "How the coin spins.", Spin::kind(), Absent::Omitted),
            ],
            rules: vec![Rule::Unless {
                condition: Condition::Given("preset"),
                keys: &["height_m", "orientation", "spin"],
                fallback: None,
            }],
        }
    }

    /// The values that stand in for absent keys where no preset is given: a coin at rest.
    pub fn defaults() -> Values {
        let rest = vector_value(&[Marginal::Constant(0.0); 3]);
        Values::new(vec![("velocity_m_s", rest)])
    }

    /// The distribution that a config gives, with its preset spelled out.
    ///
    /// # Errors
    /// [`ReadError`] if a range is empty, or an axis has length 0.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{LaunchDistribution, Preset};
    /// let clean = Preset::Clean.distribution();
    /// assert_eq!(LaunchDistribution::read(&clean.values()), Ok(clean));
    /// ```
    pub fn read(values: &Values) -> Result<Self, ReadError> {
        let at = |key| move |error: ReadError| error.at(key);
        Ok(Self {
            height_m: Marginal::read(values.required("height_m")?).map_err(at("height_m"))?,
            velocity_m_s: read_vector(values.required("velocity_m_s")?)
                .map_err(at("velocity_m_s"))?,
            orientation: Orientation::read(values.required("orientation")?)
                .map_err(at("orientation"))?,
            spin: Spin::read(values.required("spin")?).map_err(at("spin"))?,
        })
    }

    /// The reverse of [`read`](Self::read): a preset spelled out.
    pub fn values(&self) -> Values {
        Values::new(vec![
            ("height_m", self.height_m.value()),
            ("velocity_m_s", vector_value(&self.velocity_m_s)),
            ("orientation", self.orientation.value()),
            ("spin", self.spin.value()),
        ])
    }
}

/// Three marginals: x, y, z.
pub(super) fn vector_kind(bounds: Bounds) -> Kind {
    Kind::Vector(Box::new(Marginal::kind(bounds)))
}

pub(super) fn read_vector(value: &Value) -> Result<[Marginal; 3], ReadError> {
    let [x, y, z] = value.components()?;
    let component = |value, key| Marginal::read(value).map_err(|error| error.at(key));
    Ok([component(x, "x")?, component(y, "y")?, component(z, "z")?])
}

pub(super) fn vector_value(components: &[Marginal; 3]) -> Value {
    Value::Vector(components.iter().map(Marginal::value).collect())
}

/// A direction: three numbers of any length but 0.
pub(super) fn direction_kind() -> Kind {
    Kind::Vector(Box::new(Kind::Number(Bounds::closed(-1e6, 1e6))))
}

pub(super) fn read_direction(value: &Value) -> Result<UnitVector3<f64>, ReadError> {
    let [x, y, z] = value.components()?;
    let vector = Vector3::new(x.number()?, y.number()?, z.number()?);
    // divided by the largest component first: the squares of tiny ones would underflow
    let largest = vector.amax();
    if largest < 1e-300 {
        let error = ReadError::new("an axis of length 0 has no direction");
        return Err(error.with_help("give the direction, such as [0, 1, 0]"));
    }
    Ok(UnitVector3::new_normalize(vector / largest))
}

pub(super) fn direction_value(axis: &UnitVector3<f64>) -> Value {
    Value::Vector(axis.iter().copied().map(Value::Number).collect())
}

/// An angle in degrees, as configs give it, from one in radians: the degrees that become exactly these
/// radians again; round ones where there are any.
pub(super) fn to_degrees(radians: f64) -> f64 {
    let near = radians.to_degrees();
    let round = format!("{near:.14e}").parse().unwrap_or(near);
    // a negative zero would be another text for the same angle
    let round = if round == 0.0 { 0.0 } else { round };
    [round, near, near.next_up(), near.next_down()]
        .into_iter()
        .find(|degrees| degrees.to_radians() == radians)
        .unwrap_or(near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_survives_being_spelled_out() {
        for preset in Preset::ALL {
            let launches = preset.distribution();
            assert_eq!(
                LaunchDistribution::read(&launches.values()),
                Ok(launches),
                "{preset}"
            );
        }
    }

    /// A single number gives all three components: normal about 0, or none at all.
    #[test]
    fn an_isotropic_spin_has_three_equal_components() {
        for (sd, component) in [
            (3.0, Marginal::Normal { mean: 0.0, sd: 3.0 }),
            (0.0, Marginal::Constant(0.0)),
        ] {
            let value = Value::Tagged("isotropic_sd_rad_s", Box::new(Value::Number(sd)));
            assert_eq!(Spin::read(&value), Ok(Spin::Components([component; 3])));
        }
    }

    #[test]
    fn an_error_blames_its_key() {
        let mut launches = Preset::Hand.distribution();
        launches.velocity_m_s[1] = Marginal::Uniform { from: 2.0, to: 1.0 };
        let error = LaunchDistribution::read(&launches.values()).unwrap_err();
        assert_eq!(
            error.path().collect::<Vec<_>>(),
            ["velocity_m_s", "y", "to"]
        );
        assert!(error.help().is_some() && error.to_string().contains("from 2 to 1"));
    }

    fn direction(components: [f64; 3]) -> Value {
        Value::Vector(components.map(Value::Number).to_vec())
    }

    #[test]
    fn a_direction_may_have_any_length_but_zero() {
        let wanted = Vector3::new(0.6, 0.0, -0.8);
        for length in [1e-299, 1e-200, 1.0, 1e6] {
            let axis = read_direction(&direction((wanted * length).into())).unwrap();
            // a few ulp: quotients, a norm
            assert!((*axis - wanted).norm() < 1e-15, "{length:e}: {axis:?}");
        }
        // the shortest that is not 0
        let axis = read_direction(&direction([0.0, 1e-300, 0.0])).unwrap();
        assert_eq!(axis, Vector3::y_axis());
        let error = read_direction(&direction([0.0; 3])).unwrap_err();
        assert!(error.to_string().contains("length 0"), "{error}");
    }

    #[test]
    fn a_direction_may_point_along_either_sense_of_an_axis() {
        let Kind::Vector(component) = direction_kind() else {
            panic!("three components");
        };
        let Kind::Number(bounds) = *component else {
            panic!("numbers");
        };
        assert!(
            [-1e6, -1.0, 0.0, 1.0, 1e6]
                .iter()
                .all(|x| bounds.contains(*x))
        );
    }

    #[test]
    fn without_a_preset_a_coin_begins_at_rest() {
        let rest = read_vector(
            LaunchDistribution::defaults()
                .required("velocity_m_s")
                .unwrap(),
        );
        assert_eq!(rest, Ok([Marginal::Constant(0.0); 3]));
    }

    /// Tenths of a degree, of which many are not the quotient by π/180 of their own radians.
    #[test]
    fn angles_are_written_in_round_degrees() {
        let degrees = || (-3600..=3600).map(|tenths| f64::from(tenths) / 10.0);
        let found = degrees().filter(|deg| deg.to_radians().to_degrees() != *deg);
        assert!(found.count() > 100, "else nothing is tested");
        for deg in degrees() {
            assert_eq!(to_degrees(deg.to_radians()), deg);
        }
    }

    #[test]
    fn no_angle_is_written_as_minus_zero() {
        assert_eq!(to_degrees(-0.0).to_bits(), 0.0_f64.to_bits());
    }
}
