//! The numbers of the 12-6 terms and of the hydrophobic term.

use super::spec::ParameterSet;
use crate::ligand::Element;

/// One kilocalorie in kilojoules: the thermochemical calorie.
pub const KCAL: f64 = 4.184;

/// What an element brings to the 12-6 term of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VanDerWaals {
    /// The distance of two atoms of this element at which their energy is least, in Å.
    pub distance: f64,
    /// How far this least energy is below zero, in kJ/mol.
    pub depth: f64,
}

/// The numbers A and B of a pair's energy A/r¹² − B/r⁶.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairCoefficients {
    /// A in kJ/mol Å¹².
    pub a: f64,
    /// B in kJ/mol Å⁶.
    pub b: f64,
}

/// AutoDock 4.1's elements: Rii in Å and epsii in kcal/mol.
///
/// AD4.1_bound.dat, revision 1.5.2.1, of AutoDock 4 (R. Huey, G. M. Morris, A. J. Olson, D. S. Goodsell, "A semiempirical
/// free energy force field with charge-based desolvation", J. Comput. Chem. 28 (2007) 1145-1152). All of its types of an
/// element (C and A, N, NA and NS, …) have the same two numbers, so the element is enough. AutoDock multiplies the sum
/// of these terms by 0.1662, which is left out here, and it has 12-10 terms in place of these for pairs that can form
/// hydrogen bonds, which need hydrogens and are left out, too.
const AUTODOCK_ELEMENTS: [(&str, f64, f64); 15] = [
    ("H", 2.00, 0.020),
    ("C", 4.00, 0.150),
    ("N", 3.50, 0.160),
    ("O", 3.20, 0.200),
    ("F", 3.09, 0.080),
    ("Mg", 1.30, 0.875),
    ("P", 4.20, 0.200),
    ("S", 4.00, 0.200),
    ("Cl", 4.09, 0.276),
    ("Ca", 1.98, 0.550),
    ("Mn", 1.30, 0.875),
    ("Fe", 1.30, 0.010),
    ("Zn", 1.48, 0.550),
    ("Br", 4.33, 0.389),
    ("I", 4.72, 0.550),
];

/// UFF's x1 in Å and D1 in kcal/mol, by atomic number from 1 on.
///
/// A. K. Rappé, C. J. Casewit, K. S. Colwell, W. A. Goddard, W. M. Skiff, "UFF, a full periodic table force field for
/// molecular mechanics and molecular dynamics simulations", J. Am. Chem. Soc. 114 (1992) 10024-10035, as RDKit 2026.09.1
/// has them. All of its types of an element have the same two numbers.
#[allow(clippy::approx_constant, reason = "hafnium's distance is not π")]
const UFF: [(&str, f64, f64); 96] = [
    ("H", 2.886, 0.044),
    ("He", 2.362, 0.056),
    ("Li", 2.451, 0.025),
    ("Be", 2.745, 0.085),
    ("B", 4.083, 0.18),
    ("C", 3.851, 0.105),
    ("N", 3.66, 0.069),
    ("O", 3.5, 0.06),
    ("F", 3.364, 0.05),
    ("Ne", 3.243, 0.042),
    ("Na", 2.983, 0.03),
    ("Mg", 3.021, 0.111),
    ("Al", 4.499, 0.505),
    ("Si", 4.295, 0.402),
    ("P", 4.147, 0.305),
    ("S", 4.035, 0.274),
    ("Cl", 3.947, 0.227),
    ("Ar", 3.868, 0.185),
    ("K", 3.812, 0.035),
    ("Ca", 3.399, 0.238),
    ("Sc", 3.295, 0.019),
    ("Ti", 3.175, 0.017),
    ("V", 3.144, 0.016),
    ("Cr", 3.023, 0.015),
    ("Mn", 2.961, 0.013),
    ("Fe", 2.912, 0.013),
    ("Co", 2.872, 0.014),
    ("Ni", 2.834, 0.015),
    ("Cu", 3.495, 0.005),
    ("Zn", 2.763, 0.124),
    ("Ga", 4.383, 0.415),
    ("Ge", 4.28, 0.379),
    ("As", 4.23, 0.309),
    ("Se", 4.205, 0.291),
    ("Br", 4.189, 0.251),
    ("Kr", 4.141, 0.22),
    ("Rb", 4.114, 0.04),
    ("Sr", 3.641, 0.235),
    ("Y", 3.345, 0.072),
    ("Zr", 3.124, 0.069),
    ("Nb", 3.165, 0.059),
    ("Mo", 3.052, 0.056),
    ("Tc", 2.998, 0.048),
    ("Ru", 2.963, 0.056),
    ("Rh", 2.929, 0.053),
    ("Pd", 2.899, 0.048),
    ("Ag", 3.148, 0.036),
    ("Cd", 2.848, 0.228),
    ("In", 4.463, 0.599),
    ("Sn", 4.392, 0.567),
    ("Sb", 4.42, 0.449),
    ("Te", 4.47, 0.398),
    ("I", 4.5, 0.339),
    ("Xe", 4.404, 0.332),
    ("Cs", 4.517, 0.045),
    ("Ba", 3.703, 0.364),
    ("La", 3.522, 0.017),
    ("Ce", 3.556, 0.013),
    ("Pr", 3.606, 0.01),
    ("Nd", 3.575, 0.01),
    ("Pm", 3.547, 0.009),
    ("Sm", 3.52, 0.008),
    ("Eu", 3.493, 0.008),
    ("Gd", 3.368, 0.009),
    ("Tb", 3.451, 0.007),
    ("Dy", 3.428, 0.007),
    ("Ho", 3.409, 0.007),
    ("Er", 3.391, 0.007),
    ("Tm", 3.374, 0.006),
    ("Yb", 3.355, 0.228),
    ("Lu", 3.64, 0.041),
    ("Hf", 3.141, 0.072),
    ("Ta", 3.17, 0.081),
    ("W", 3.069, 0.067),
    ("Re", 2.954, 0.066),
    ("Os", 3.12, 0.037),
    ("Ir", 2.84, 0.073),
    ("Pt", 2.754, 0.08),
    ("Au", 3.293, 0.039),
    ("Hg", 2.705, 0.385),
    ("Tl", 4.347, 0.68),
    ("Pb", 4.297, 0.663),
    ("Bi", 4.37, 0.518),
    ("Po", 4.709, 0.325),
    ("At", 4.75, 0.284),
    ("Rn", 4.765, 0.248),
    ("Fr", 4.9, 0.05),
    ("Ra", 3.677, 0.404),
    ("Ac", 3.478, 0.033),
    ("Th", 3.396, 0.026),
    ("Pa", 3.424, 0.022),
    ("U", 3.395, 0.022),
    ("Np", 3.424, 0.019),
    ("Pu", 3.424, 0.016),
    ("Am", 3.381, 0.014),
    ("Cm", 3.326, 0.013),
];

