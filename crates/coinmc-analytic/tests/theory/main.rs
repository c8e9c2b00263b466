//! Every closed form against an independent computation: the mechanics of the landing, wells found
//! by minimisation, rigid-body motion integrated step by step, sampling, and 80-digit references.

mod accuracy;
mod inverses;
mod keller;
mod landing;
mod measure;
mod no_mechanics;
mod precession;
mod properties;
mod random;
mod rules;
mod tipping;
mod wells;
