use super::pathways::ToNative;
use super::*;
use crate::cancel::Cancel;
use crate::model::Directed;
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost};

/// A native structure with two elements of two contacts each, and a pairing of one.
fn native() -> Native {
    let part = |name: &str, is_pairing, contacts: &[u32]| Part {
        name: name.to_owned(),
        is_pairing,
        contacts: contacts.to_vec(),
    };
    Native {
        q: Vec::new(),
        contacts: vec![(0, 4), (1, 5), (8, 12), (9, 13), (0, 13)],
        parts: vec![
            part("α1", false, &[0, 1]),
            part("α2", false, &[2, 3]),
            part("α1–α2", true, &[4]),
        ],
    }
}

/// Edges whose way from `from` to `to` costs `cost`, and whose way back costs 100 more.
fn edge(from: u32, to: u32, cost: f64) -> Edge {
    let (low, high) = (from.min(to), from.max(to));
    let back = cost + 100.0;
    let (forward, backward) = if from == low { (cost, back) } else { (back, cost) };
    let cost = EdgeCost::Directed(Directed { forward, backward, peak: 0.0 });
    Edge { low: NodeId(low), high: NodeId(high), planner: 0, cost }
}

/// The formation along the pathways of a tree whose edges have no frames between their nodes. `nodes` says which contacts are there, node
/// by node, as digits.
fn along(tree: &ToNative, nodes: &[&str], settings: &Settings) -> Formation {
    let digits = |node: &str| node.chars().map(|digit| digit == '1').collect::<Vec<_>>();
    let kept: Vec<Vec<bool>> = nodes.iter().map(|node| digits(node)).collect();
    let count = |node: &NodeId| kept[node.index()].iter().filter(|kept| **kept).count();
    let starts = (0..nodes.len() as u32).map(NodeId);
    let starts = starts.filter(|node| count(node) <= settings.unstructured as usize);
    let frames = |node: NodeId| vec![kept[node.index()].clone()];
    Formation::along(tree, starts, frames, (&native(), settings), &Cancel::new())
}

#[test]
fn a_part_is_formed_from_where_on_it_stays() {
    // Node 0 has nothing; at 1 the first helix is there, broken again at 2; at 3 both are there, at 4 all but a contact of α1.
    let edges =
        vec![edge(0, 1, 1.0), edge(1, 2, 1.0), edge(2, 3, 1.0), edge(3, 4, 1.0), edge(4, 5, 1.0)];
    let tree = ToNative::by(edges, NodeId(5));
    let nodes = ["00000", "11000", "10110", "11110", "01111"];
    let half = Settings { formed: 0.5, unstructured: 0 };
    let formation = along(&tree, &nodes, &half);
    assert_eq!(formation.pathways, 1);
    // With half of its contacts α1 is there from node 1 on, α2 from node 2, the pairing from node 4.
    assert_eq!(formation.elements, [Order { groups: vec![vec![0], vec![1]], pathways: 1 }]);
    assert_eq!(formation.at, [0.4, 0.6, 0.8]);
    // The first contact is broken at node 4, so it stays from the native conformation on only; the second, from node 3.
    assert_eq!(formation.contacts, [1.0, 0.8, 0.6, 0.6, 0.8]);
    assert_eq!(formation.by_fifths[2], [0.0, 0.0, 1.0, 1.0, 1.0]);
    assert_eq!(formation.by_fifths[0], [0.0, 0.0, 0.0, 0.0, 1.0]);
    // With all of its contacts α1 is there at the end only, after α2 and the pairing.
    let whole = along(&tree, &nodes, &Settings { formed: 1.0, unstructured: 0 });
    assert_eq!(whole.elements[0].groups, [[1], [0]]);
    let precedence = &whole.precedence;
    assert_eq!(
        [precedence.share(1, 0), precedence.share(0, 1), precedence.share(1, 2)],
        [1.0, 0.0, 1.0]
    );
    assert_eq!(whole.change(&formation), 1.0);
    assert_eq!(whole.change(&whole), 0.0);
}

