//! Chapter 5: samples on the medial axis.

use super::{Bench, Study};

pub const STUDIES: &[Study] = &[];
