//! Reads a config of a calibration: a scene, priors, and tables of measurements.

mod prior_given;

use crate::measured::{
    Bounces, CountsGiven, Drops, Kind, Reading, Reduce, Reduced, RollOut, SpinDown, Tilt, Whirr,
};
use crate::prior::Prior;
use crate::{CalibrationError, Parameter};
use coinmc::config::{self, Diagnostics, Entry, Override, Place, Section};
use coinmc::plan::Plan;
use coinmc_core::Scene;
use coinmc_core::schema::fields;
use prior_given::{PriorGiven, check_ranges, priors};
use std::path::{Path, PathBuf};

/// Tables of the scene that a measurement may have of its own.
const OWN: &[&str] = &["coin", "launch"];

/// Counts of faces, in the scene in which they were tossed.
#[derive(Debug, Clone, PartialEq)]
pub struct Counted {
    /// Which table of the config it is from, such as `counts 2`.
    pub name: String,
    /// Scene and launches; the surface is that of the parameters.
    pub plan: Plan,
    /// Heads, tails, side.
    pub faces: [u64; 3],
    /// Tosses that showed no face.
    pub lost: u64,
}

/// What is known of a coin and a surface.
#[derive(Debug, Clone)]
pub struct Observations {
    /// The scene, with all that is not calibrated.
    pub plan: Plan,
    /// Scene and launches for which the probabilities are predicted.
    pub predicted: Plan,
    /// The prior of each parameter.
    pub priors: Vec<Prior>,
    /// Counts of faces.
    pub counts: Vec<Counted>,
    /// Measured numbers.
    pub readings: Vec<Reading>,
    /// What casts doubt on the fits of filmed drops.
    pub(crate) film_remarks: Vec<String>,
    /// Where each of the counts, and then each of the readings, stands.
    pub(crate) places: Vec<Place>,
}

/// What was met on the way through the tables.
#[derive(Default)]
struct Taken {
    /// Where each of the readings stands.
    places: Vec<Place>,
    /// The files of filmed drops.
    films: Vec<PathBuf>,
}

/// What a section says.
enum Content {
    Prior(PriorGiven),
    Predict,
    Counts(CountsGiven),
    Film(Drops),
    RollOut(RollOut),
    Tilt(Tilt),
    SpinDown(SpinDown),
    Whirr(Whirr),
    Bounces(Bounces),
}

impl Content {
    fn kind(&self) -> Option<Kind> {
        Some(match self {
            Self::Prior(_) | Self::Predict => return None,
            Self::Counts(_) => Kind::Counts,
            Self::Film(_) => Drops::KIND,
            Self::RollOut(_) => RollOut::KIND,
            Self::Tilt(_) => Tilt::KIND,
            Self::SpinDown(_) => SpinDown::KIND,
            Self::Whirr(_) => Whirr::KIND,
            Self::Bounces(_) => Bounces::KIND,
        })
    }
}

