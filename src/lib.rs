//! roadmill grows probabilistic roadmaps and always gives the same one, bit for bit.
//!
//! This is the planning library: problems, configuration spaces, validity, sampling, connection,
//! evaluation, and Incremental Map Generation (TR05-007) as a state machine. It starts no process,
//! reads no clock and has no randomness but what follows from a problem's seed. The program around
//! it, which works in many processes, is the crate `roadmill-coordinator`.
//!
//! # A roadmap in ten lines
//!
//! ```
//! use roadmill::{Build, problem::Problem};
//!
//! let problem = Problem::load("problems/maze.toml".as_ref())?;
//! let built = Build::new(problem).threads(2).run()?;
//! let path = built.path().expect("the maze has a way through");
//! for q in path {
//!     println!("{q:?}");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The problem of these lines is read from a file; [`problem::ProblemBuilder`] makes one from values.
//!
//! [`Build`] also tells how far it is and can be cancelled. What it comes to is a [`Built`]: the roadmap, the path
//! of the problem's query, what each evaluator said, answers to [other queries](Built::query), and the way to
//! [go on](Built::resume).
//!
//! # Units and frames
//!
//! Lengths are in the unit of the problem file, angles in radians, rotations unit quaternions
//! `w x y z`. A configuration is a flat slice with one value per degree of freedom; for rigid bodies
//! it is the pose of the robot's frame in the world's.

mod build;
mod cancel;
mod context;
mod digest;
mod lanes;

pub mod binding;
pub mod clearance;
pub mod connect;
pub mod deformation;
pub mod descent;
pub mod device_rate;
pub mod evaluate;
pub mod export;
pub mod finder;
pub mod folding;
pub mod generator;
pub mod img;
#[doc(hidden)]
pub mod internal;
pub mod ligand;
pub mod local;
pub mod math;
pub mod methods;
pub mod model;
pub mod neighbor;
pub mod numbers;
pub mod pathways;
pub mod problem;
pub mod push;
pub mod query;
pub mod relaxation;
pub mod replan;
pub mod roadmap;

pub mod sampler;
pub mod scene;
pub mod schedule;
pub mod seed;
mod source;
pub mod space;
mod strategy;
pub mod structure;
pub mod survey;
pub mod uniformity;

use internal::{shelf, wire};

pub use build::{Build, BuildError, Built};
pub use cancel::Cancel;
pub use context::{Context, Ends};
pub use digest::SourceFile;
pub use strategy::Strategy;

/// Version of the bits: raised whenever the same problem and seed come to give another roadmap.
pub const BITS_VERSION: u32 = 3;

/// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
