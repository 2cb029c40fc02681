//! Gaps of bodies: where two stretches of one surface face each other nearby across free space.
//!
//! Lines along the normals of drawn points of the surface are cut by all of its triangles. The piece of a line next to the point on either side is
//! outside the body or inside, which the number of crossings beyond it tells. Pieces outside that end on surfaces which face each other are
//! made as short as they become by small random changes of the line; what shrinks to nothing is a corner and no gap. The rest are the gaps, of which
//! a wider one that lies around a narrower one does not count.

use super::bodies::BodyValidity;
use super::element::Element;
use crate::model::Gaps;
use crate::scene::Pose;
use crate::seed::{Purpose, Seed, Stream};
use parry3d_f64::math::Vector;

/// How many lines are cut by how many triangles, in all, once for lines along normals and once for their changes.
const CUTS: usize = 1_000_000;
/// How many lines are laid along normals, at least and at most.
const LINES: (usize, usize) = (64, 1024);
/// How many pieces outside the body are looked at closer, the shortest that are apart.
const CANDIDATES: usize = 16;
/// How often each is changed, at least and at most.
const CHANGES: (usize, usize) = (16, 64);
/// The first change of a line, as a share of the piece's length; and by what it is multiplied where a change makes the piece shorter, and where not.
const FIRST: f64 = 0.1;
const LARGER: f64 = 1.5;
const SMALLER: f64 = 0.85;
/// How many lines through the middle of a piece are to tell that it is outside.
const VOTES: u32 = 5;
/// A piece that shrinks to less than this share lay in a corner.
const CORNER: f64 = 0.2;
/// The least cosine of the angle between a line and the normals where its piece ends.
const FACING: f64 = 0.7;
/// How many gaps of a body count, the narrowest.
const MOST: usize = 3;
/// The width of a gap beside the thinnest place of the other body, from which on it can matter.
const WIDE_ENOUGH: f64 = 0.5;

/// A gap of a body, in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gap {
    pub middle: Vector,
    pub width: f64,
}

/// What lines along the normals of a body's surface tell of it.
struct Surface<'a> {
    triangles: Vec<&'a Element>,
    /// The pieces of lines outside the body, between two places of its surface that face each other.
    outside: Vec<Chord>,
    /// How thick the body is where it is thin: a tenth of the pieces inside it are shorter.
    thickness: f64,
    stream: Stream,
}

/// The gaps of a robot and of the obstacles, pair by pair.
#[derive(Debug, Default)]
pub(super) struct GapPairs {
    /// A link of the robot with its gap, and the gap of the obstacles.
    pairs: Vec<(usize, Gap, Gap)>,
}

/// A piece of a line between two crossings with a surface.
#[derive(Clone, Copy, Debug)]
struct Chord {
    middle: Vector,
    along: Vector,
    length: f64,
    is_outside: bool,
}

impl GapPairs {
    pub fn of(model: &BodyValidity) -> GapPairs {
        let Some(obstacles) = model.obstacles.as_ref().filter(|_| model.space.translations() == 3)
        else {
            return GapPairs::default();
        };
        let movers = model.links.iter().filter_map(|moving| {
            let surface = Surface::of(&moving.group.tree.elements)?;
            Some((moving.link, surface))
        });
        let movers: Vec<(usize, Surface)> = movers.collect();
        let still = if movers.is_empty() { None } else { Surface::of(&obstacles.tree.elements) };
        let Some(mut still) = still else { return GapPairs::default() };
        let mut pairs = Vec::new();
        for (link, mut mover) in movers {
            let own = mover.gaps(WIDE_ENOUGH * still.thickness);
            if own.is_empty() {
                continue;
            }
            let theirs = still.gaps(WIDE_ENOUGH * mover.thickness);
            for gap in &own {
                pairs.extend(theirs.iter().map(|other| (link, *gap, *other)));
            }
        }
        GapPairs { pairs }
    }

    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }
}