impl Observations {
    /// Reads a config file.
    ///
    /// # Errors
    /// [`CalibrationError::Config`] with every problem found.
    pub fn load(path: &Path, overrides: &[Override]) -> Result<Self, CalibrationError> {
        let text = config::read_text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&path.display().to_string(), &text, overrides, folder)
    }

    /// Reads a config from a text; `name` is its name in messages, and files of filmed drops are sought
    /// from `folder`.
    ///
    /// # Errors
    /// [`CalibrationError::Config`] with every problem found.
    ///
    /// # Example
    /// ```
    /// use coinmc_calibrate::Observations;
    /// let text = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
    ///             engine.volumetric = {}\n[[tilt]]\nangle_deg = [17, 18]\n";
    /// let observed = Observations::parse("inline", text, &[], "".as_ref())?;
    /// assert_eq!(observed.readings[0].name, "tilt 1");
    /// assert!(observed.priors[1].source.starts_with("wood"));
    /// # Ok::<(), coinmc_calibrate::CalibrationError>(())
    /// ```
    pub fn parse(
        name: &str,
        text: &str,
        overrides: &[Override],
        folder: &Path,
    ) -> Result<Self, CalibrationError> {
        let (plan, entries) = config::parse_with(name, text, overrides, &sections())?;
        for plan in std::iter::once(&plan).chain(entries.iter().map(|entry| &entry.plan)) {
            check(plan)?;
        }
        let parameters = Parameter::of_scene(
            plan.points[0].engine.descriptor(),
            &plan.points[0].scene.surface,
        );
        let mut observed = Self {
            predicted: plan.clone(),
            priors: priors(&plan, &parameters, None),
            plan,
            counts: vec![],
            readings: vec![],
            film_remarks: vec![],
            places: vec![],
        };
        let mut taken = Taken::default();
        let mut seen = vec![];
        let mut problems = vec![];
        for entry in entries {
            let number = entry.content.kind().map_or(0, |kind| {
                seen.push(kind);
                seen.iter().filter(|other| **other == kind).count()
            });
            let added = observed.add(entry, number, &parameters, folder, &mut taken);
            problems.extend(added.err());
        }
        if let Some(problems) = problems.into_iter().reduce(Diagnostics::and) {
            return Err(problems.into());
        }
        observed.places.extend(taken.places);
        Ok(observed)
    }

    fn add(
        &mut self,
        entry: Entry<Content>,
        number: usize,
        parameters: &[Parameter],
        folder: &Path,
        taken: &mut Taken,
    ) -> Result<(), Diagnostics> {
        let Entry {
            content,
            plan,
            place,
        } = entry;
        let scene = plan.points[0].scene;
        let kind = content.kind();
        let reduced = match content {
            Content::Prior(given) => {
                check_ranges(&given, parameters, &place)?;
                self.priors = priors(&self.plan, parameters, Some(&given));
                return Ok(());
            }
            Content::Predict => {
                self.predicted = plan;
                return Ok(());
            }
            Content::Counts(CountsGiven { faces, lost }) => {
                let name = format!("counts {number}");
                self.counts.push(Counted {
                    name,
                    plan,
                    faces,
                    lost,
                });
                self.places.push(place);
                return Ok(());
            }
            Content::Film(drops) => {
                let law = plan.points[0].engine.law();
                let fitted = drops.fitted(&scene, law, folder, &mut taken.films);
                let filmed = fitted.map_err(|problems| place.problems(problems))?;
                let remarks = filmed.remarks.iter();
                self.film_remarks
                    .extend(remarks.map(|remark| format!("film {number}: {remark}")));
                (filmed.reduced, 1.0)
            }
            Content::RollOut(roll) => (roll.reduce(&scene), roll.excess()),
            Content::Tilt(tilt) => (tilt.reduce(&scene), tilt.excess()),
            Content::SpinDown(spin) => (spin.reduce(&scene), spin.excess()),
            Content::Whirr(whirr) => (whirr.reduce(&scene), whirr.excess()),
            Content::Bounces(bounces) => (bounces.reduce(&scene), bounces.excess()),
        };
        let kind = kind.expect("a measurement has a kind");
        self.take(kind, number, reduced, (&scene, parameters), &place)?;
        taken.places.resize(self.readings.len(), place);
        Ok(())
    }

    /// Adds the numbers of one table.
    fn take(
        &mut self,
        kind: Kind,
        number: usize,
        (reduced, excess): (Vec<Reduced>, f64),
        (scene, parameters): (&Scene, &[Parameter]),
        place: &Place,
    ) -> Result<(), Diagnostics> {
        if reduced.is_empty() {
            return Err(place.problem("these readings determine nothing", None));
        }
        for Reduced {
            law,
            value,
            absolute,
            relative,
        } in reduced
        {
            let parameter = law.parameter();
            if !parameters.contains(&parameter) {
                return Err(place.problem(
                    format!("this engine knows no {}", parameter.words()),
                    Some("use [engine.volumetric]".to_owned()),
                ));
            }
            if parameter == Parameter::Restitution && scene.surface.restitution_exponent() != 0.0 {
                return Err(place.problem(
                    "a restitution that falls with speed cannot be read from bounces: its law is for a \
                     constant one",
                    Some("leave out surface.restitution_exponent".to_owned()),
                ));
            }
            self.readings.push(Reading {
                kind,
                name: format!("{} {number}", kind.name()),
                law,
                value,
                absolute,
                relative,
                excess,
            });
        }
        Ok(())
    }

    /// What was taken for the scene, without what is calibrated.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        let calibrated = |note: &&str| {
            let mut keys = self.priors.iter().map(|prior| prior.parameter.key());
            keys.any(|key| note.starts_with(&format!("surface.{key} is not given")))
        };
        let notes = self.plan.notes.iter().map(String::as_str);
        notes.filter(move |note| !calibrated(note))
    }

    /// The same with the ground as the scene says, so that its slope is not calibrated.
    #[must_use]
    pub fn with_known_ground(mut self) -> Self {
        self.priors
            .retain(|prior| prior.parameter != Parameter::RoughnessSlope);
        self
    }

    /// The parameters, in the order of every table and array.
    pub fn parameters(&self) -> Vec<Parameter> {
        self.priors.iter().map(|prior| prior.parameter).collect()
    }
}

