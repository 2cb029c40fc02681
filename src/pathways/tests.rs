use super::k_best::Parts;
use super::*;
use crate::cancel::Cancel;
use crate::context::Ends;
use crate::img::{Grown, Setup, build};
use crate::model::Directed;
use crate::numbers::NodeId;
use crate::problem::Problem;
use crate::query::{Attachment, Ways, shorten};
use crate::roadmap::{Configs, Edge, EdgeCost, Increment, Roadmap};
use proptest::prelude::*;
use std::sync::{Arc, LazyLock};

/// A round hill in the middle of a plane, and two points on either side of it.
const HILL: &str = "[landscape]\nmin = [-2, -2]\nmax = [2, 2]\ntolerance = 0.01\n\
    energy = { terms = [{ height = 50, centre = [0, 0], xx = -2, yy = -2 }] }\n\
    [query]\nstart = [-1.5, 0.1]\ngoal = [1.6, 0]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 120\nsampler = { uniform = {} }\n\
    [limits]\nsets = 1\n";

/// A wall in the middle of a room, around both of whose ends there is room enough.
const WALL: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [10, 10]\n\
    bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
    [[obstacles]]\nshape = { box = { size = [0.5, 6, 1] } }\nposition = [5, 5, 0]\n\
    [query]\nstart = [1, 5]\ngoal = [9, 5]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 150\nsampler = { uniform = {} }\n\
    [limits]\nsets = 1\n";

struct Built {
    setup: Arc<Setup>,
    roadmap: Roadmap,
}

impl Built {
    fn of(text: &str) -> Built {
        let problem = Problem::parse(std::path::Path::new("problem.toml"), text);
        let setup = Arc::new(Setup::new(problem.unwrap_or_else(|error| panic!("{error}"))));
        let Grown { roadmap, .. } = build(&setup);
        Built { setup, roadmap }
    }

    fn ends(&self) -> &Ends {
        self.setup.cx.query().expect("the problem has a query")
    }

    fn dissimilar(&self, asked: &Dissimilar) -> Pathways {
        let (cx, scratch) = (&self.setup.cx, &mut Scratch::new());
        dissimilar(
            cx,
            &self.roadmap,
            self.ends(),
            &Attachment::default(),
            asked,
            &Cancel::new(),
            scratch,
        )
        .expect("few frames")
    }

    fn k_best(&self, count: usize, rank: Rank) -> Pathways {
        let (cx, scratch) = (&self.setup.cx, &mut Scratch::new());
        let asked = KBest { count, rank, spacing: 0.1 };
        let how = Attachment::default();
        let cancel = Cancel::new();
        k_best(cx, &self.roadmap, self.ends(), &how, &asked, &cancel, scratch).expect("few frames")
    }
}

const APART: Dissimilar = Dissimilar {
    count: 2,
    rank: Rank::Barrier,
    distance: 1.0,
    spacing: 0.1,
    tries: 20,
    shortcuts: 40,
};

/// The second coordinate where the path passes the middle between its ends.
fn passes_at(pathway: &Pathway, middle: f64) -> f64 {
    let frames = pathway.frames.configs.iter();
    let nearest = frames.min_by(|a, b| (a[0] - middle).abs().total_cmp(&(b[0] - middle).abs()));
    nearest.expect("there are frames")[1]
}

#[test]
fn both_ways_around_a_hill_are_found_and_none_over_it() {
    let built = Built::of(HILL);
    let found = built.dissimilar(&APART);
    let [a, b] = &found.pathways[..] else { panic!("{} found", found.pathways.len()) };
    let sides = [a, b].map(|pathway| passes_at(pathway, 0.0));
    assert!(sides[0] * sides[1] < 0.0 && sides.iter().all(|y| y.abs() > 1.0), "{sides:?}");
    assert!(a.measured.peak <= b.measured.peak && b.measured.peak < Some(10.0));
    for pathway in [a, b] {
        let Measured { peak, there, back } = pathway.measured;
        let cx = &built.setup.cx;
        let energy = |q: &[f64]| cx.model.energy(q, &mut Scratch::new()).expect("it has one");
        let ends = built.ends();
        assert_eq!(there.barrier, peak.map(|peak| peak - energy(&ends.start)));
        assert_eq!(back.barrier, peak.map(|peak| peak - energy(&ends.goal)));
        // Up and down again: what is climbed more on one way is the difference of the ends.
        let rise = energy(&ends.goal) - energy(&ends.start);
        assert!((there.cost - back.cost - rise).abs() < 1.0, "{there:?} {back:?} {rise}");
        assert_eq!(there.cost, pathway.path.length);
    }
    assert_eq!(found.pairs.len(), 1);
    assert!(found.pairs[0].frechet.value >= 1.0, "{:?}", found.pairs);
    assert!(found.pairs[0].hausdorff.value <= found.pairs[0].frechet.value);
    // The same again, and by another rank the same two.
    let again = built.dissimilar(&APART);
    assert_eq!(again.pairs, found.pairs);
    let by_cost = built.dissimilar(&Dissimilar { rank: Rank::Cost, ..APART });
    assert_eq!(by_cost.pathways.len(), 2);
    assert!(by_cost.pathways[0].measured.there.cost <= by_cost.pathways[1].measured.there.cost);
    // There are not three: what is asked for in vain ends.
    let all = built.dissimilar(&Dissimilar { count: 3, distance: 2.0, tries: 10, ..APART });
    assert!(all.pathways.len() < 3 && all.tried > 10, "{} tried", all.tried);
}

