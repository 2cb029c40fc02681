//! The scenes of the three experiments (O. B. Bayazit's dissertation, 2003, Figure 30), in their spirit: the
//! paper gives no measures. Lengths are in a unit of their own.

use super::nets::{Surface, surface};
use super::shapes::{LETTERS, ball, letter, seal, teapot};
use std::path::{Path, PathBuf};

/// A scene: what of its problem file is always the same, and its meshes.
pub struct Scene {
    /// The experiment.
    pub name: &'static str,
    /// Space, robot, obstacles and query.
    tables: String,
    /// The files of meshes with their names.
    pub meshes: Vec<(String, Surface)>,
    /// The sampler of the experiment, as a problem file names it.
    pub sampler: &'static str,
    /// The settings of the method `bounding-box`; none: the defaults.
    material: &'static str,
    /// The environmental resolution, of which penetration depths are multiples.
    pub resolution: f64,
    /// The longest edge that the robot's triangles may have: none is halved.
    longest_edge: f64,
}

/// How a roadmap is built and a query deforms.
pub struct Ways<'a> {
    /// The value of `feasibility`.
    pub feasibility: &'a str,
    /// The value of `method`.
    pub method: &'a str,
    /// The nodes of the roadmap, drawn as one set.
    pub nodes: usize,
}

/// The scene of this name.
pub fn scene(name: &str) -> Scene {
    match name {
        "sliding" => sliding(),
        "narrow" => narrow(),
        "stamping" => stamping(),
        _ => panic!("scene `{name}` found; sliding, narrow or stamping expected"),
    }
}

impl Scene {
    /// A method of deformation with the settings of the scene, as a problem file names it.
    pub fn method(&self, label: &str) -> String {
        let settings = if label == "bounding-box" { self.material } else { "" };
        format!("{{ {label} = {{ {settings} }} }}")
    }

    /// The text of the problem file.
    pub fn problem(&self, ways: &Ways) -> String {
        let Ways { feasibility, method, nodes } = ways;
        let (tables, sampler, longest) = (&self.tables, self.sampler, self.longest_edge);
        format!(
            "{tables}\n[deformable]\nfeasibility = {feasibility}\nmethod = {method}\nlongest_edge = {longest}\n\n\
             [img]\nsets_per_round = 1\n\n[[strategies]]\nlabel = \"all\"\nnodes = {nodes}\nsampler = {{ {sampler} }}\n\n\
             [limits]\nsets = 1\n"
        )
    }

    /// Writes the problem file and its meshes to a folder.
    pub fn write(&self, folder: &Path, ways: &Ways) -> PathBuf {
        std::fs::create_dir_all(folder).expect("a folder can be made");
        for (name, mesh) in &self.meshes {
            std::fs::write(folder.join(name), mesh.obj()).expect("a mesh can be written");
        }
        let path = folder.join(format!("{}.toml", self.name));
        std::fs::write(&path, self.problem(ways)).expect("a problem can be written");
        path
    }
}

/// The name of a letter's mesh.
pub fn letter_file(name: char) -> String {
    format!("letter-{}.obj", name.to_ascii_lowercase())
}

