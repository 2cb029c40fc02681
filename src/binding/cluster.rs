//! Greedy clusters of poses around those of lowest energy, as docking programs report them.
//!
//! G. M. Morris et al., *Automated docking using a Lamarckian genetic algorithm and an empirical binding free energy
//! function*, J. Comput. Chem. 19 (1998) 1639: poses in the order of their energies, each compared with the leaders so far.

use std::cmp::Ordering;

/// The radius of a cluster, in Å of symmetry-corrected RMSD, at which docking calls two poses the same.
pub const RADIUS: f64 = 2.0;

/// Poses near one of lower energy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cluster {
    /// The pose with the lowest energy, by its number.
    pub leader: usize,
    /// All poses of the cluster by their numbers, in rising energy; the leader is the first.
    pub members: Vec<usize>,
}

/// The clusters of the poses with these energies, in the order of their leaders' energies.
///
/// Poses are taken in rising energy, of equal energies the lower number first, and those whose energy is not a number
/// last. A pose joins the first cluster whose leader is at most `radius` away, and begins one of its own if there is none.
/// `distance` is given the numbers of the leader and of the pose; a distance that is not a number joins nothing.
pub fn clusters(
    energies: &[f64],
    radius: f64,
    mut distance: impl FnMut(usize, usize) -> f64,
) -> Vec<Cluster> {
    let mut order: Vec<usize> = (0..energies.len()).collect();
    // The sort is stable: equal energies stay in the order of their numbers.
    order.sort_by(|a, b| rising(energies[*a], energies[*b]));
    let mut found: Vec<Cluster> = Vec::new();
    for pose in order {
        match found.iter_mut().find(|cluster| distance(cluster.leader, pose) <= radius) {
            Some(cluster) => cluster.members.push(pose),
            None => found.push(Cluster { leader: pose, members: vec![pose] }),
        }
    }
    found
}

/// The order of two energies, those that are not numbers behind all others.
fn rising(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or_else(|| a.is_nan().cmp(&b.is_nan()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_a_line(places: &[f64], energies: &[f64], radius: f64) -> Vec<(usize, Vec<usize>)> {
        let distance = |a: usize, b: usize| (places[a] - places[b]).abs();
        let found = clusters(energies, radius, distance);
        found.into_iter().map(|cluster| (cluster.leader, cluster.members)).collect()
    }

    #[test]
    fn a_pose_joins_the_first_leader_that_is_near() {
        // The pose at 2 is near both leaders, at 0 and at 3.5, and goes to that of lower energy, though the other is nearer.
        let places = [2.0, 3.5, 0.0, 9.0, 1.9];
        let energies = [-3.0, -8.0, -9.0, -1.0, -2.0];
        let found = on_a_line(&places, &energies, 2.0);
        assert_eq!(found, [(2, vec![2, 0, 4]), (1, vec![1]), (3, vec![3])]);
        // Clusters are about leaders: members do not take in others.
        assert_eq!(
            on_a_line(&[0.0, 2.0, 4.0], &[0.0, 1.0, 2.0], 2.0),
            [(0, vec![0, 1]), (2, vec![2])]
        );
        assert_eq!(on_a_line(&[], &[], 2.0), []);
    }

    #[test]
    fn ties_go_by_number_and_what_is_no_number_comes_last() {
        let energies = [f64::NAN, 0.0, -f64::NAN, -0.0, f64::INFINITY, f64::NEG_INFINITY];
        let apart = on_a_line(&[0.0, 10.0, 20.0, 30.0, 40.0, 50.0], &energies, 2.0);
        let leaders: Vec<usize> = apart.into_iter().map(|(leader, _)| leader).collect();
        assert_eq!(leaders, [5, 1, 3, 4, 0, 2]);
        // A distance that is not a number is not within any radius.
        assert_eq!(on_a_line(&[0.0, f64::NAN], &[0.0, 0.0], 2.0).len(), 2);
        assert_eq!(clusters(&[0.0; 3], f64::NAN, |_, _| 0.0).len(), 3);
    }
}