#[test]
fn bodies_have_dissimilar_paths_by_the_metric() {
    let built = Built::of(WALL);
    let asked = Dissimilar { rank: Rank::Cost, distance: 2.0, spacing: 0.25, ..APART };
    let found = built.dissimilar(&asked);
    let [a, b] = &found.pathways[..] else { panic!("{} found", found.pathways.len()) };
    let sides = [a, b].map(|pathway| passes_at(pathway, 5.0) - 5.0);
    assert!(sides[0] * sides[1] < 0.0, "{sides:?}");
    // Around a corner of the wall: 2 √(4² + 3²) and a little.
    for pathway in [a, b] {
        let Measured { peak, there, back } = pathway.measured;
        assert_eq!((peak, there), (None, back));
        assert!((10.0..11.0).contains(&there.cost), "{}", there.cost);
        assert!((pathway.frames.length() - there.cost).abs() < 1e-9);
    }
    assert!(Built::of(&WALL.replace("6, 1", "10, 1")).dissimilar(&asked).pathways.is_empty());
}

#[test]
fn the_best_are_in_order_all_different_and_begin_with_the_answer() {
    let built = Built::of(HILL);
    let (cx, scratch) = (&built.setup.cx, &mut Scratch::new());
    let ends = built.ends();
    for rank in [Rank::Cost, Rank::Barrier] {
        let found = built.k_best(12, rank);
        assert_eq!(found.pathways.len(), 12);
        let keys: Vec<_> = found.pathways.iter().map(|one| one.measured.key(rank)).collect();
        assert!(keys.is_sorted());
        for (index, one) in found.pathways.iter().enumerate() {
            let others = &found.pathways[..index];
            assert!(others.iter().all(|other| other.path.configs != one.path.configs));
        }
    }
    let ends = (&ends.start[..], &ends.goal[..]);
    let how = Attachment::default();
    let (barrier, answer) = crate::query::lowest_barrier(cx, &built.roadmap, ends, &how, scratch);
    let best = &built.k_best(5, Rank::Barrier).pathways[0];
    assert!(best.measured.peak.is_some_and(|peak| peak <= barrier));
    assert_eq!(answer.path.map(|path| path.configs), Some(best.path.configs.clone()));
}

#[test]
fn shortening_raises_neither_cost_nor_barrier_in_either_direction() {
    let built = Built::of(HILL);
    let (cx, scratch) = (&built.setup.cx, &mut Scratch::new());
    let mut lower = 0;
    for pathway in built.k_best(15, Rank::Cost).pathways {
        for tries in [0, 5, 60] {
            let short = shorten(cx, &pathway.path, tries, scratch);
            let short = Measured::of(cx, &short, scratch).expect("its motions are valid");
            let Measured { peak, there, back } = pathway.measured;
            assert!(short.peak <= peak && short.there.cost <= there.cost);
            assert!(short.back.cost <= back.cost + 1e-9, "{short:?} {back:?}");
            lower += usize::from(short.there.cost < there.cost);
        }
    }
    assert!(lower > 30, "{lower}");
}

