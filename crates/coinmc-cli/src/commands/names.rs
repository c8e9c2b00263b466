//! Arguments that are one of a few names: a shell completes them.

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};
use coinmc_core::Face;
use std::ffi::OsStr;

/// Names that a shell offers. Others are read, too: the command says what is wrong with them, and all at once.
#[derive(Clone)]
pub(super) struct Names(fn() -> Vec<&'static str>);

impl TypedValueParser for Names {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, Error> {
        StringValueParser::new().parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.0)().into_iter().map(PossibleValue::new)))
    }
}

/// Everyday scenes.
pub(super) fn scenes() -> Names {
    Names(|| {
        let scenes = coinmc_questions::scenes::EverydayScene::ALL;
        scenes.iter().map(|scene| scene.name).collect()
    })
}

/// Materials of a surface.
pub(super) fn materials() -> Names {
    Names(|| {
        let materials = coinmc_core::Material::ALL;
        materials.iter().map(|material| material.name).collect()
    })
}

/// Launches of the atlas.
pub(super) fn launches() -> Names {
    Names(|| {
        let launches = coinmc_atlas::Launch::ALL;
        launches.iter().map(|launch| launch.name()).collect()
    })
}

/// Claims and data sets of a validation.
pub(super) fn claims() -> Names {
    Names(|| coinmc_validate::names().collect())
}

/// Faces.
pub(super) fn face() -> impl TypedValueParser<Value = Face> {
    let faces = Names(|| Face::ALL.iter().map(|face| face.name()).collect());
    faces.try_map(|name| super::face(&name))
}
