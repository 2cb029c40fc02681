//! What is measured: inputs are made once, and every run does the same with them.

use super::support::edges::with_edges;
use super::support::sample;
use roadmill::Context;
use roadmill::connect::{Nearest, Within};
use roadmill::img::{Job, Outcome, Replica, Setup};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::model::protein::energy::{Constraints, Hydrophobic, Mixture, constraints_of};
use roadmill::model::protein::kinematics::Conformer;
use roadmill::model::protein::linkage::Linkage;
use roadmill::model::protein::motion::{Limits, MotionScratch, MotionValidity};
use roadmill::model::protein::validity::{Obstacles, Rules, Screen};
use roadmill::neighbor::{Index, Searched, k_nearest, k_nearest_graph, radius_graph};
use roadmill::numbers::{Ordinal, SetName, SetNumber};
use roadmill::problem::Problem;
use roadmill::query::{Attachment, solve};
use roadmill::roadmap::{Configs, Increment};
use roadmill::sampler::SamplerKind;
use roadmill::seed::Seed;
use roadmill::structure::Residue;
use std::path::Path;
use std::sync::Arc;

/// Does all operations once, and says how many there were.
type Work = Box<dyn FnMut() -> usize>;

/// One kernel.
pub struct Kernel {
    pub name: &'static str,
    /// What is counted as one.
    pub operation: &'static str,
    pub prepare: fn() -> Work,
}

const fn kernel(name: &'static str, operation: &'static str, prepare: fn() -> Work) -> Kernel {
    Kernel { name, operation, prepare }
}

/// All of them.
pub const KERNELS: &[Kernel] = &[
    kernel("state-mesh", "configuration", || states("cage")),
    kernel("state-boxes", "configuration", || states("walls")),
    kernel("state-linkage", "configuration", || states("stick4")),
    kernel("swept-mesh", "motion", || motions("cage", MotionChecking::Swept)),
    kernel("swept-boxes", "motion", || motions("walls", MotionChecking::Swept)),
    kernel("swept-linkage", "motion", || motions("stick4", MotionChecking::Swept)),
    kernel("swept-plane", "motion", || motions("maze", MotionChecking::Swept)),
    kernel("sampled-mesh", "motion", || motions("cage", MotionChecking::Sampled)),
    kernel("protein", "conformation", conformations),
    kernel("protein-motion", "motion", protein_motions),
    kernel("clearance-mesh", "configuration", clearances),
    kernel("sample-uniform", "milestone", || samples("uniform = {}")),
    kernel("sample-gaussian", "milestone", || samples("gaussian = { deviation = 0.5 }")),
    kernel("sample-bridge", "milestone", || samples("bridge = { deviation = 0.5 }")),
    kernel("sample-obprm", "milestone", || samples("obprm = { step = 0.1 }")),
    kernel("sample-uobprm", "milestone", || samples("uobprm = { length = 0.5, step = 0.1 }")),
    kernel("sample-umaprm", "milestone", || {
        some_samples("umaprm = { length = 0.5, step = 0.1, tolerance = 0.01 }", 2)
    }),
    kernel("index-build", "configuration", index_built),
    kernel("index-search", "query", index_searched),
    kernel("brute-search", "query", brute_searched),
    kernel("neighbors-set", "milestone", neighbors_of_a_set),
    kernel("radius-search", "query", radius_searched),
    kernel("radius-set", "milestone", radius_graph_of_a_set),
    kernel("connect", "milestone", connected),
    kernel("join", "milestone", joined),
    kernel("fold", "milestone", folded),
    kernel("query", "query", queried),
    kernel("wire", "milestone", wired),
];

fn problem(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    Problem::load(&folder.join(name).with_extension("toml")).expect("it ships")
}

/// Configurations drawn uniformly, valid or not.
fn uniform(cx: &Context, count: usize) -> Configs {
    let mut stream =
        Seed::of_set(1, "kernels", Ordinal(0)).stream(roadmill::seed::Purpose::Sampling);
    let (mut configs, mut q) = (Configs::new(cx.space().len()), vec![0.0; cx.space().len()]);
    for _ in 0..count {
        cx.space().sample_uniform(&mut stream, &mut q);
        configs.push(&q);
    }
    configs
}

fn states(name: &str) -> Work {
    let cx = problem(name).context();
    let configs = uniform(&cx, 2000);
    let mut scratch = Scratch::new();
    Box::new(move || {
        (0..configs.len()).for_each(|i| {
            std::hint::black_box(cx.model().validity(configs.get(i), &mut scratch));
        });
        configs.len()
    })
}

fn motions(name: &str, edges: MotionChecking) -> Work {
    let cx = with_edges(&problem(name), edges).context();
    let configs = sample(&cx, 300, 0);
    let mut pairs = Vec::new();
    for i in 0..configs.len() {
        let others = (0..configs.len() as u32).filter(|other| *other as usize != i);
        let near = k_nearest(cx.space(), &configs, others, configs.get(i), 5);
        pairs.extend(near.iter().map(|near| (i, near.id as usize)));
    }
    let mut scratch = Scratch::new();
    Box::new(move || {
        for (a, b) in &pairs {
            let (a, b) = (configs.get(*a), configs.get(*b));
            std::hint::black_box(cx.model().motion(a, b, 1, &mut scratch).is_some());
        }
        pairs.len()
    })
}

