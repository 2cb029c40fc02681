use super::*;
use crate::model::{Model, Scratch};
use crate::problem::Problem;
use crate::seed::{Purpose, Seed, Stream};
use proptest::prelude::*;
use std::path::Path;
use std::time::Duration;

/// A robot before one obstacle in a wide space.
fn model(motion: &str, robot: &str, obstacle: &str) -> Box<dyn Model> {
    let text = format!(
        "[space]\nmotion = \"{motion}\"\nmin = [-9.0, -9.0, -9.0]\nmax = [9.0, 9.0, 9.0]\nbounds = \"reference\"\n\
         [robot]\nbodies = [{{ shape = {{ {robot} }} }}]\n[[obstacles]]\nshape = {{ {obstacle} }}\n"
    );
    let problem = Problem::parse(Path::new("scene.toml"), &text);
    problem.unwrap_or_else(|error| panic!("{error}")).model().description().prepare()
}

const BALL: &str = "sphere = { radius = 0.5 }";
const CUBE: &str = "box = { size = [2.0, 2.0, 2.0] }";
const ROD: &str = "box = { size = [4.0, 0.2, 0.2] }";

/// A rule that has been told what a model says of these configurations.
fn told(model: &dyn Model, rule: Rule, configurations: &[&[f64]]) -> Projection {
    let mut projection = Projection::new(model.space().clone(), rule);
    for q in configurations {
        projection.learn(Exact::at(model, q, &mut Scratch::new()));
    }
    projection
}

#[test]
fn after_a_free_configuration_the_way_to_the_obstacle_is_what_counts() {
    let model = model("translation-3d", BALL, CUBE);
    // The ball's surface is 0.5 above the cube.
    for rule in [Rule::Translation, Rule::NearestPoint] {
        let projection = told(&*model, rule, &[&[0.1, 0.2, 2.0]]);
        let ask = |q: [f64; 3]| projection.ask(&q).expect("three numbers");
        let exact = Answer { collides: false, force: None, basis: Basis::Exact };
        assert_eq!(ask([0.1, 0.2, 2.0]), exact);
        assert_eq!(ask([0.1, 0.2, 1.51]), Answer { basis: Basis::Projected, ..exact.clone() });
        assert_eq!(ask([7.0, -5.0, 2.0]), Answer { basis: Basis::Projected, ..exact });
        let deep = ask([0.4, 0.2, 1.49]);
        assert!(deep.collides && deep.basis == Basis::Projected);
        let force = deep.force.expect("a direction is known");
        assert!((force[2] - 1.0).abs() < 1e-9 && force[..2].iter().all(|x| x.abs() < 1e-9));
    }
}

#[test]
fn after_a_colliding_configuration_the_way_in_from_the_last_free_one_is_what_counts() {
    let model = model("translation-3d", BALL, CUBE);
    let (free, colliding) = ([0.0, 0.0, 2.0], [0.0, 0.6, 1.2]);
    let projection = told(&*model, Rule::Translation, &[&free, &colliding]);
    let ask = |q: [f64; 3]| projection.ask(&q).expect("three numbers");
    let exact = ask(colliding);
    assert!(exact.collides && exact.basis == Basis::Exact);
    // The way in is (0, 0.6, -0.8), of length 1: farther along it, or aside, is colliding, nearer is free.
    assert!(ask([0.0, 0.66, 1.12]).collides && ask([3.0, 0.61, 1.19]).collides);
    assert!(!ask([0.0, 0.54, 1.28]).collides && !ask([0.0, 0.0, 1.3]).collides);
    let force = ask([0.0, 0.66, 1.12]).force.expect("it leads back");
    for (found, expected) in force.iter().zip([0.0, -0.6, 0.8]) {
        assert!((found - expected).abs() < 1e-12, "{force:?}");
    }
    // Nothing free is known: everything may collide, and nothing says where to go.
    let projection = told(&*model, Rule::Translation, &[&colliding]);
    let answer = projection.ask(&[5.0, 5.0, 5.0]).expect("three numbers");
    assert_eq!(answer, Answer { collides: true, force: None, basis: Basis::Projected });
}

#[test]
fn a_turn_counts_by_its_lever_unless_translations_alone_are_projected() {
    let model = model("rigid-3d", ROD, CUBE);
    // The rod's end is 0.1 above the cube; a turn about y by 0.1 brings it 0.15 down.
    let (free, half) = ([2.5, 0.0, 1.2, 1.0, 0.0, 0.0, 0.0], 0.05_f64);
    let turned = [2.5, 0.0, 1.2, (1.0 - half * half).sqrt(), 0.0, -half, 0.0];
    assert!(!model.is_valid(&turned, &mut Scratch::new()), "the rod dips into the cube");
    let ask = |rule| told(&*model, rule, &[&free]).ask(&turned).expect("seven numbers");
    let answer = ask(Rule::NearestPoint);
    assert!(answer.collides, "{answer:?}");
    let force = answer.force.expect("a direction is known");
    // Up, and with a torque that lifts the end.
    assert!((force[2] - 1.0).abs() < 1e-6 && force[4] > 0.4, "{force:?}");
    assert!(!ask(Rule::Translation).collides);
    // Away from the cube it turns freely.
    let [x, y, z, w, a, b, c] = turned;
    let lifted = told(&*model, Rule::NearestPoint, &[&free]).ask(&[x, y, z, w, a, -b, c]);
    assert!(!lifted.expect("seven numbers").collides);
}