/// OBPRM moves milestones to where the smallest robot touches, which is where deforming is hardest, so that half of the milestones are
/// drawn uniformly.
///
/// A letter, 1 high, slides upright through a gap of 0.8 between two cylinders. The path is found for D and applied to the others.
fn sliding() -> Scene {
    let mesh = |name: char| {
        let shape = move |point| letter(name, point);
        (letter_file(name), surface(0.08, [0.6, 0.6, 0.2], &shape))
    };
    Scene {
        name: "sliding",
        tables: "[space]\nmotion = \"translation-3d\"\nmin = [-3.0, -1.6, -0.5]\nmax = [3.0, 1.6, 0.5]\nbounds = \"body\"\nresolution = 0.03\n\n\
            [robot]\nbodies = [{ shape = { mesh = { file = \"letter-d.obj\" } } }]\n\n\
            [[obstacles]]\nshape = { cylinder = { radius = 2.4, height = 1.2 } }\nposition = [0.0, -2.9, 0.0]\n\
            [[obstacles]]\nshape = { cylinder = { radius = 3.0, height = 1.2 } }\nposition = [0.0, 3.3, 0.0]\n\n\
            [query]\nstart = [-2.2, 0.0, 0.0]\ngoal = [2.2, 0.0, 0.0]\n"
            .to_owned(),
        meshes: LETTERS.iter().map(|name| mesh(*name)).collect(),
        sampler: "mix = [{ sampler = { obprm = { step = 0.1 } } }, { sampler = { uniform = {} } }]",
        // A letter is thin: with the default lattice its points along z are too near to one another to be displaced past.
        material: "lattice = [9, 9, 3], shear = 2.0, least = 0.3, greatest = 2.0",
        resolution: 0.03,
        longest_edge: 0.25,
    }
}

/// Of the narrow passage the shell's radius, and of each of the four spheres how far its centre is from the axis, and its radius.
const SHELL: f64 = 3.8;
const SPHERES: [[f64; 2]; 4] = [[2.93, 2.0], [3.05, 2.15], [2.90, 1.95], [3.08, 2.2]];

/// A ball of radius 1 passes between four spheres of different sizes within a shell; the hole between them has a radius of about 0.9.
fn narrow() -> Scene {
    let mut tables = format!(
        "[space]\nmotion = \"translation-3d\"\nmin = [-{SHELL}, -{SHELL}, -{SHELL}]\nmax = [{SHELL}, {SHELL}, {SHELL}]\nbounds = \"body\"\n\
         resolution = 0.06\n\n[robot]\nbodies = [{{ shape = {{ mesh = {{ file = \"ball.obj\" }} }} }}]\n\n\
         [[obstacles]]\nshape = {{ mesh = {{ file = \"shell.obj\" }} }}\nsolid = false\n"
    );
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    for ([apart, radius], corner) in SPHERES.iter().zip(corners) {
        let [y, z] = corner.map(|side: f64| side * apart * 0.5f64.sqrt());
        tables += &format!(
            "[[obstacles]]\nshape = {{ sphere = {{ radius = {radius} }} }}\nposition = [0.0, {y}, {z}]\n"
        );
    }
    tables += "\n[query]\nstart = [-2.5, 0.0, 0.0]\ngoal = [2.5, 0.0, 0.0]\n";
    let robot = surface(0.19, [1.0; 3], &|point| ball(point, 1.0));
    let shell = surface(0.4, [SHELL; 3], &|point| ball(point, SHELL));
    Scene {
        name: "narrow",
        tables,
        meshes: vec![("ball.obj".to_owned(), robot), ("shell.obj".to_owned(), shell)],
        sampler: "uniform = {}",
        material: "",
        resolution: 0.06,
        longest_edge: 0.5,
    }
}

/// A teapot is pressed onto a seal until its bottom is 0.22 below the tops of the relief.
fn stamping() -> Scene {
    Scene {
        name: "stamping",
        tables: "[space]\nmotion = \"rigid-3d\"\nmin = [-2.2, -2.2, -0.6]\nmax = [2.2, 2.2, 3.2]\nbounds = \"body\"\nresolution = 0.05\n\n\
            [robot]\nbodies = [{ shape = { mesh = { file = \"teapot.obj\" } } }]\n\n\
            [[obstacles]]\nshape = { mesh = { file = \"seal.obj\" } }\n\n\
            [query]\nstart = [0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0]\ngoal = [0.0, 0.0, 0.68, 1.0, 0.0, 0.0, 0.0]\n"
            .to_owned(),
        meshes: vec![
            ("teapot.obj".to_owned(), surface(0.11, [1.45, 1.0, 1.0], &teapot)),
            ("seal.obj".to_owned(), surface(0.12, [1.85, 1.85, 0.65], &seal)),
        ],
        sampler: "uniform = {}",
        material: "",
        resolution: 0.05,
        longest_edge: 0.4,
    }
}
