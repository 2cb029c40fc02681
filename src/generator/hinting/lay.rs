use super::gaps::Gap;
use super::polyline::{evenly, fitted};
use crate::generator::growth::GrowingSet;
use crate::push::{Push, Run, Search};
use crate::seed::{Purpose, Seed};

/// The part of a set's seed from which pushes draw.
const PUSHES: u64 = 1;
/// With how many hints before it a hint is tried to be joined, nearest along the path first.
const LOOKS_BACK: usize = 3;
/// At least so many hints of a gap are looked at.
const HINTS_MIN: usize = 6;

/// Makes stretches of approximate paths milestones of a set.
pub(in crate::generator) struct Layer<'a> {
    /// The set.
    pub set: GrowingSet<'a>,
    /// How colliding hints are moved.
    pub push: Push,
    /// By how much pushes move at a time.
    pub step: f64,
    /// The farthest that pushes move a hint.
    pub reach: f64,
    /// How often the path was dealt with before.
    pub effort: u32,
}

/// What stands for a hint: a configuration, and the hint's number.
struct Station {
    hint: usize,
    q: Vec<f64>,
    /// Where it is a node already.
    place: Option<u32>,
    is_pushed: bool,
}

impl Layer<'_> {
    /// Lays each of the gaps of a path, beginning with another one in every set, until the set is full.
    pub fn mend(&mut self, hints: &[Vec<f64>], gaps: &[Gap], step: f64, seed: &Seed) {
        let count = gaps.len();
        for turn in 0..count {
            if self.set.is_full() {
                return;
            }
            let index = (turn + self.effort as usize) % count;
            let gap = gaps[index];
            let stretch: Vec<Vec<f64>> = gap.of(hints).collect();
            let most = (self.set.count() / count).max(HINTS_MIN);
            let stretch = fitted(&self.set.cx.space, &stretch, step, most);
            let places = gap.nodes.map(|node| node.map(|node| node.0));
            self.lay(&stretch, places, &seed.part(index as u64));
        }
    }

    /// Makes the valid configurations of a stretch milestones, pushes the others free, and joins what comes of it in the order of the stretch. `ends` are nodes at its first and last
    /// hint, where these are known. Returns the hints where it stays broken.
    pub fn lay(
        &mut self,
        hints: &[Vec<f64>],
        ends: [Option<u32>; 2],
        seed: &Seed,
    ) -> Vec<Vec<f64>> {
        let stations = self.stations(hints, ends, seed);
        let stations = self.as_many_as_fit(stations);
        let mut gaps = Vec::new();
        // Places that stand for hints, hint by hint.
        let mut laid: Vec<(usize, Vec<u32>)> = Vec::new();
        for station in stations {
            let place = match station.place {
                Some(place) => place,
                None => self.set.add(&station.q),
            };
            let is_same = laid.last().is_some_and(|(hint, _)| *hint == station.hint);
            let before = laid.len() - usize::from(is_same);
            let looked_at = laid[..before].iter().rev().take(LOOKS_BACK);
            let mut joins = looked_at.map(|(_, places)| {
                let tried = places.iter().filter(|other| self.set.join(**other, place));
                tried.count() > 0
            });
            let is_joined = joins.any(|joined| joined);
            if let Some((hint, _)) = laid[..before].last().filter(|_| !is_joined) {
                gaps.push((*hint, station.hint));
            }
            match laid.last_mut().filter(|_| is_same) {
                Some((_, places)) => places.push(place),
                None => laid.push((station.hint, vec![place])),
            }
        }
        let ends = [laid.first(), laid.last()].map(|end| end.map(|(hint, _)| *hint));
        if let [Some(first), Some(last)] = ends {
            gaps.extend([(0, first), (last, hints.len() - 1)].into_iter().filter(|(a, b)| a < b));
        } else {
            gaps.push((0, hints.len().saturating_sub(1)));
        }
        let is_broken = |index: usize| gaps.iter().any(|(from, to)| (*from..=*to).contains(&index));
        let numbered = hints.iter().enumerate().filter(|(index, _)| is_broken(*index));
        numbered.map(|(_, q)| q.clone()).collect()
    }

    /// What stands for the hints of a stretch, in their order.
    fn stations(
        &mut self,
        hints: &[Vec<f64>],
        ends: [Option<u32>; 2],
        seed: &Seed,
    ) -> Vec<Station> {
        let last = hints.len().saturating_sub(1);
        let of_hint = |hint: usize| match hint {
            0 if ends[0].is_some() => ends[0],
            hint if hint == last => ends[1],
            _ => None,
        };
        // The configuration that stands for a hint by itself.
        let own: Vec<Option<(Vec<f64>, Option<u32>)>> = (0..hints.len())
            .map(|hint| match of_hint(hint) {
                Some(place) => Some((self.set.config(place).to_vec(), Some(place))),
                None => {
                    let is_valid = self.set.cx.model.is_valid(&hints[hint], self.set.scratch);
                    is_valid.then(|| (hints[hint].clone(), None))
                }
            })
            .collect();
        let mut search = Search {
            cx: self.set.cx,
            scratch: self.set.scratch,
            stream: seed.part(PUSHES).stream(Purpose::Sampling),
            step: self.step,
            reach: self.reach,
            effort: self.effort,
        };
        let mut stations = Vec::new();
        let mut hint = 0;
        while hint < hints.len() {
            if let Some((q, place)) = &own[hint] {
                let (q, place) = (q.clone(), *place);
                stations.push(Station { hint, q, place, is_pushed: false });
                hint += 1;
                continue;
            }
            let end = (hint..hints.len()).find(|next| own[*next].is_some()).unwrap_or(hints.len());
            let config = |at: usize| own.get(at)?.as_ref().map(|(q, _)| &q[..]);
            let before = hint.checked_sub(1).and_then(config);
            let run = Run { before, colliding: &hints[hint..end], after: config(end) };
            for pushed in self.push.push(&run, &mut search) {
                let of = hint + pushed.from;
                stations.push(Station { hint: of, q: pushed.q, place: None, is_pushed: true });
            }
            hint = end;
        }
        stations
    }

    /// As many as the set has room for: of those that are too many, pushed ones are left out first, evenly.
    fn as_many_as_fit(&self, stations: Vec<Station>) -> Vec<Station> {
        let room = self.set.count() - self.set.made.configs.len();
        let is_new = |station: &Station| station.place.is_none();
        let pushed = stations.iter().filter(|station| station.is_pushed).count();
        let free = stations.iter().filter(|station| is_new(station)).count() - pushed;
        let kept = |keep: &dyn Fn(&Station) -> bool, most: usize| -> Vec<usize> {
            let numbered = stations.iter().enumerate().filter(|(_, station)| keep(station));
            evenly(numbered.map(|(index, _)| index).collect(), most)
        };
        let mut places = kept(&|station| !is_new(station), stations.len());
        places.extend(kept(&|station| is_new(station) && !station.is_pushed, room));
        places.extend(kept(&|station| station.is_pushed, room.saturating_sub(free)));
        places.sort_unstable();
        let mut stations: Vec<Option<Station>> = stations.into_iter().map(Some).collect();
        places.into_iter().filter_map(|place| stations[place].take()).collect()
    }
}
