//! What makes a description of a deformable robot sound, whether it comes from a file or from bytes.

use super::settings::{
    BoundingBoxSettings, DeformationMethod, DeformationSettings, Feasibility, GeometricSettings,
};
use super::{Deformable, surface};
use crate::model::Description;
use crate::model::bodies::validity::MotionChecking;
use crate::model::bodies::{Bodies, FINEST, diagonal_of};
use crate::scene::{LENGTH_MAX, Shape};
use crate::source::Step::{self, Index, Key};

/// The most scales.
pub(super) const SCALES_MAX: usize = 64;
/// The least scale.
const SCALE_MIN: f64 = 0.01;
/// The most random vectors.
const VECTORS_MAX: u32 = 10_000;
/// The most points of a lattice along an axis, and in all. A deformation looks at every point many times, and is to take seconds at most.
const ROW_MAX: u32 = 200;
const POINTS_MAX: u64 = 1 << 15;
/// The largest shares of distances at rest.
const STRETCH_MAX: f64 = 1e6;
/// The most sweeps of relaxation, rounds of pushing and directions.
const ROUNDS_MAX: u32 = 1000;
/// Into so many parts the longest edge of the robot's bounding box can be cut.
const EDGES_MAX: f64 = 64.0;

/// What is wrong: the place in a problem file, what was found and what is expected.
type Complaint = (Vec<Step<'static>>, String);

impl Deformable {
    /// What is wrong with the description, if anything, given that its bodies are sound.
    pub(super) fn complaint(&self) -> Option<Complaint> {
        let Deformable { bodies, feasibility, deformation, longest_edge } = self;
        of_robot(bodies)
            .or_else(|| of_longest_edge(bodies, *longest_edge))
            .or_else(|| match feasibility {
                Feasibility::Scaled { scales, centre } => self.of_scales(scales, *centre),
                Feasibility::Penetrating { depth, vectors } => {
                    of_penetration(bodies, *depth, *vectors)
                }
            })
            .or_else(|| of_deformation(bodies, deformation))
    }

    fn of_scales(&self, scales: &[f64], centre: [f64; 3]) -> Option<Complaint> {
        let place = vec![Key("deformable"), Key("feasibility"), Key("scales")];
        if !(1..=SCALES_MAX).contains(&scales.len()) {
            let found = if scales.len() > SCALES_MAX { "more" } else { "none" };
            return Some((place, format!("{found} found; 1 to {SCALES_MAX} scales expected")));
        }
        if scales[0] != 1.0 {
            let expected = "1, the robot itself, expected first";
            return Some((place, format!("{} found first; {expected}", scales[0])));
        }
        for pair in scales.windows(2) {
            // Written so that NaN fails it.
            let fits = pair[1] < pair[0] && pair[1] >= SCALE_MIN;
            if !fits {
                let expected = format!("less than that, at least {SCALE_MIN}, expected");
                return Some((place, format!("{} found after {}; {expected}", pair[1], pair[0])));
            }
        }
        let place = vec![Key("deformable"), Key("feasibility"), Key("centre")];
        // Written so that NaN fails it.
        if !centre.iter().all(|value| value.abs() <= LENGTH_MAX) {
            let expected = format!("lengths within ±{LENGTH_MAX:e} expected");
            return Some((place, format!("{centre:?} found; {expected}")));
        }
        // A scaled robot may have lengths that are 0 or beyond what bodies may have.
        scales.iter().skip(1).find_map(|scale| {
            let why = self.scaled(*scale, centre).sound().err()?;
            Some((place.clone(), format!("at scale {scale} {why}")))
        })
    }
}

fn of_robot(bodies: &Bodies) -> Option<Complaint> {
    let links = bodies.robot.links.len();
    if links != 1 {
        let message = format!(
            "{links} links found beside [deformable]; a robot of one body or several without joints expected"
        );
        return Some((vec![Key("robot"), Key("links")], message));
    }
    let open = |(index, body): (usize, &crate::scene::Body)| {
        let message = match &body.shape {
            Shape::Point => {
                "a point found, which has no surface; a shape with an extent expected".to_owned()
            }
            Shape::Mesh(mesh) => mesh.surface_complaint()?,
            _ => return None,
        };
        Some((vec![Key("robot"), Key("bodies"), Index(index), Key("shape")], message))
    };
    if let Some(complaint) = bodies.robot.bodies().enumerate().find_map(open) {
        return Some(complaint);
    }
    matches!(bodies.edges, MotionChecking::Penetrating { .. }).then(|| {
        let message = "penetrating found beside [deformable]; \"swept\" or \"sampled\" expected, and the depth as deformable.feasibility";
        (vec![Key("space"), Key("edges")], message.to_owned())
    })
}

fn of_longest_edge(bodies: &Bodies, longest_edge: f64) -> Option<Complaint> {
    let place = vec![Key("deformable"), Key("longest_edge")];
    let least = surface::longest_side(bodies) / EDGES_MAX;
    // Written so that NaN fails it.
    let fits = longest_edge > 0.0 && longest_edge >= least && longest_edge <= LENGTH_MAX;
    if !fits {
        let expected = format!(
            "a length of at least {least}, a 64th of the longest edge of the robot's bounding box, expected"
        );
        return Some((place, format!("{longest_edge} found; {expected}")));
    }
    let surface = surface::surface(bodies, longest_edge);
    surface::has_longer_edge(&surface, longest_edge).then(|| {
        let most = surface::TRIANGLES_MAX;
        let expected = format!("at most {most} expected, by longer edges");
        (place, format!("{longest_edge} found, by which the robot has more triangles; {expected}"))
    })
}

fn of_penetration(bodies: &Bodies, depth: f64, vectors: u32) -> Option<Complaint> {
    let farthest = bodies.space().diameter();
    // Written so that NaN fails it.
    let fits = depth > 0.0 && depth < farthest;
    if !fits {
        let expected = format!(
            "a length above 0, less than the largest distance in the space, {farthest}, expected"
        );
        let place = vec![Key("deformable"), Key("feasibility"), Key("depth")];
        return Some((place, format!("{depth} found; {expected}")));
    }
    (!(1..=VECTORS_MAX).contains(&vectors)).then(|| {
        let place = vec![Key("deformable"), Key("feasibility"), Key("vectors")];
        (place, format!("{vectors} found; 1 to {VECTORS_MAX} expected"))
    })
}

impl DeformationSettings {
    /// What is wrong with the settings for a robot among these bodies, if anything: the key, what was found and what is expected.
    pub(crate) fn complaint(&self, bodies: &Bodies) -> Option<String> {
        let (place, message) = of_deformation(bodies, self)?;
        let key = place.iter().rev().find_map(|step| match step {
            Key(key) => Some(*key),
            Index(_) => None,
        });
        Some(format!("{}: {message}", key.unwrap_or_default()))
    }
}

impl BoundingBoxSettings {
    /// What is wrong with the settings, if anything: the key, what was found and what is expected.
    pub fn complaint(&self) -> Option<(&'static str, String)> {
        of_box(self)
    }
}

impl GeometricSettings {
    /// What is wrong with the settings, if anything: the key, what was found and what is expected.
    pub fn complaint(&self) -> Option<(&'static str, String)> {
        of_geometric(self)
    }
}

fn of_deformation(bodies: &Bodies, settings: &DeformationSettings) -> Option<Complaint> {
    let DeformationSettings { method, highest_energy, clearance, step } = settings;
    let (name, complaint) = match method {
        DeformationMethod::BoundingBox(settings) => ("bounding-box", of_box(settings)),
        DeformationMethod::Geometric(settings) => ("geometric", of_geometric(settings)),
    };
    if let Some((key, message)) = complaint {
        return Some((vec![Key("deformable"), Key("method"), Key(name), Key(key)], message));
    }
    let place = |key| vec![Key("deformable"), Key(key)];
    // Each written so that NaN fails it.
    let fits = *highest_energy >= 0.0;
    if !fits {
        let expected = "an energy of at least 0, or \"none\", expected";
        return Some((place("highest_energy"), format!("{highest_energy} found; {expected}")));
    }
    let finest = FINEST * diagonal_of(&bodies.bounds, bodies.robot.motion);
    if *clearance != 0.0 && !(finest..=LENGTH_MAX).contains(clearance) {
        let expected = format!("0, or a length of at least {finest:e}, expected");
        return Some((place("clearance"), format!("{clearance} found; {expected}")));
    }
    (!(finest..=LENGTH_MAX).contains(step)).then(|| {
        let expected = format!("a length of at least {finest:e} expected");
        (place("step"), format!("{step} found; {expected}"))
    })
}

/// The key of what is wrong, what was found and what is expected.
fn of_box(settings: &BoundingBoxSettings) -> Option<(&'static str, String)> {
    let BoundingBoxSettings {
        lattice,
        least,
        greatest,
        shear,
        relaxation,
        order: _,
        interpolation: _,
    } = settings;
    if let Some(points) = lattice.iter().find(|points| !(2..=ROW_MAX).contains(points)) {
        return Some((
            "lattice",
            format!("{points} found; 2 to {ROW_MAX} points along each axis expected"),
        ));
    }
    let all = lattice.iter().map(|points| u64::from(*points)).product::<u64>();
    if all > POINTS_MAX {
        let [x, y, z] = lattice;
        return Some((
            "lattice",
            format!("{x} × {y} × {z} = {all} found; at most {POINTS_MAX} points expected"),
        ));
    }
    // Each written so that NaN fails it.
    if let Some(share) = least.iter().find(|share| !(**share > 0.0 && **share <= 1.0)) {
        return Some(("least", format!("{share} found; a share above 0, at most 1, expected")));
    }
    if let Some(share) = greatest.iter().find(|share| !(1.0..=STRETCH_MAX).contains(*share)) {
        return Some((
            "greatest",
            format!("{share} found; a share of at least 1, at most {STRETCH_MAX}, expected"),
        ));
    }
    if !(0.0..=STRETCH_MAX).contains(shear) {
        return Some((
            "shear",
            format!("{shear} found; a share of at least 0, at most {STRETCH_MAX}, expected"),
        ));
    }
    (*relaxation > ROUNDS_MAX).then(|| {
        ("relaxation", format!("{relaxation} found; at most {ROUNDS_MAX} sweeps expected"))
    })
}

/// The same.
fn of_geometric(settings: &GeometricSettings) -> Option<(&'static str, String)> {
    let GeometricSettings {
        directions,
        shortest,
        longest,
        neighbourhood,
        guide,
        rounds,
        refuse_self_collisions: _,
    } = settings;
    if *directions > ROUNDS_MAX {
        return Some(("directions", format!("{directions} found; at most {ROUNDS_MAX} expected")));
    }
    if !(0.0..=1.0).contains(shortest) {
        return Some(("shortest", format!("{shortest} found; a share from 0 to 1 expected")));
    }
    if !(1.0..=STRETCH_MAX).contains(longest) {
        return Some((
            "longest",
            format!("{longest} found; a share of at least 1, at most {STRETCH_MAX}, expected"),
        ));
    }
    if !(0.0..=LENGTH_MAX).contains(neighbourhood) {
        return Some((
            "neighbourhood",
            format!("{neighbourhood} found; a length of at least 0 expected"),
        ));
    }
    // Written so that NaN fails it.
    let fits = *guide > 0.0 && *guide < 1.0;
    if !fits {
        return Some(("guide", format!("{guide} found; a scale above 0, below 1, expected")));
    }
    (!(1..=ROUNDS_MAX).contains(rounds))
        .then(|| ("rounds", format!("{rounds} found; 1 to {ROUNDS_MAX} expected")))
}