impl Gaps for BodyValidity {
    fn pairs(&self) -> usize {
        self.gap_pairs().pairs.len()
    }

    fn widths(&self, pair: usize) -> [f64; 2] {
        let (_, own, theirs) = self.gap_pairs().pairs[pair];
        [own.width, theirs.width]
    }

    fn align(&self, pair: usize, offset: [f64; 3], q: &mut [f64]) {
        let (link, own, theirs) = self.gap_pairs().pairs[pair];
        let mut poses: Vec<Pose> = Vec::new();
        self.robot.link_poses(q, &mut poses);
        let at = poses[link].apply(own.middle.to_array());
        let (to, offset) = (theirs.middle.to_array(), offset);
        for axis in 0..3 {
            q[axis] += to[axis] + offset[axis] - at[axis];
        }
    }
}

impl<'a> Surface<'a> {
    /// Looks at a surface; `None` where it has no two places that face each other outside, or inside.
    fn of(elements: &'a [Element]) -> Option<Surface<'a>> {
        let triangles: Vec<&Element> =
            elements.iter().filter(|e| e.radius == 0.0 && e.normal != Vector::ZERO).collect();
        let mut upto = 0.0;
        let mut areas = Vec::with_capacity(triangles.len());
        for triangle in &triangles {
            upto += triangle.normal.length();
            areas.push(upto);
        }
        let last = areas.len().checked_sub(1)?;
        let mut stream = Seed::of_evaluator(0, "gaps").stream(Purpose::Sampling);
        let (mut outside, mut inside) = (Vec::new(), Vec::new());
        for _ in 0..(CUTS / triangles.len()).clamp(LINES.0, LINES.1) {
            let drawn = stream.unit() * upto;
            let triangle = triangles[areas.partition_point(|upto| *upto <= drawn).min(last)];
            let (root, share) = (stream.unit().sqrt(), stream.unit());
            let [a, b, c] = triangle.corners;
            let point = a * (1.0 - root) + b * (root * (1.0 - share)) + c * (root * share);
            let along = triangle.normal.normalize();
            for chord in beside(&triangles, point, along).into_iter().flatten() {
                if chord.is_outside { outside.push(chord) } else { inside.push(chord.length) }
            }
        }
        inside.sort_by(f64::total_cmp);
        let thickness = *inside.get(inside.len() / 10)?;
        (!outside.is_empty()).then_some(Surface { triangles, outside, thickness, stream })
    }

    /// The gaps that are at least as wide as `least`, the narrowest first.
    fn gaps(&mut self, least: f64) -> Vec<Gap> {
        let wide = self.outside.iter().copied().filter(|chord| chord.length >= least).collect();
        let mut narrow = Vec::new();
        for chord in apart(wide, CANDIDATES) {
            if self.is_outside(chord.middle) {
                narrow.extend(self.narrowed(chord).filter(|chord| chord.length >= least));
            }
        }
        let gap = |chord: Chord| Gap { middle: chord.middle, width: chord.length };
        apart(narrow, MOST).into_iter().map(gap).collect()
    }

    /// Whether most lines through a point tell that it is outside: those through an opening of the surface tell nothing that holds.
    fn is_outside(&mut self, point: Vector) -> bool {
        let (mut outside, mut inside) = (0, 0);
        for _ in 0..VOTES {
            let stream = &mut self.stream;
            let way = Vector::new(stream.normal(), stream.normal(), stream.normal());
            let Some(along) = way.try_normalize() else { continue };
            let crossings = crossings(&self.triangles, point, along);
            let below = crossings.iter().filter(|(length, _)| *length <= 0.0).count();
            match [below % 2, (crossings.len() - below) % 2] {
                [0, 0] => outside += 1,
                [1, 1] => inside += 1,
                _ => {}
            }
        }
        outside > inside
    }

    /// A piece outside the body as short as small changes of its line make it; `None` in a corner.
    fn narrowed(&mut self, chord: Chord) -> Option<Chord> {
        let (mut best, mut change) = (chord, FIRST);
        let changes = CUTS / (self.triangles.len() * CANDIDATES);
        for _ in 0..changes.clamp(CHANGES.0, CHANGES.1) {
            let stream = &mut self.stream;
            let mut drawn = || Vector::new(stream.normal(), stream.normal(), stream.normal());
            let middle = best.middle + drawn() * (change * best.length);
            let along = (best.along + drawn() * change).try_normalize();
            let found = along.and_then(|along| around(&self.triangles, middle, along));
            let shorter = found.filter(|found| found.is_outside && found.length < best.length);
            change *= if shorter.is_some() { LARGER } else { SMALLER };
            best = shorter.unwrap_or(best);
        }
        (best.length >= CORNER * chord.length).then_some(best)
    }
}

/// The shortest of these, at most `most`, without those around a shorter one.
fn apart(mut chords: Vec<Chord>, most: usize) -> Vec<Chord> {
    chords.sort_by(|one, other| one.length.total_cmp(&other.length));
    let mut kept: Vec<Chord> = Vec::new();
    for chord in chords {
        let is_around = |shorter: &Chord| (shorter.middle - chord.middle).length() < chord.length;
        if kept.len() < most && !kept.iter().any(is_around) {
            kept.push(chord);
        }
    }
    kept
}

/// The crossings of a line with a surface in their order: where, by the length along the line, and the cosine with the normal there.
fn crossings(triangles: &[&Element], point: Vector, along: Vector) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for triangle in triangles {
        let [a, b, c] = triangle.corners;
        let (u, v) = (b - a, c - a);
        let p = along.cross(v);
        let determinant = u.dot(p);
        let t = point - a;
        let q = t.cross(u);
        let [first, second, length] =
            [t.dot(p), along.dot(q), v.dot(q)].map(|value| value / determinant);
        if determinant != 0.0 && first >= 0.0 && second >= 0.0 && first + second <= 1.0 {
            found.push((length, along.dot(triangle.normal).abs() / triangle.normal.length()));
        }
    }
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    // A line through an edge crosses both triangles at it.
    let scale =
        found.last().map_or(0.0, |last| last.0) - found.first().map_or(0.0, |first| first.0);
    found.dedup_by(|next, before| next.0 - before.0 <= 1e-9 * scale);
    found
}

