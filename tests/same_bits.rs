//! The same roadmap, bit for bit, whatever does the work.

#[path = "../bench/support/edges.rs"]
mod edges;

use edges::with_edges;
use roadmill::img::{Grown, Memo, Setup, Simulated, Stop, build, build_in_threads, build_with};
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::problem::{Limits, Problem};
use std::path::Path;
use std::sync::Arc;

/// The digests that each problem of `problems/` has always had. Whoever changes one bumps
/// `BITS_VERSION`.
const GOLDEN: [(&str, &str); 21] = [
    ("adaptive", "7b9cc629fc41f79345ed2c2a5b9ea14cde7d5ca9d0a4fa4dc2af4b783ffb542c"),
    ("settled", "e237813a24ad6d78c4dcb301cff52da2071c63d2af6896d9d6e0d33f7ddd62fd"),
    ("judged", "148ea74428efe955e2f3f29c826322052c2015012556b1f3989553efbb0e742a"),
    ("arm", "2efa2e5af0331a8849bebf9ac9e22b2f5669749ebae1905f666310e6a92bd3f8"),
    ("ball", "cd3f3287d1d9e3681c81990f7456991685f900279701b4208ed19e4bd8d72e85"),
    ("planar", "efa4f6d4dbf205a12ac50e660b9c7184a3afc1b7af909dd6826567837e168027"),
    ("meshes", "4f45115a3f95d0d341669f610369659336aad26cbd1858cb67e790d3f10efdeb"),
    ("slide", "67990e13a9722b8dce64cd6325a0956719f3ab58440e2d5017efcd9ff615f8e1"),
    ("sampled", "699ce2b2298e664949250a3e0b6b6bc4e6eb360d80f1245908ccd0a2022fa3ca"),
    ("axis", "9373e425458fd8636d91045c6b1b6ee5a138de3e8c2df540f7ca6271ab5b9729"),
    ("landscape", "9c3bec9789090a1b24857f03b7ca2a072255d02e4b63f0c0a9cecb256c239085"),
    ("peptide", "efaa9aeb80dba46d7252b786e271cabf1b15cc28b8a8f57856e84acbdbeec6cd"),
    ("expansion", "72809594059e57da522cda4e60ca548864319eb7267c1f6a77d7dce7c39722b6"),
    ("growth", "25cb129d26f41ad060ec97348a00723565168b538ea540f6c46e0e08ca1a30f7"),
    ("directions", "c4e945f41b7930a5c2e23e3686a22e746d460589559d61f6a102db3eb81baed8"),
    ("neighbors", "26facc6f51fd778c8a175fbb28807799b419d1aaeec6ee04436882e7d5f51553"),
    ("retraction", "5381a3a0bfcf2a681111b9c6730bb57bd2a6101a51bf00362c1a076d10521b86"),
    ("hints", "3dead538b59b75362a2158c3cdac26db3473559cf88e9f864881ae57d25a7a9d"),
    ("docking", "e345a8d44f5f2de5224cb1f4470312bac4f068edd7bf7108ef97cfd11e75c26b"),
    ("deformable", "1b634bf11cd1cefd2249529da011458c04c4faff0be142586d97a9372f876798"),
    ("penetrating", "bc8a1623b8689a9b9714ca7dc6adccad93b2824d27cf3201e64b161d7f5de4cc"),
];

fn problem(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems");
    let problem = Problem::load(&folder.join(format!("{name}.toml")));
    problem.unwrap_or_else(|error| panic!("{error}"))
}

fn setup(name: &str) -> Arc<Setup> {
    Arc::new(Setup::new(problem(name)))
}

/// Everything that must not differ.
fn result(build: &Grown) -> (String, Stop, String) {
    let verdicts = format!("{:?}", build.judgement);
    (build.roadmap.digest().to_string(), build.stop.clone(), verdicts)
}

#[test]
fn the_digests_are_golden() {
    let found = GOLDEN.map(|(name, _)| (name, build(&setup(name)).roadmap.digest().to_string()));
    let found = found.each_ref().map(|(name, digest)| (*name, digest.as_str()));
    assert_eq!(found, GOLDEN, "bits of a given seed changed: bump BITS_VERSION");
}