#[test]
fn every_unstructured_node_has_a_pathway_and_the_cheapest_route_counts() {
    // Nodes 0 and 1 are unstructured. Node 0 goes by 2, where α1 forms, since the way by 3, where α2 forms, costs more; node 1 by 3.
    // Node 4 is joined to nothing.
    let edges =
        vec![edge(0, 2, 1.0), edge(0, 3, 3.0), edge(1, 3, 1.0), edge(2, 5, 1.0), edge(3, 5, 1.0)];
    let tree = ToNative::by(edges, NodeId(5));
    let nodes = ["00000", "00000", "11000", "00110", "00000"];
    let formation = along(&tree, &nodes, &Settings::default());
    assert_eq!(formation.pathways, 2);
    let orders: Vec<_> = formation.elements.iter().map(|order| order.groups.clone()).collect();
    assert_eq!(orders, [vec![vec![0], vec![1]], vec![vec![1], vec![0]]]);
    assert_eq!(formation.precedence.share(0, 1), 0.5);
    assert_eq!(formation.dominant(), 0.5);
    // With two contacts allowed nodes 2 and 3 begin pathways, too.
    let loose = Settings { unstructured: 2, ..Settings::default() };
    assert_eq!(along(&tree, &nodes, &loose).pathways, 4);
}

#[test]
fn parts_that_form_at_the_same_frame_have_no_order() {
    let tree = ToNative::by(vec![edge(0, 1, 1.0), edge(1, 2, 1.0)], NodeId(2));
    let formation = along(&tree, &["00000", "11110"], &Settings::default());
    assert_eq!(formation.elements, [Order { groups: vec![vec![0, 1]], pathways: 1 }]);
    assert_eq!([formation.precedence.share(0, 1), formation.precedence.share(1, 0)], [0.0, 0.0]);
}

#[test]
fn without_pathways_there_is_no_order() {
    let tree = ToNative::by(Vec::new(), NodeId(1));
    let formation = along(&tree, &["00000"], &Settings::default());
    assert_eq!((formation.pathways, formation.elements.len(), formation.dominant()), (0, 0, 0.0));
    assert!(formation.at.iter().all(|at| at.is_nan()));
}

#[test]
fn what_forms_between_two_milestones_has_an_order_too() {
    // One motion from an unstructured conformation to the native one: on its way α2 forms before α1.
    let tree = ToNative::by(vec![edge(0, 1, 1.0)], NodeId(1));
    let frames = ["00111", "00110", "00000"].map(|frame| frame.chars().map(|c| c == '1').collect());
    let (starts, settings) = ([NodeId(0)].into_iter(), Settings::default());
    let formation = Formation::along(
        &tree,
        starts,
        |_| frames.to_vec(),
        (&native(), &settings),
        &Cancel::new(),
    );
    assert_eq!(formation.elements[0].groups, [[1], [0]]);
    assert_eq!(formation.pairings[0].groups, [[2]]);
    assert_eq!(formation.at, [1.0, 0.4, 0.6]);
}

#[test]
fn once_cancelled_no_pathway_is_followed_any_further() {
    // Three conformations without contacts, each before the next on the way to the native one.
    let tree = ToNative::by(vec![edge(0, 1, 1.0), edge(1, 2, 1.0), edge(2, 3, 1.0)], NodeId(3));
    let (native, settings) = (native(), Settings::default());
    let cancel = Cancel::new();
    let mut asked = Vec::new();
    let frames = |node: NodeId| {
        asked.push(node);
        cancel.cancel();
        vec![vec![false; 5]]
    };
    let starts = (0..3).map(NodeId);
    let formation = Formation::along(&tree, starts, frames, (&native, &settings), &cancel);
    assert_eq!((asked, formation.pathways), (vec![NodeId(2)], 1));
}
