//! What the other crates of roadmill need of this one, and nobody else: it may change with every version.

pub mod csv_field;
pub mod plain;
pub mod regular;
pub mod shelf;
pub mod wire;