/// The pieces of a line on either side of a point on the surface; none where what the crossings on its two sides tell differs, or where it ends on a surface aslant.
fn beside(triangles: &[&Element], point: Vector, along: Vector) -> [Option<Chord>; 2] {
    let crossings = crossings(triangles, point, along);
    let at = (0..crossings.len())
        .min_by(|one, other| crossings[*one].0.abs().total_cmp(&crossings[*other].0.abs()));
    let Some(at) = at else { return [None; 2] };
    let after = (at + 1 < crossings.len()).then(|| piece(&crossings, at, point, along)).flatten();
    let before = (at > 0).then(|| piece(&crossings, at - 1, point, along)).flatten();
    [before, after]
}

/// The piece of a line around one of its points.
fn around(triangles: &[&Element], point: Vector, along: Vector) -> Option<Chord> {
    let crossings = crossings(triangles, point, along);
    let next = crossings.iter().position(|(length, _)| *length > 0.0).filter(|next| *next > 0)?;
    piece(&crossings, next - 1, point, along)
}

/// The piece from a crossing to the next.
fn piece(crossings: &[(f64, f64)], first: usize, point: Vector, along: Vector) -> Option<Chord> {
    let ((from, one), (to, other)) = (crossings[first], crossings[first + 1]);
    let (below, above) = (first + 1, crossings.len() - first - 1);
    let is_sure = below % 2 == above % 2 && one.min(other) >= FACING && to > from;
    is_sure.then(|| Chord {
        middle: point + along * ((from + to) / 2.0),
        along,
        length: to - from,
        is_outside: below % 2 == 0,
    })
}
