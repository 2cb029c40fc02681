//! The environments of S. K. Nath's thesis (2013, §5.2.1) and their robots, made from a seed.

use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::{Purpose, Seed};
use std::fmt::Write;
use std::path::Path;

/// An environment with a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene {
    pub environment: Environment,
    pub robot: Robot,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Environment {
    /// 256 cubes of 0.2 at random places of a square of 10 by 10.
    Clutter,
    /// 125 cubes of 0.2 at random places of a box of 10 by 10 by 10.
    Clutter3d,
    /// A tunnel of width 1 among four big boxes, in a box of 40 by 1 by 10. The thesis shows it in a picture; here its three legs
    /// run along the whole length, one above the other, and join at alternate ends.
    Tunnel,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Robot {
    /// Of 0.2 in a clutter, where it does not turn, of 0.5 in the tunnel.
    Cube,
    /// Four links of 0.2 by 0.03 by 0.03.
    Linkage,
}

impl Scene {
    /// The scenes in which the thesis compares neighbours (§5.2.3.2).
    pub const ALL: [Scene; 4] = [
        Scene { environment: Environment::Clutter, robot: Robot::Cube },
        Scene { environment: Environment::Clutter, robot: Robot::Linkage },
        Scene { environment: Environment::Tunnel, robot: Robot::Cube },
        Scene { environment: Environment::Tunnel, robot: Robot::Linkage },
    ];

    pub fn name(self) -> &'static str {
        match (self.environment, self.robot) {
            (Environment::Clutter, Robot::Cube) => "clutter, cube",
            (Environment::Clutter, Robot::Linkage) => "clutter, linkage",
            (Environment::Clutter3d, Robot::Cube) => "3D clutter, cube",
            (Environment::Clutter3d, Robot::Linkage) => "3D clutter, linkage",
            (Environment::Tunnel, Robot::Cube) => "tunnel, cube",
            (Environment::Tunnel, Robot::Linkage) => "tunnel, linkage",
        }
    }

    /// The largest distance of an extension.
    pub fn step(self) -> f64 {
        match self.environment {
            Environment::Clutter | Environment::Clutter3d => 0.5,
            Environment::Tunnel => 1.0,
        }
    }

    /// The problem's text without strategies. Obstacles follow from `seed`.
    pub fn text(self, seed: u64) -> String {
        let mut text = format!("seed = {seed}\n");
        let motion = match (self.environment, self.robot) {
            (Environment::Clutter, Robot::Cube) => "translation-2d",
            (Environment::Clutter, Robot::Linkage) => "rigid-2d",
            (Environment::Clutter3d, Robot::Cube) => "translation-3d",
            (Environment::Clutter3d, Robot::Linkage) | (Environment::Tunnel, _) => "rigid-3d",
        };
        let (min, max) = match self.environment {
            Environment::Clutter => ("[0, 0]", "[10, 10]"),
            Environment::Clutter3d => ("[0, 0, 0]", "[10, 10, 10]"),
            Environment::Tunnel => ("[0, 0, 0]", "[40, 1, 10]"),
        };
        let bounds = "bounds = \"body\"";
        let _ = writeln!(
            text,
            "[space]\nmotion = \"{motion}\"\nmin = {min}\nmax = {max}\n{bounds}\n[robot]"
        );
        match self.robot {
            Robot::Cube => {
                let side = if self.environment == Environment::Tunnel { 0.5 } else { 0.2 };
                let _ = writeln!(
                    text,
                    "bodies = [{{ shape = {{ box = {{ size = [{side}, {side}, {side}] }} }} }}]"
                );
            }
            Robot::Linkage => text.push_str(&linkage(4)),
        }
        let (place, end) = match self.environment {
            Environment::Clutter => ("0.5, 0.5", "9.5, 9.5"),
            Environment::Clutter3d => ("0.5, 0.5, 0.5", "9.5, 9.5, 9.5"),
            Environment::Tunnel => ("1, 0.5, 3", "39, 0.5, 7"),
        };
        // In a clutter the linkage reaches along x from its base, into the scene at either end.
        let (turn, turn_at_goal) = match (self.environment, self.robot) {
            (Environment::Clutter | Environment::Clutter3d, Robot::Cube) => ("", ""),
            (Environment::Clutter, Robot::Linkage) => (", 0", ", -3.1"),
            (Environment::Clutter3d, Robot::Linkage) => (", 1, 0, 0, 0", ", 0, 0, 0, 1"),
            (Environment::Tunnel, _) => (", 1, 0, 0, 0", ", 1, 0, 0, 0"),
        };
        let joints = if self.robot == Robot::Linkage { ", 0, 0, 0" } else { "" };
        let _ = writeln!(
            text,
            "[query]\nstart = [{place}{turn}{joints}]\ngoal = [{end}{turn_at_goal}{joints}]"
        );
        match self.environment {
            Environment::Clutter => clutter::<2>(seed, 256, &mut text),
            Environment::Clutter3d => clutter::<3>(seed, 125, &mut text),
            Environment::Tunnel => tunnel(&mut text),
        }
        text
    }

    /// The obstacle that comes, where the thesis measures replanning (§5.2.2): in a clutter its cube of 2, in the middle. The
    /// tunnel, which is not in that study, would be closed by it; there a sill of 0.3 comes that narrows the middle leg to 0.7.
    pub fn newcomer(self) -> &'static str {
        match self.environment {
            Environment::Clutter => {
                "[[obstacles]]\nshape = { box = { size = [2, 2, 2] } }\nposition = [5, 5, 0]\n"
            }
            Environment::Clutter3d => {
                "[[obstacles]]\nshape = { box = { size = [2, 2, 2] } }\nposition = [5, 5, 5]\n"
            }
            Environment::Tunnel => {
                "[[obstacles]]\nshape = { box = { size = [2, 0.3, 1] } }\nposition = [20, 0.15, 5]\n"
            }
        }
    }

    /// The problem with one strategy, whose sets have so many nodes.
    pub fn problem(self, seed: u64, generator: &str, nodes: u64) -> Problem {
        let text = format!(
            "{}[img]\nsets_per_round = 1\n[[strategies]]\nlabel = \"graph\"\nnodes = {nodes}\ngenerator = {generator}\n",
            self.text(seed)
        );
        Problem::parse(Path::new("neighbors.toml"), &text).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// A chain of bars in a row, joined by axes across them.
pub fn linkage(links: usize) -> String {
    let bar =
        "bodies = [{ shape = { box = { size = [0.2, 0.03, 0.03] } }, position = [0.1, 0, 0] }]\n";
    let mut text = bar.to_owned();
    for link in 1..links {
        let _ = write!(
            text,
            "[[robot.links]]\nname = \"link{link}\"\n{bar}\
             joint = {{ kind = {{ revolute = {{ axis = [0, 0, 1] }} }}, before = {{ position = [0.2, 0, 0] }} }}\n"
        );
    }
    text
}

/// So many cubes in the plane z = 0, or in space.
fn clutter<const DIMENSIONS: usize>(seed: u64, count: usize, text: &mut String) {
    let mut stream = Seed::of_set(seed, "clutter", Ordinal(0)).stream(Purpose::Sampling);
    let mut cubes = 0;
    while cubes < count {
        let at = [0; DIMENSIONS].map(|_| 0.1 + 9.8 * stream.unit());
        // The ends of the query stay free.
        let is_near = |end: f64| at.iter().all(|place| (place - end).abs() < 1.0);
        if is_near(0.5) || is_near(9.5) {
            continue;
        }
        let (x, y, z) = (at[0], at[1], at.get(2).unwrap_or(&0.0));
        let _ = write!(
            text,
            "[[obstacles]]\nshape = {{ box = {{ size = [0.2, 0.2, 0.2] }} }}\nposition = [{x}, {y}, {z}]\n"
        );
        cubes += 1;
    }
}

fn tunnel(text: &mut String) {
    // From and to along x and z.
    for [from, to] in [
        [[0.0, 0.0], [40.0, 2.5]],
        [[0.0, 3.5], [39.0, 4.5]],
        [[1.0, 5.5], [40.0, 6.5]],
        [[0.0, 7.5], [40.0, 10.0]],
    ] {
        let [x, z] = [0, 1].map(|axis| (from[axis] + to[axis]) / 2.0);
        let [length, height] = [0, 1].map(|axis| to[axis] - from[axis]);
        let _ = write!(
            text,
            "[[obstacles]]\nshape = {{ box = {{ size = [{length}, 1, {height}] }} }}\nposition = [{x}, 0.5, {z}]\n"
        );
    }
}
