//! Which terms the energy has, and by which numbers.

use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The least cut-off in Å: the hydrophobic term ends at 5.9 Å at the latest.
pub const CUTOFF_MIN: f64 = 6.0;
/// The largest cut-off in Å: no protein is wider, so that nothing is cut off.
pub const CUTOFF_MAX: f64 = 1000.0;
/// The width in Å of the shell below the cut-off in which the terms are switched off.
pub const SWITCH_WIDTH: f64 = 2.0;
/// The range of the factor of the dielectric: 1 is vacuum at 1 Å, 4 what docking programs take.
const DIELECTRIC_RANGE: [f64; 2] = [1.0, 1000.0];

/// Which terms the energy of a ligand has, as a table of a problem file says it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct EnergySpec {
    /// Where the 12-6 terms have their numbers from.
    pub parameters: ParameterSet,
    /// The distance in Å from which on the 12-6 and Coulomb terms are zero, 6 to 1000.
    pub cutoff: f64,
    /// The factor D of the dielectric D r, r in Å; without it charges do not count.
    pub dielectric: Option<f64>,
    /// Whether pairs of hydrophobic atoms attract each other beyond what the 12-6 terms say.
    pub hydrophobic: bool,
    /// How the ligand's own atoms act upon each other.
    pub own: Own,
}

/// How the ligand's own atoms act upon each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Own {
    /// Not at all, as in O. B. Bayazit 2003, equation 5.2: the ligand may pass through itself.
    None,
    /// They repel each other: 12-6 terms cut at their minima and raised to zero there (J. D. Weeks, D. Chandler, H. C. Andersen,
    /// J. Chem. Phys. 54 (1971) 5237-5247). Attraction among them is left out, as in water it makes little difference
    /// whether an atom has its own molecule beside it or the solvent: with it, in vacuum, ligands fold up.
    #[default]
    Repulsion,
    /// By whole 12-6 terms, and Coulomb terms where charges count: as in vacuum.
    Whole,
}

/// A set of parameters for the 12-6 terms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum ParameterSet {
    /// AutoDock 4.1's, by element; UFF's for elements that AutoDock 4 lacks.
    #[default]
    Autodock4,
    /// Those of the Universal Force Field, for all elements.
    Uff,
}

impl Default for EnergySpec {
    fn default() -> EnergySpec {
        EnergySpec {
            parameters: ParameterSet::default(),
            cutoff: 12.0,
            dielectric: None,
            hydrophobic: false,
            own: Own::default(),
        }
    }
}

impl EnergySpec {
    /// What is wrong with the numbers, if anything: the key of the table, what was found and what is expected.
    pub fn complaint(&self) -> Option<(&'static str, String)> {
        // Both tests are written so that NaN fails them.
        if !(CUTOFF_MIN..=CUTOFF_MAX).contains(&self.cutoff) {
            let found = self.cutoff;
            let message =
                format!("{found} found; a distance of {CUTOFF_MIN} to {CUTOFF_MAX} Å expected");
            return Some(("cutoff", message));
        }
        let [least, most] = DIELECTRIC_RANGE;
        if let Some(found) = self.dielectric.filter(|found| !(least..=most).contains(found)) {
            let message = format!("{found} found; a factor of {least} to {most} expected");
            return Some(("dielectric", message));
        }
        None
    }
}
