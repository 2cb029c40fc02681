//! Chapter 4: samples on the surfaces of C-obstacles.

mod cells;
mod dots;
mod draws;
mod picture;
mod report;
mod scenes;

use super::{Bench, Study};

pub const STUDIES: &[Study] = &[
    Study {
        name: "table-4.1",
        about: "one ball: shares of 16 cells; draws Figure 4.7",
        run: cells::single,
    },
    Study {
        name: "table-4.2",
        about: "four balls: shares of 16 cells; draws Figure 4.9",
        run: cells::four,
    },
    Study {
        name: "table-4.3",
        about: "balls and cubes: shares of 16 cells; draws Figure 4.11",
        run: cells::mixed,
    },
    Study { name: "figure-4.6", about: "one ball: where samples lie", run: dots::single },
    Study { name: "figure-4.8", about: "four balls: where samples lie", run: dots::four },
    Study { name: "figure-4.10", about: "balls and cubes: where samples lie", run: dots::mixed },
];