/// The peptide that ships: its chain, and configurations near that of its first model.
fn peptide() -> (Vec<Residue>, Linkage, Vec<Vec<f64>>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/structures/1UAO.pdb");
    let mut file = roadmill::structure::read(&path).expect("it ships");
    let residues = file.models.swap_remove(0).chains.swap_remove(0).residues;
    let linkage = Linkage::of(&residues).expect("a whole chain");
    let seed = Seed::of_set(1, "kernels", Ordinal(0));
    let mut stream = seed.stream(roadmill::seed::Purpose::Sampling);
    let near = |_| linkage.source().iter().map(|q| q + 0.05 * stream.normal()).collect();
    let configurations = (0..1000).map(near).collect();
    (residues, linkage, configurations)
}

/// Every conformation is placed, held against all rules to their end, and its energy computed.
fn conformations() -> Work {
    let (residues, linkage, configurations) = peptide();
    let conformer = Conformer::of(&residues, &linkage).expect("a whole chain");
    let constraints = Constraints::new(constraints_of(&residues));
    assert!(!constraints.list().is_empty(), "the peptide has hydrogen bonds");
    let energy = Mixture::single(constraints, Some(Hydrophobic::of(conformer.atoms())));
    let (limits, obstacles) = (Rules::default().at_nodes(), Obstacles::default());
    let (mut placed, mut screen) = (conformer.placed(), Screen::default());
    Box::new(move || {
        for q in &configurations {
            conformer.place(q, &mut placed);
            std::hint::black_box(limits.count(&placed, &obstacles, &mut screen));
            std::hint::black_box(energy.energy(&placed));
        }
        configurations.len()
    })
}

/// Motions from each configuration to the next, proved.
fn protein_motions() -> Work {
    let (residues, linkage, configurations) = peptide();
    let limits = Limits::of(&Rules::default(), &residues, &linkage.gaps);
    let motions = MotionValidity::new(&linkage, &residues, &[], limits);
    let motions = motions.expect("a whole chain");
    let mut scratch = MotionScratch::default();
    Box::new(move || {
        for pair in configurations.windows(2) {
            std::hint::black_box(motions.is_valid(&pair[0], &pair[1], &mut scratch));
        }
        configurations.len() - 1
    })
}

fn clearances() -> Work {
    let cx = problem("cage").context();
    let configs = sample(&cx, 200, 0);
    let mut scratch = Scratch::new();
    Box::new(move || {
        (0..configs.len()).for_each(|i| {
            std::hint::black_box(
                cx.model().clearances().expect("bodies").clearance(configs.get(i), &mut scratch),
            );
        });
        configs.len()
    })
}

fn samples(sampler: &str) -> Work {
    some_samples(sampler, 50)
}

/// So many milestones: few of a sampler whose milestones take long.
fn some_samples(sampler: &str, count: usize) -> Work {
    let cx = problem("cage").context();
    let sampler: SamplerKind = toml::from_str(sampler).expect("a sampler");
    let mut scratch = Scratch::new();
    Box::new(move || {
        let mut configs = Configs::new(cx.space().len());
        let seed = Seed::of_set(1, "kernels", Ordinal(0));
        let sampled = sampler.method().sample(&cx, &seed, count, &mut scratch, &mut configs);
        sampled.expect("the cage has room");
        configs.len()
    })
}

/// All configurations are eligible.
struct All(Configs);

impl Searched for All {
    fn config(&self, id: u32) -> &[f64] {
        self.0.get(id as usize)
    }
}

fn index_built() -> Work {
    let cx = problem("walls").context();
    let configs = uniform(&cx, 5000);
    Box::new(move || {
        let mut index = Index::new(cx.space());
        // As sets come in.
        for end in (50..=configs.len() as u32).step_by(50) {
            index.extend(end, |id| configs.get(id as usize), |_| 0);
        }
        index.len() as usize
    })
}

const QUERIES: usize = 200;

fn index_searched() -> Work {
    let cx = problem("walls").context();
    let all = All(uniform(&cx, 10_000));
    let mut index = Index::new(cx.space());
    let end = all.0.len() as u32;
    index.extend(end, |id| all.config(id), |_| 0);
    Box::new(move || {
        for i in 0..QUERIES {
            let found = index.k_nearest(cx.space(), &all, end, all.0.get(i), 10);
            assert_eq!(found.len(), 10);
        }
        QUERIES
    })
}

fn brute_searched() -> Work {
    let cx = problem("walls").context();
    let configs = uniform(&cx, 1000);
    Box::new(move || {
        for i in 0..QUERIES {
            let found = k_nearest(cx.space(), &configs, 0..1000, configs.get(i), 10);
            assert_eq!(found.len(), 10);
        }
        QUERIES
    })
}

fn neighbors_of_a_set() -> Work {
    let cx = problem("walls").context();
    let configs = uniform(&cx, 5000);
    Box::new(move || {
        let pairs = k_nearest_graph(cx.space(), &configs, 10);
        assert!(pairs.len() > 5 * configs.len());
        configs.len()
    })
}