/// One scene, in which coins are tossed.
fn check(plan: &Plan) -> Result<(), CalibrationError> {
    if !plan.axes.is_empty() {
        return Err(CalibrationError::Swept(plan.axes.join(", ")));
    }
    if !plan.points[0].engine.makes_tosses() {
        return Err(CalibrationError::NoTosses);
    }
    let landing = plan.points[0].scene.surface.landing();
    if landing == coinmc_core::Landing::Adhesive {
        return Err(CalibrationError::Adhesive);
    }
    Ok(())
}

/// The sections of a config of a calibration.
fn sections() -> Vec<Section<Content>> {
    let section = |name, doc, kind, own, read| Section {
        name,
        doc,
        kind,
        many: true,
        own,
        read,
    };
    let once = |name, doc, kind, own, read| Section {
        name,
        doc,
        kind,
        many: false,
        own,
        read,
    };
    vec![
        once(
            "prior",
            "What is believed before anything is measured.",
            prior_given::schema(),
            &[],
            |v| prior_given::read(v).map(Content::Prior),
        ),
        once(
            "predict",
            "The coin and the launch to predict.",
            fields(vec![]),
            OWN,
            |_| Ok(Content::Predict),
        ),
        section(
            "counts",
            "Counts of tosses.",
            CountsGiven::schema(),
            OWN,
            |v| CountsGiven::read(v).map(Content::Counts),
        ),
        section("film", "Filmed drops.", Drops::schema(), OWN, |v| {
            Drops::read(v).map(Content::Film)
        }),
        section(
            "roll_out",
            "Rolls from a ramp.",
            RollOut::schema(),
            OWN,
            |v| RollOut::read(v).map(Content::RollOut),
        ),
        section(
            "tilt",
            "Angles at which the coin slides.",
            Tilt::schema(),
            OWN,
            |v| Tilt::read(v).map(Content::Tilt),
        ),
        section(
            "spin_down",
            "Spins that slow down.",
            SpinDown::schema(),
            OWN,
            |v| SpinDown::read(v).map(Content::SpinDown),
        ),
        section(
            "whirr",
            "The pitch of a coin that whirrs.",
            Whirr::schema(),
            OWN,
            |v| Whirr::read(v).map(Content::Whirr),
        ),
        section(
            "bounces",
            "Impacts of a coin that was dropped flat.",
            Bounces::schema(),
            OWN,
            |v| Bounces::read(v).map(Content::Bounces),
        ),
    ]
}

#[cfg(test)]
mod tests;