/// Where motions are looked at step by step, these problems have another roadmap, for motions that slip by between two
/// steps.
const SAMPLED: [(&str, &str); 3] = [
    ("adaptive", "edb641a35628449ca03ff1220876420e42843852b23e47f63cded7db100775a0"),
    ("neighbors", "e1b770d6c048cb34a6e8dfe3977f1c01770054b85566dcf01039f52b3d3633f1"),
    ("hints", "1d755b61303398b62a6f023029cf055d668704dcbde4e2d63d3070438a17d1a3"),
];

#[test]
fn sampled_edges_have_golden_digests_too() {
    let mut others = Vec::new();
    for (name, digest) in GOLDEN {
        let swept = problem(name);
        // A landscape has no edges to be looked at in steps.
        if swept.model().bodies().is_none() {
            continue;
        }
        let sampled = with_edges(&swept, MotionChecking::Sampled);
        let found = build(&Arc::new(Setup::new(sampled))).roadmap.digest().to_string();
        if found != digest {
            others.push((name, found));
        }
    }
    let others: Vec<_> = others.iter().map(|(name, found)| (*name, found.as_str())).collect();
    assert_eq!(others, SAMPLED);
}

#[test]
fn threads_build_what_one_thread_builds() {
    for (name, _) in GOLDEN {
        let setup = setup(name);
        let expected = result(&build(&setup));
        for threads in [1, 2, 3, 8] {
            assert_eq!(result(&build_in_threads(&setup, threads)), expected, "{name}");
        }
    }
}

/// Thousands of schedules with reordered, late, repeated and lost results and workers that crash.
/// `ROADMILL_SCHEDULES` sets how many per problem, `ROADMILL_SCHEDULE` the one to run again.
#[test]
fn no_schedule_of_mishaps_changes_a_bit() {
    let number = |name| std::env::var(name).ok().map(|text| text.parse::<u64>().expect("a number"));
    let schedules = match number("ROADMILL_SCHEDULE") {
        Some(only) => only..only + 1,
        None => 0..number("ROADMILL_SCHEDULES").unwrap_or(1000),
    };
    for (name, _) in GOLDEN {
        let setup = setup(name);
        let expected = result(&build(&setup));
        let mut memo = Memo::new();
        for seed in schedules.clone() {
            let workers = 1 + seed as usize % 17;
            let lookahead = seed / 17 % 23;
            let simulated = Simulated::new(setup.clone(), workers, seed, &mut memo);
            let found = result(&build_with(&setup, simulated, lookahead));
            assert_eq!(found, expected, "{name}: run again with ROADMILL_SCHEDULE={seed}");
        }
    }
}

/// The jobs themselves, really run anew for each schedule with rubbish in the scratch memory:
/// what allows the simulations above to run each job once only.
#[test]
fn jobs_are_pure() {
    for (name, _) in GOLDEN {
        let setup = setup(name);
        let expected = result(&build(&setup));
        for seed in 1000..1010 {
            let simulated_memo = &mut Memo::new();
            let simulated = Simulated::new(setup.clone(), 5, seed, simulated_memo);
            assert_eq!(result(&build_with(&setup, simulated, 9)), expected, "{name} {seed}");
        }
    }
}

#[test]
fn another_seed_is_another_roadmap() {
    let problem = problem("planar");
    let seed = problem.seed() + 1;
    let other = Arc::new(Setup::new(problem.with_seed(seed)));
    assert_ne!(build(&other).roadmap.digest(), build(&setup("planar")).roadmap.digest());
}

/// The report's claim: a roadmap stays what it is when more sets are added to it.
#[test]
fn a_longer_build_begins_with_the_shorter() {
    let problem = problem("slide");
    let short = build(&Arc::new(Setup::new(problem.clone()))).roadmap;
    let limits = Limits { nodes: 2 * problem.limits().nodes, ..problem.limits() };
    let problem = problem.with_limits(limits).expect("sound limits");
    let long = build(&Arc::new(Setup::new(problem))).roadmap;
    assert!(long.configs().len() > short.configs().len());
    assert!(long.configs().iter().zip(short.configs().iter()).all(|(a, b)| a == b));
    assert!(long.edges().iter().take(short.edges().len()).eq(short.edges().iter()));
}
