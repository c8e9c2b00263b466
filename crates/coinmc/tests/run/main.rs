//! Runs: cut into chunks, broken off, merged and damaged, they count the same.

mod chunks;
mod damage;
mod durable;
mod edge;
mod extend;
mod full_disk;
mod in_memory;
mod integrated;
mod merge;
mod provenance;
mod resume;
mod same_side;
mod small;
mod stopping;
mod support;