#[test]
fn frames_are_about_evenly_apart_and_hold_the_paths_own() {
    let problem = Problem::load("problems/peptide.toml".as_ref()).expect("it ships");
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let ends = cx.query().expect("it has a query");
    let mut path = Path { configs: Configs::new(cx.space.len()), length: 0.0 };
    let mut middle = vec![0.0; cx.space.len()];
    cx.space.interpolate(&ends.start, &ends.goal, 0.3, &mut middle);
    [&ends.start, &middle, &ends.goal].iter().for_each(|q| path.configs.push(q));
    for spacing in [2.0, 0.5, 0.05] {
        let frames = Frames::of(&cx, &path, spacing, scratch).expect("they are few");
        let own: Vec<&[f64]> = frames.own.iter().map(|index| frames.configs.get(*index)).collect();
        assert_eq!(own, path.configs.iter().collect::<Vec<_>>());
        let last = frames.len() - 1;
        assert_eq!((frames.own[0], frames.own[2]), (0, last));
        let steps: Vec<f64> =
            (1..=last).map(|index| frames.distance(index - 1, &frames, index, &cx.space)).collect();
        assert!(steps.iter().all(|step| *step <= spacing), "{spacing}: {steps:?}");
        // Not many more than that takes.
        let needed = frames.length() / spacing;
        assert!((frames.len() as f64) < 1.35 * needed + 4.0, "{} {needed}", frames.len());
        assert_eq!(frames.lengths[last], steps.iter().sum::<f64>());
        assert_eq!(frames.frechet(&frames, &cx.space).value, 0.0);
    }
    // A path that is a point has one frame.
    let mut point = Path { configs: Configs::new(cx.space.len()), length: 0.0 };
    point.configs.push(&ends.start);
    let point = Frames::of(&cx, &point, 0.5, scratch).expect("it is one");
    assert_eq!((point.len(), point.length()), (1, 0.0));
}

#[test]
fn a_search_that_is_cancelled_gives_what_it_has() {
    let built = Built::of(HILL);
    let (cx, how) = (&built.setup.cx, Attachment::default());
    // Shortened so often that nobody waits for the end.
    let asked = Dissimilar { shortcuts: u32::MAX, ..APART };
    let search = |cancel: &Cancel| {
        let scratch = &mut Scratch::new();
        dissimilar(cx, &built.roadmap, built.ends(), &how, &asked, cancel, scratch)
            .expect("few frames")
    };
    let cancel = Cancel::new();
    let found = std::thread::scope(|scope| {
        let search = scope.spawn(|| search(&cancel));
        std::thread::sleep(std::time::Duration::from_millis(300));
        cancel.cancel();
        search.join().expect("no panic")
    });
    assert!(found.is_cut && found.connected && found.pathways.len() <= 2);
    for pathway in &found.pathways {
        let again = Measured::of(cx, &pathway.path, &mut Scratch::new());
        assert_eq!(again, Some(pathway.measured));
    }
    // One that is cancelled before it begins has nothing, but says whether there is a way.
    let found = search(&cancel);
    assert!(found.is_cut && found.connected && found.pathways.is_empty());
    assert!(!built.dissimilar(&APART).is_cut);
}

#[test]
fn spacings_of_too_many_frames_are_refused() {
    let built = Built::of(HILL);
    let (cx, how, scratch) = (&built.setup.cx, Attachment::default(), &mut Scratch::new());
    // The ends are 3.1 apart: at 3e-4 the straight line alone has too many, at 3.5e-4 ways around are too long.
    for spacing in [1e-9, 3e-4, 3.5e-4] {
        let asked = Dissimilar { spacing, tries: 2, shortcuts: 0, ..APART };
        let search =
            dissimilar(cx, &built.roadmap, built.ends(), &how, &asked, &Cancel::new(), scratch);
        let expected = TooFine { spacing, most: 10_000 };
        assert_eq!(search.err(), Some(expected));
        let asked = KBest { count: 1, rank: Rank::Barrier, spacing };
        let search =
            k_best(cx, &built.roadmap, built.ends(), &how, &asked, &Cancel::new(), scratch);
        assert_eq!(search.err(), Some(expected));
    }
    let problem = Problem::load("problems/peptide.toml".as_ref()).expect("it ships");
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let ends = cx.query().expect("it has a query");
    let mut path = Path { configs: Configs::new(cx.space.len()), length: 0.0 };
    [&ends.start, &ends.goal].iter().for_each(|q| path.configs.push(q));
    let length = Frames::of(&cx, &path, 0.1, scratch).expect("they are few").length();
    let [fine, coarse] =
        [1100.0, 500.0].map(|count| Frames::of(&cx, &path, length / count, scratch));
    assert_eq!(fine.err().map(|error| error.most), Some(1000));
    assert!(coarse.is_ok_and(|frames| (450..=1000).contains(&frames.len())));
}

