//! Numbers of elements and pairs, and specifications.

use super::super::{CUTOFF_MAX, CUTOFF_MIN, EnergySpec, Own, ParameterSet, VanDerWaals};
use super::element;
use crate::ligand::Element;

#[test]
fn pairs_have_their_least_energy_where_the_rules_say() {
    // The distance squared and the depth. AutoDock: ((4.00 + 3.20) / 2)² and √(0.150 · 0.200); UFF: 3.851 · 3.500 and √(0.105 · 0.060).
    for (set, square, depth) in [
        (ParameterSet::Autodock4, 12.96, 0.173_205_080_756_887_7 * 4.184),
        (ParameterSet::Uff, 13.4785, 0.079_372_539 * 4.184),
    ] {
        let pair = set.pair(Element::CARBON, Element::OXYGEN);
        // The least energy of A/r¹² − B/r⁶ is B²/4A below zero, at (2A/B)^(1/6).
        assert!((pair.b * pair.b / (4.0 * pair.a) - depth).abs() < 1e-7, "{set:?}");
        assert!((2.0 * pair.a / pair.b - square * square * square).abs() < 1e-8, "{set:?}");
        assert_eq!(pair, set.pair(Element::OXYGEN, Element::CARBON));
    }
}

#[test]
fn every_element_has_numbers_and_those_that_autodock_lacks_are_named() {
    let all: Vec<Element> =
        "H He C N O Na Mg P S Cl Ca Mn Fe Co Cu Zn Se Br I Cm".split(' ').map(element).collect();
    for set in [ParameterSet::Autodock4, ParameterSet::Uff] {
        for element in &all {
            let VanDerWaals { distance, depth } = set.van_der_waals(*element);
            assert!((1.0..6.0).contains(&distance) && depth > 0.0 && depth < 5.0);
        }
    }
    let taken = ParameterSet::Autodock4.taken_from_uff(all.iter().copied().chain([element("Cu")]));
    let symbols: Vec<&str> = taken.iter().map(|element| element.symbol()).collect();
    assert_eq!(symbols, ["He", "Na", "Co", "Cu", "Se", "Cm"]);
    assert!(ParameterSet::Uff.taken_from_uff(all).is_empty());
    let selenium = element("Se");
    let [taken, own] =
        [ParameterSet::Autodock4, ParameterSet::Uff].map(|set| set.van_der_waals(selenium));
    assert_eq!(taken, own);
    assert_eq!((own.distance, own.depth), (4.205, 0.291 * 4.184));
}

#[test]
fn bad_numbers_of_a_specification_are_named() {
    assert_eq!(EnergySpec::default().complaint(), None);
    for cutoff in [CUTOFF_MIN, CUTOFF_MAX] {
        assert_eq!(EnergySpec { cutoff, ..EnergySpec::default() }.complaint(), None);
    }
    for cutoff in [f64::NAN, 5.99, 1000.1, -1.0, f64::INFINITY] {
        let (key, message) = EnergySpec { cutoff, ..EnergySpec::default() }.complaint().unwrap();
        assert_eq!(key, "cutoff");
        assert!(message.ends_with("found; a distance of 6 to 1000 Å expected"), "{message}");
    }
    for dielectric in [f64::NAN, 0.5, 0.0, -4.0, 1001.0] {
        let spec = EnergySpec { dielectric: Some(dielectric), ..EnergySpec::default() };
        let (key, message) = spec.complaint().unwrap();
        assert_eq!(key, "dielectric");
        assert!(message.ends_with("found; a factor of 1 to 1000 expected"), "{message}");
    }
    let spec: EnergySpec =
        toml::from_str("parameters = 'uff'\ncutoff = 9\ndielectric = 4\nown = 'none'").unwrap();
    let expected = EnergySpec {
        parameters: ParameterSet::Uff,
        cutoff: 9.0,
        dielectric: Some(4.0),
        hydrophobic: false,
        own: Own::None,
    };
    assert_eq!(spec, expected);
    let error = toml::from_str::<EnergySpec>("cutof = 9").unwrap_err().to_string();
    assert!(error.contains("unknown field `cutof`"), "{error}");
}
