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
const GOLDEN: [(&str, &str); 12] = [
    ("adaptive", "bdc3f3d39470e06d7044cd31f2e028c8270dfd849188e2ad160c4e167864ed57"),
    ("settled", "e237813a24ad6d78c4dcb301cff52da2071c63d2af6896d9d6e0d33f7ddd62fd"),
    ("judged", "fc618620ce842cfd14f9926dee68f3c1843f38ad90540cf4700bf7e3fd771de7"),
    ("arm", "7fcda57408ddceb9c5244707aa39ae6532cb29349ccaae3cdc668ea76019348b"),
    ("ball", "fdcba62150da799a2386ae77855f8dcb2667de5bfd79aeb81a75f8e26180836e"),
    ("planar", "e99f59b51e5663e7f3c2be21d92cf23056d5efd9715aebfdf5486ef168b2f4d9"),
    ("meshes", "4f45115a3f95d0d341669f610369659336aad26cbd1858cb67e790d3f10efdeb"),
    ("slide", "59298bc3e1054a2863cab638c9f60e2d99d1f6d4daddba67d1d059339a8e7e21"),
    ("sampled", "f331e07eb14dc32f4cb2fc56405afdbeee8b188f62fdb5bdb738f2af9be399cb"),
    ("axis", "ab7ef1b5f01f4e947daedc713c2dd6bfbd6365f059433d7f78506e2358004d8a"),
    ("landscape", "3703d6db792be2946d68a7fe050c7d9ef9fbb69270eaa4522b78e6ff18c41347"),
    ("expansion", "27ce4153d744ee4d71ef4b149b30ab0fa7685de0451d917f6b82ad471dd72887"),
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

/// Where motions are looked at step by step, one of these problems has another roadmap, for a motion
/// that slips by between two steps.
#[test]
fn sampled_edges_have_golden_digests_too() {
    for (name, digest) in GOLDEN {
        let expected = match name {
            "judged" => "f3804ce9aa28c8aa346f10dbdfacc118baf774d06c8f93eae1eeb7c8633439ea",
            _ => digest,
        };
        let swept = problem(name);
        // A landscape has no edges to be looked at in steps.
        if swept.model().bodies().is_none() {
            continue;
        }
        let sampled = with_edges(&swept, MotionChecking::Sampled);
        let found = build(&Arc::new(Setup::new(sampled))).roadmap.digest().to_string();
        assert_eq!(found, expected, "{name}");
    }
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