#[test]
fn names_with_commas_and_quotes_stay_one_field_of_a_table() {
    let contact = |first: &str| FormedContact {
        first: first.to_owned(),
        second: "ALA 7".to_owned(),
        share: 0.5,
    };
    let contacts = vec![contact("A,B 3"), contact("A\"B 4"), contact("GLY 1")];
    let table = FrameTable { columns: vec!["a,b [deg]".to_owned()], rows: Vec::new(), contacts };
    let expected =
        "first,second,share\n\"A,B 3\",ALA 7,0.5\n\"A\"\"B 4\",ALA 7,0.5\nGLY 1,ALA 7,0.5\n";
    assert_eq!(table.contacts_csv(), expected);
    assert_eq!(table.csv(), "\"a,b [deg]\"\n");
}

const NODES: u32 = 5;

static FLAT: LazyLock<Built> = LazyLock::new(|| Built::of(HILL));

/// All routes without loops from the start to the goal, as their nodes, with what each comes to.
fn all_routes(edges: &[Edge], from: u32, to: u32) -> Vec<(Vec<u32>, f64, f64)> {
    let (mut open, mut done) = (vec![(vec![from], f64::NEG_INFINITY, 0.0)], Vec::new());
    while let Some((nodes, peak, cost)) = open.pop() {
        let last = nodes[nodes.len() - 1];
        if last == to {
            done.push((nodes, peak, cost));
            continue;
        }
        for Edge { low, high, cost: own, .. } in edges {
            for (a, b, weight) in [(low, high, own.forward()), (high, low, own.backward())] {
                if a.0 == last && !nodes.contains(&b.0) {
                    let nodes = nodes.iter().copied().chain([b.0]).collect();
                    let own = own.directed().expect("it is directed").peak;
                    open.push((nodes, peak.max(own), cost + weight));
                }
            }
        }
    }
    done
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Nothing is forbidden in the landscape, so that every edge passes the finer check.
    #[test]
    fn routes_come_in_the_order_of_their_values_and_all_of_them(
        drawn in prop::collection::btree_map((0..NODES + 2, 0..NODES + 2), (0u8..9, 0u8..9, 0u8..5), 0..14),
    ) {
        let cx = &FLAT.setup.cx;
        let mut configs = Configs::new(2);
        (0..NODES).for_each(|node| configs.push(&[f64::from(node) * 0.1, 0.5]));
        let mut roadmap = Roadmap::new(&cx.space);
        let nodes = Increment { configs, ..Increment::empty(2) };
        roadmap.fold_round(&cx.space, [(&nodes, &[][..])]);
        let edges: Vec<Edge> = drawn.iter().filter(|((a, b), _)| a < b).map(|((a, b), numbers)| {
            let (forward, backward, peak) = numbers;
            let [forward, backward, peak] = [forward, backward, peak].map(|number| f64::from(*number));
            let cost = EdgeCost::Directed(Directed { forward, backward, peak });
            Edge { low: NodeId(*a), high: NodeId(*b), planner: 0, cost }
        }).collect();
        for rank in [Rank::Cost, Rank::Barrier] {
            let ends = [&[-1.0, 0.5][..], &[1.0, 0.5]];
            let mut ways = Ways::of(cx, &roadmap, ends, edges.iter().copied(), [Vec::new(), Vec::new()], None);
            let mut parts = Parts::of(&ways, rank, &Cancel::new());
            let (mut found, scratch) = (Vec::new(), &mut Scratch::new());
            while let Some(route) = parts.next(&mut ways, scratch) {
                found.push(route.nodes.iter().map(|node| node.0).collect::<Vec<_>>());
            }
            let mut expected = all_routes(&edges, NODES, NODES + 1);
            expected.sort_by(|a, b| {
                let by_peak = if rank == Rank::Barrier { a.1.total_cmp(&b.1) } else { a.1.total_cmp(&a.1) };
                by_peak.then(a.2.total_cmp(&b.2)).then(a.0.cmp(&b.0))
            });
            let value = |nodes: &Vec<u32>| {
                let (_, peak, cost) = expected.iter().find(|one| one.0 == *nodes).expect("it is one");
                if rank == Rank::Barrier { (*peak, *cost) } else { (0.0, *cost) }
            };
            let values: Vec<_> = found.iter().map(value).collect();
            prop_assert!(values.is_sorted(), "{:?}", values);
            let mut sorted = found.clone();
            sorted.sort();
            sorted.dedup();
            let mut all: Vec<_> = expected.iter().map(|one| one.0.clone()).collect();
            all.sort();
            prop_assert_eq!((sorted, found.len()), (all.clone(), all.len()));
        }
    }
}
