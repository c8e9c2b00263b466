//! Closed forms as an engine without tosses.

use coinmc_analytic::Rule;
use coinmc_core::schema::{Absent, Kind, TableKind, Word, field, fields};
use coinmc_core::{
    Answer, EngineChoice, EngineDescriptor, EngineError, EngineKind, EngineSettings, Scene,
    Unmodelled,
};

/// The engine, as configs and results know it.
pub(super) const ENGINE: EngineDescriptor = EngineDescriptor {
    name: "analytic",
    doc: "A closed form in the ratio alone: no toss is made.",
    kind: EngineKind::ClosedForm,
    stepped: false,
    laws: &[],
    unmodelled: &[
        Unmodelled {
            table: "coin",
            key: "rim_radius_m",
            message: "closed forms know sharp rims only: `coin.rim_radius_m` must be 0",
            help: "remove `rim_radius_m`, or toss in space with [engine.volumetric]",
        },
        Unmodelled {
            table: "coin",
            key: "draft_deg",
            message: "closed forms know cylinders only: `coin.draft_deg` must be 0",
            help: "remove `draft_deg`, or toss in space with [engine.volumetric]",
        },
        Unmodelled {
            table: "coin",
            key: "centre_of_mass_over_height",
            message: "closed forms know coins with their centre of mass in the middle only: \
                      `coin.centre_of_mass_over_height` must be 0",
            help: "remove `centre_of_mass_over_height`, or toss in space with [engine.volumetric]",
        },
        Unmodelled {
            table: "surface",
            key: "table_radius_m",
            message: "closed forms know no edge of the table: `surface.table_radius_m` must be absent",
            help: "remove `table_radius_m`, or toss in space with [engine.volumetric]",
        },
        Unmodelled {
            table: "surface",
            key: "table_tilt_deg",
            message: "closed forms know level tables only: `surface.table_tilt_deg` must be 0",
            help: "remove `table_tilt_deg`, or toss in space with [engine.volumetric]",
        },
    ],
    finer: &[],
    remarks: &[],
    schema,
    read: |values| {
        let rule = values.one_of("rule", Rule::ALL, Rule::name)?;
        Ok(EngineChoice::new(ClosedForm(rule)))
    },
};

fn schema() -> TableKind {
    let rules = Rule::ALL.map(|rule| Word {
        name: rule.name(),
        doc: rule.assumption(),
    });
    let rules = Kind::Word(rules.to_vec());
    fields(vec![field(
        "rule",
        "The closed form.",
        rules,
        Absent::Required,
    )])
}

/// The settings of this engine: the probability is exact under the rule's assumptions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClosedForm(pub Rule);

impl EngineSettings for ClosedForm {
    fn descriptor(&self) -> &'static EngineDescriptor {
        &ENGINE
    }

    fn law(&self) -> &'static str {
        self.0.name()
    }

    fn explain(&self, _: &Scene) -> String {
        let Self(rule) = self;
        format!(
            "closed form {rule}: P(side) = {}, x = H/R ({})",
            rule.formula(),
            rule.assumption()
        )
    }

    fn build(&self, scene: &Scene) -> Result<Answer, EngineError> {
        let p = self.0.probabilities(scene.coin.ratio());
        Ok(Answer::Exact([p.heads, p.tails, p.side]))
    }
}
