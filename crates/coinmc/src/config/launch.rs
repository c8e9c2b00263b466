//! Launches: presets spelled out, and distributions built for a point.

use super::build::{At, Fault, get};
use super::form::{Form, What};
use super::quantity::{Quantity, digits};
use super::source::Span;
use coinmc_core::{LaunchDistribution, Marginal, Orientation, Preset, Spin};
use nalgebra::{UnitVector3, Vector3};

/// The launch with its preset replaced by what the preset says, except where the config says
/// otherwise. Without a preset the coin starts from rest unless a velocity is given.
pub(super) fn spelled_out(launch: &Form) -> Form {
    let What::Table(entries) = &launch.what else {
        return launch.clone();
    };
    let preset = launch.get("preset");
    let base = match preset.map(|form| (form.span, form.word())) {
        Some((span, Some(name))) => name
            .parse::<Preset>()
            .ok()
            .map(|preset| Writer { span }.launch(&preset.distribution())),
        // an invalid preset leaves open what else is missing
        Some((_, None)) => return Form::invalid(launch.span),
        None => {
            let rest = Writer { span: launch.span }.vector(&[Marginal::Constant(0.0); 3]);
            Some(vec![("velocity_m_s", rest)])
        }
    };
    let base = base.unwrap_or_default();
    let find = |list: &[(&'static str, Form)], key| {
        list.iter()
            .find(|(name, _)| *name == key)
            .map(|(_, form)| form.clone())
    };
    let merged = ["height_m", "velocity_m_s", "orientation", "spin"]
        .into_iter()
        .filter_map(|key| Some((key, find(entries, key).or_else(|| find(&base, key))?)))
        .collect();
    Form::new(launch.span, What::Table(merged))
}

/// Writes a distribution in the words of the config; `span` is blamed for it.
struct Writer {
    span: Span,
}

impl Writer {
    fn form(&self, what: What) -> Form {
        Form::new(self.span, what)
    }

    fn tagged(&self, tag: &'static str, inner: Form) -> Form {
        self.form(What::Tagged(tag, Box::new(inner)))
    }

    fn number(&self, value: f64) -> Form {
        self.form(What::Number(Quantity::Constant(value), None))
    }

    fn launch(&self, launch: &LaunchDistribution) -> Vec<(&'static str, Form)> {
        vec![
            ("height_m", self.marginal(&launch.height_m)),
            ("velocity_m_s", self.vector(&launch.velocity_m_s)),
            ("orientation", self.orientation(&launch.orientation)),
            ("spin", self.spin(&launch.spin)),
        ]
    }

    fn marginal(&self, marginal: &Marginal) -> Form {
        let pair = |tag, a: (&'static str, f64), b: (&'static str, f64)| {
            let entries = [a, b]
                .map(|(name, value)| (name, self.number(value)))
                .to_vec();
            self.tagged(tag, self.form(What::Table(entries)))
        };
        match *marginal {
            Marginal::Constant(value) => self.number(value),
            Marginal::Uniform { from, to } => pair("uniform", ("from", from), ("to", to)),
            Marginal::Normal { mean, sd } => pair("normal", ("mean", mean), ("sd", sd)),
        }
    }

    fn vector(&self, components: &[Marginal; 3]) -> Form {
        self.form(What::Vector(
            components.iter().map(|m| self.marginal(m)).collect(),
        ))
    }

    fn axis(&self, axis: &UnitVector3<f64>) -> Form {
        self.form(What::Vector(axis.iter().map(|x| self.number(*x)).collect()))
    }

    fn orientation(&self, orientation: &Orientation) -> Form {
        match orientation {
            Orientation::Fixed(axis) => self.tagged("axis", self.axis(axis)),
            Orientation::Isotropic => self.form(What::Word("isotropic")),
            Orientation::EulerAngles => self.form(What::Word("euler-angles")),
            Orientation::Tilt(tilt) => {
                self.tagged("tilt_deg", self.marginal(&scaled(tilt, to_degrees)))
            }
        }
    }

    fn spin(&self, spin: &Spin) -> Form {
        let table = |entries| self.form(What::Table(entries));
        match spin {
            Spin::Components(components) => {
                self.tagged("components_rad_s", self.vector(components))
            }
            Spin::About { axis, rate_rad_s } => self.tagged(
                "about",
                table(vec![
                    ("axis", self.axis(axis)),
                    ("rate_rad_s", self.marginal(rate_rad_s)),
                ]),
            ),
            Spin::Precessing {
                rate_rad_s,
                psi_rad,
            } => self.tagged(
                "precessing",
                table(vec![
                    ("rate_rad_s", self.marginal(rate_rad_s)),
                    ("psi_deg", self.marginal(&scaled(psi_rad, to_degrees))),
                ]),
            ),
        }
    }
}

/// The degrees that become exactly these radians again; round ones where there are any.
fn to_degrees(radians: f64) -> f64 {
    let near = radians.to_degrees();
    [digits(near, 15), near, near.next_up(), near.next_down()]
        .into_iter()
        .find(|degrees| degrees.to_radians() == radians)
        .unwrap_or(near)
}

fn scaled(marginal: &Marginal, scale: impl Fn(f64) -> f64) -> Marginal {
    match *marginal {
        Marginal::Constant(value) => Marginal::Constant(scale(value)),
        Marginal::Uniform { from, to } => Marginal::Uniform {
            from: scale(from),
            to: scale(to),
        },
        Marginal::Normal { mean, sd } => Marginal::Normal {
            mean: scale(mean),
            sd: scale(sd),
        },
    }
}

/// The launch distribution of a point.
pub(super) fn distribution(launch: &Form, at: &At<'_>) -> Result<LaunchDistribution, Fault> {
    Ok(LaunchDistribution {
        height_m: marginal(get(launch, "height_m")?, at)?,
        velocity_m_s: marginals(get(launch, "velocity_m_s")?, at)?,
        orientation: orientation(get(launch, "orientation")?, at)?,
        spin: spin(get(launch, "spin")?, at)?,
    })
}

fn marginal(form: &Form, at: &At<'_>) -> Result<Marginal, Fault> {
    let What::Tagged(tag, inner) = &form.what else {
        return Ok(Marginal::Constant(at.number(form)?));
    };
    let value = |key| at.number(get(inner, key)?);
    if *tag == "normal" {
        return Ok(Marginal::Normal {
            mean: value("mean")?,
            sd: value("sd")?,
        });
    }
    let (from, to) = (value("from")?, value("to")?);
    if from >= to {
        return Err(Fault::problem(
            get(inner, "to")?.span,
            format!("a uniform distribution from {from} to {to} is empty"),
            Some("`to` must be larger than `from`; for a constant write the number itself"),
        ));
    }
    Ok(Marginal::Uniform { from, to })
}

fn components(form: &Form) -> Result<[&Form; 3], Fault> {
    match &form.what {
        What::Vector(components) => match &components[..] {
            [x, y, z] => Ok([x, y, z]),
            _ => Err(Fault::Reported),
        },
        _ => Err(Fault::Reported),
    }
}

fn marginals(form: &Form, at: &At<'_>) -> Result<[Marginal; 3], Fault> {
    let [x, y, z] = components(form)?;
    Ok([marginal(x, at)?, marginal(y, at)?, marginal(z, at)?])
}

fn direction(form: &Form, at: &At<'_>) -> Result<UnitVector3<f64>, Fault> {
    let [x, y, z] = components(form)?;
    let vector = Vector3::new(at.number(x)?, at.number(y)?, at.number(z)?);
    // the largest component first: tiny vectors would underflow, squared
    let largest = vector.amax();
    if largest < 1e-300 {
        let help = Some("give the direction, such as [0, 1, 0]");
        return Err(Fault::problem(
            form.span,
            "an axis of length 0 has no direction".into(),
            help,
        ));
    }
    Ok(UnitVector3::new_normalize(vector / largest))
}

fn orientation(form: &Form, at: &At<'_>) -> Result<Orientation, Fault> {
    match &form.what {
        What::Word("isotropic") => Ok(Orientation::Isotropic),
        What::Word("euler-angles") => Ok(Orientation::EulerAngles),
        What::Tagged("axis", axis) => Ok(Orientation::Fixed(direction(axis, at)?)),
        What::Tagged("tilt_deg", tilt) => Ok(Orientation::Tilt(scaled(
            &marginal(tilt, at)?,
            f64::to_radians,
        ))),
        _ => Err(Fault::Reported),
    }
}

fn spin(form: &Form, at: &At<'_>) -> Result<Spin, Fault> {
    let What::Tagged(tag, inner) = &form.what else {
        return Err(Fault::Reported);
    };
    match *tag {
        "components_rad_s" => Ok(Spin::Components(marginals(inner, at)?)),
        "about" => Ok(Spin::About {
            axis: direction(get(inner, "axis")?, at)?,
            rate_rad_s: marginal(get(inner, "rate_rad_s")?, at)?,
        }),
        "precessing" => Ok(Spin::Precessing {
            rate_rad_s: marginal(get(inner, "rate_rad_s")?, at)?,
            psi_rad: scaled(&marginal(get(inner, "psi_deg")?, at)?, f64::to_radians),
        }),
        _ => Err(Fault::Reported),
    }
}

/// Refuses a launch that leaves the xz plane, and blames the part that does.
pub(super) fn require_planar(
    form: &Form,
    launch: &LaunchDistribution,
    engine: &str,
) -> Result<(), Fault> {
    if launch.is_planar() {
        return Ok(());
    }
    let (key, help) = if !launch.orientation.is_planar() {
        (
            "orientation",
            "orientation = { tilt_deg = … } or an axis with y = 0 stays in the plane",
        )
    } else if !launch.spin.is_planar() {
        (
            "spin",
            "spin = { about = { axis = [0, 1, 0], rate_rad_s = … } } stays in the plane",
        )
    } else {
        (
            "velocity_m_s",
            "the y component of the velocity must be the number 0",
        )
    };
    let message = format!(
        "engine.{engine} needs a launch in the xz plane, and this one's {} leaves it",
        if key == "velocity_m_s" {
            "velocity"
        } else {
            key
        }
    );
    let help = format!("the presets robot and clean-flat are flat; {help}");
    Err(Fault::Problem {
        span: get(form, key)?.span,
        message,
        help: Some(help),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::source::Sources;

    #[test]
    fn every_preset_survives_being_spelled_out() {
        let mut sources = Sources::default();
        let source = sources.add("", "");
        let span = sources.end(source);
        for preset in Preset::ALL {
            let entries = Writer { span }.launch(&preset.distribution());
            let form = Form::new(span, What::Table(entries));
            let launch = distribution(&form, &At::single()).unwrap();
            assert_eq!(launch, preset.distribution(), "{preset}");
        }
    }
}