/// AutoDock Vina's radii in Å of the atoms that can be hydrophobic.
///
/// `xs_vdw_radii` of AutoDock Vina 1.2 (O. Trott, A. J. Olson, "AutoDock Vina", J. Comput. Chem. 31 (2010) 455-461).
const VINA_RADII: [(&str, f64); 5] = [("C", 1.9), ("F", 1.5), ("Cl", 1.8), ("Br", 2.0), ("I", 2.2)];

/// The radius in Å of the hydrophobic term; 0 of elements that are not hydrophobic.
pub fn hydrophobic_radius(element: Element) -> f64 {
    let symbol = element.symbol();
    VINA_RADII.iter().find(|(known, _)| *known == symbol).map_or(0.0, |(_, radius)| *radius)
}

impl ParameterSet {
    /// The numbers of an element.
    pub fn van_der_waals(self, element: Element) -> VanDerWaals {
        let (_, distance, depth) = match self {
            ParameterSet::Autodock4 => autodock4(element).unwrap_or_else(|| uff(element)),
            ParameterSet::Uff => uff(element),
        };
        VanDerWaals { distance, depth: depth * KCAL }
    }

    /// Which of these elements the set has not itself, so that they have UFF's numbers: each once, in the order of the
    /// atomic numbers.
    pub fn taken_from_uff(self, elements: impl IntoIterator<Item = Element>) -> Vec<Element> {
        if self == ParameterSet::Uff {
            return Vec::new();
        }
        let lacks = |element: &Element| autodock4(*element).is_none();
        let mut lacking: Vec<Element> = elements.into_iter().filter(lacks).collect();
        lacking.sort_unstable();
        lacking.dedup();
        lacking
    }

    /// A and B of a pair. The depth is the geometric mean of the two; the distance is their arithmetic mean in AutoDock's
    /// set, for elements with UFF's numbers, too, and their geometric mean in UFF's.
    pub fn pair(self, one: Element, other: Element) -> PairCoefficients {
        let (one, other) = (self.van_der_waals(one), self.van_der_waals(other));
        let depth = (one.depth * other.depth).sqrt();
        let square = match self {
            ParameterSet::Autodock4 => {
                let distance = (one.distance + other.distance) / 2.0;
                distance * distance
            }
            ParameterSet::Uff => one.distance * other.distance,
        };
        let sixth = square * square * square;
        PairCoefficients { a: depth * (sixth * sixth), b: 2.0 * depth * sixth }
    }
}

/// AutoDock 4's row of an element, if it has one.
fn autodock4(element: Element) -> Option<(&'static str, f64, f64)> {
    let symbol = element.symbol();
    AUTODOCK_ELEMENTS.iter().find(|(known, ..)| *known == symbol).copied()
}

/// UFF's row of an element.
fn uff(element: Element) -> (&'static str, f64, f64) {
    UFF[usize::from(element.number()) - 1]
}