/// A length in which most configurations have others near them; the kernels assert how many on average.
const RADIUS: f64 = 1.0;

fn radius_searched() -> Work {
    let cx = problem("walls").context();
    let all = All(uniform(&cx, 10_000));
    let mut index = Index::new(cx.space());
    let end = all.0.len() as u32;
    index.extend(end, |id| all.config(id), |_| 0);
    Box::new(move || {
        let mut found = 0;
        for i in 0..QUERIES {
            found += index.in_radius(cx.space(), &all, end, all.0.get(i), RADIUS, None).len();
        }
        assert!(found > QUERIES);
        QUERIES
    })
}

fn radius_graph_of_a_set() -> Work {
    let cx = problem("walls").context();
    let configs = uniform(&cx, 5000);
    Box::new(move || {
        let pairs = radius_graph(cx.space(), &configs, RADIUS);
        assert!(pairs.len() > configs.len());
        configs.len()
    })
}

fn connected() -> Work {
    let cx = problem("walls").context();
    let configs = sample(&cx, 500, 0);
    let mut scratch = Scratch::new();
    Box::new(move || {
        let seed = Seed::of_set(1, "kernels", Ordinal(0));
        let edges = Nearest::default().connect(&cx, &seed, &configs, &mut scratch);
        assert!(!edges.is_empty());
        configs.len()
    })
}

/// The walls after some sets, one to a round, and the increment of the next.
fn grown(sets: u64) -> (Setup, Replica, Arc<Increment>) {
    let setup = Setup::new(problem("walls"));
    let (mut replica, mut scratch) = (Replica::new(&setup), Scratch::new());
    for number in SetNumber::each(SetNumber(0)..SetNumber(sets)) {
        let increment = generate(&setup, &replica, number, &mut scratch);
        replica.publish(&setup, increment);
        let edges = join(&setup, &replica, number, &mut scratch);
        replica.fold(&setup, std::iter::once(&edges[..]));
    }
    let next = generate(&setup, &replica, SetNumber(sets), &mut scratch);
    (setup, replica, next)
}

fn generate(
    setup: &Setup,
    replica: &Replica,
    number: SetNumber,
    scratch: &mut Scratch,
) -> Arc<Increment> {
    let name = setup.plan().name_of(number).expect("the schedule does not adapt");
    let SetName { strategy, ordinal } = name;
    let task = replica.task(setup, Job::Generate { number, strategy, ordinal });
    match task.expect("sets can be generated").run(setup, scratch) {
        Outcome::Increment(Ok(increment)) => Arc::new(increment),
        other => panic!("no increment: {other:?}"),
    }
}

fn join(
    setup: &Setup,
    replica: &Replica,
    number: SetNumber,
    scratch: &mut Scratch,
) -> Vec<roadmill::roadmap::Edge> {
    let name = setup.plan().name_of(number).expect("the schedule does not adapt");
    let SetName { strategy, ordinal } = name;
    let task = replica.task(setup, Job::Join { number, strategy, ordinal });
    match task.expect("the set is published").run(setup, scratch) {
        Outcome::Joined(joined) => joined.edges,
        other => panic!("no edges: {other:?}"),
    }
}

const SETS: u64 = 40;

fn joined() -> Work {
    let (setup, mut replica, next) = grown(SETS);
    let nodes = next.configs.len();
    replica.publish(&setup, next);
    let mut scratch = Scratch::new();
    Box::new(move || {
        std::hint::black_box(join(&setup, &replica, SetNumber(SETS), &mut scratch));
        nodes
    })
}

fn folded() -> Work {
    let (setup, mut replica, _) = grown(SETS);
    let increments: Vec<Arc<Increment>> = {
        let (mut scratch, first) = (Scratch::new(), SetNumber(SETS));
        (0..20).map(|i| generate(&setup, &replica, first + i, &mut scratch)).collect()
    };
    let nodes = increments.iter().map(|increment| increment.configs.len()).sum();
    // Every run adds the same sets to a roadmap that grows; the counted run is always the second.
    Box::new(move || {
        for increment in &increments {
            replica.publish(&setup, increment.clone());
            replica.fold(&setup, std::iter::once(&[][..]));
        }
        nodes
    })
}

fn queried() -> Work {
    let (setup, replica, _) = grown(SETS);
    let mut scratch = Scratch::new();
    Box::new(move || {
        let ends = setup.context().query().expect("the walls have a query");
        let ends = (&ends.start[..], &ends.goal[..]);
        let attachment = Attachment::default();
        std::hint::black_box(solve(
            setup.context(),
            replica.roadmap(),
            ends,
            &attachment,
            &mut scratch,
        ));
        1
    })
}

fn wired() -> Work {
    let (_, _, increment) = grown(1);
    Box::new(move || {
        let bytes = wire::encode(&*increment);
        let back: Increment = wire::decode(&bytes).expect("what was encoded");
        assert_eq!(back.configs.len(), increment.configs.len());
        increment.configs.len()
    })
}
