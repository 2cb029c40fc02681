//! roadmill grows probabilistic roadmaps and always gives the same one, bit for bit.

pub mod connect;
mod context;
pub mod evaluate;
pub mod export;
pub mod img;
pub mod local;
pub mod math;
pub mod methods;
pub mod neighbor;
pub mod problem;
pub mod query;
pub mod roadmap;
pub mod sampler;
pub mod scene;
pub mod seed;
pub mod space;
mod strategy;
pub mod validity;
pub mod wire;

pub use context::{Context, Ends};
pub use strategy::Strategy;

/// Version of the bits: raised whenever the same problem and seed come to give another roadmap.
pub const BITS_VERSION: u32 = 1;