#[test]
fn what_is_no_configuration_is_an_error_and_what_was_not_told_is_unknown() {
    let model = model("translation-3d", BALL, CUBE);
    let projection = told(&*model, Rule::Translation, &[]);
    let unknown = Answer { collides: false, force: None, basis: Basis::Unknown };
    assert_eq!(projection.ask(&[0.0; 3]), Ok(unknown));
    assert_eq!(projection.ask(&[0.0; 2]), Err("2 values found, 3 expected".to_owned()));
    assert!(projection.ask(&[0.0, f64::NAN, 0.0]).is_err());
}

proptest! {
    /// For a convex robot that only translates and one convex obstacle: what a free configuration says misses no collision.
    #[test]
    fn no_collision_of_convex_bodies_is_missed_after_a_free_configuration(
        free in prop::array::uniform3(-4.0..4.0_f64),
        q in prop::array::uniform3(-4.0..4.0_f64),
        robot in prop::sample::select(vec![BALL, ROD]),
    ) {
        let model = model("translation-3d", robot, CUBE);
        let scratch = &mut Scratch::new();
        prop_assume!(model.is_valid(&free, scratch));
        for rule in [Rule::Translation, Rule::NearestPoint] {
            let answer = told(&*model, rule, &[&free]).ask(&q).expect("three numbers");
            prop_assert!(answer.collides || model.is_valid(&q, scratch), "{:?}", rule);
        }
    }
}

/// Over drawn configurations of shipped robots of all families: a little motion changes the clearance by its rates. Where another
/// obstacle becomes the nearest it does not, so a few may differ.
#[test]
fn clearances_change_by_their_rates() {
    for name in ["walls", "hook", "maze", "stick4", "gantry"] {
        let problem = Problem::load(Path::new(&format!("problems/{name}.toml")));
        let model =
            problem.unwrap_or_else(|error| panic!("{error}")).model().description().prepare();
        let (space, clearances) = (model.space(), model.clearances().expect("bodies have them"));
        let mut stream: Stream = Seed::of_evaluator(5, name).stream(Purpose::Sampling);
        let (mut q, mut near, scratch) =
            (vec![0.0; space.len()], vec![0.0; space.len()], &mut Scratch::new());
        let (mut looked_at, mut as_told) = (0, 0);
        for _ in 0..200 {
            space.sample_uniform(&mut stream, &mut q);
            let approach = clearances.approach(&q, scratch).expect("there are obstacles");
            assert_eq!(Some(approach.clearance), clearances.clearance(&q, scratch));
            assert_eq!(approach.rates.len(), space.tangent_weights().len());
            if approach.clearance.distance < 1e-3 {
                continue;
            }
            for number in 0..approach.rates.len() {
                let mut by = vec![0.0; approach.rates.len()];
                by[number] = 1e-6;
                space.moved(&q, &by, &mut near);
                let there = clearances.clearance(&near, scratch).expect("there are obstacles");
                let change = (approach.clearance.distance - there.distance) / 1e-6;
                looked_at += 1;
                as_told += usize::from((change - approach.rates[number]).abs() < 1e-2);
            }
        }
        assert!(
            looked_at > 100 && as_told * 100 >= looked_at * 95,
            "{name}: {as_told} of {looked_at}"
        );
    }
}

/// Asks until the answer is exact.
fn wait_for_exact(follower: &mut Follower, q: &[f64]) -> Answer {
    for _ in 0..60_000 {
        let answer = follower.ask(q).expect("a configuration");
        if answer.basis == Basis::Exact {
            return answer;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no exact answer came");
}

#[test]
fn a_follower_comes_to_know_where_it_stands_and_answers_beside_it_by_the_rule() {
    let (free, near, inside) = ([0.0, 0.0, 2.0], [0.0, 0.0, 1.9], [0.0, 0.0, 1.2]);
    let mut follower = Follower::start(model("translation-3d", BALL, CUBE), Rule::default());
    let follower = follower.as_mut().expect("a thread can be started");
    assert_eq!(follower.ask(&free).expect("a configuration").basis, Basis::Unknown);
    assert!(!wait_for_exact(follower, &free).collides && follower.is_running());
    // Whichever answers have come by then, the rule is told the latest of them.
    let answer = follower.ask(&inside).expect("a configuration");
    assert!(answer.collides && answer.basis == Basis::Projected && answer.force.is_some());
    let known = wait_for_exact(follower, &inside);
    assert!(known.collides && known.force.expect("it leads back")[2] > 0.9);
    assert_eq!(follower.last_exact().expect("one has come").q(), inside);
    assert!(!wait_for_exact(follower, &near).collides);
    assert!(follower.ask(&[0.0]).is_err());
}
