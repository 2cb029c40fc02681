//! Chapter 4: samples on the surfaces of C-obstacles.

mod cells;
mod cost;
mod dots;
mod draws;
mod lengths;
mod motion;
mod ompl;
mod passages;
mod picture;
mod report;
mod scenes;
mod torus;

use super::Study;

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
    Study {
        name: "figure-4.12",
        about: "a torus: distribution error over triangles",
        run: torus::study,
    },
    Study { name: "table-4.4", about: "what samples cost around one ball", run: cost::single },
    Study { name: "table-4.5", about: "what samples cost in the Tunnel", run: cost::tunnels },
    Study {
        name: "table-4.6",
        about: "a query in the Tunnel, by two robots",
        run: motion::tunnels,
    },
    Study { name: "table-4.7", about: "a query in the Z-Tunnel", run: motion::z },
    Study {
        name: "figure-4.14",
        about: "passages of three widths: the share of 1000 samples",
        run: passages::fixed_samples,
    },
    Study {
        name: "figure-4.15",
        about: "passages of three widths: samples until 100 are in",
        run: passages::fixed_inside,
    },
    Study {
        name: "figure-4.18",
        about: "Lemma 2: UOBPRM and Gaussian with one length; draws Figure 4.19",
        run: lengths::study,
    },
    Study {
        name: "cost-ompl",
        about: "what samples cost beside OMPL's samplers",
        run: ompl::study,
    },
];
