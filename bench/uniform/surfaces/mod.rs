//! Chapter 4: samples on the surfaces of C-obstacles.

use super::{Bench, Study};

pub const STUDIES: &[Study] = &[];
