use super::mixture::Mixing;
use crate::methods::Complaint;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Which terms the energy has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct EnergySpec {
    /// Whether the hydrogen bonds and disulphides of the structures are constraints.
    pub constraints: bool,
    /// Whether hydrophobic side chains gain by being close.
    pub hydrophobic: bool,
    /// How the constraints of two ends become one energy.
    pub ends: Mixing,
}

/// kT′ of the smooth minimum where nothing is said, model kJ/mol.
const DEFAULT_KT: f64 = 100.0;
/// The largest kT′.
const KT_MAX: f64 = 1e6;

impl Default for EnergySpec {
    fn default() -> EnergySpec {
        let ends = Mixing::SmoothMinimum { kt: DEFAULT_KT };
        EnergySpec { constraints: true, hydrophobic: true, ends }
    }
}

impl EnergySpec {
    /// What is wrong with the settings.
    pub(in crate::model::protein) fn complaint(&self) -> Option<Complaint> {
        match self.ends {
            // Written so that NaN fails it.
            Mixing::SmoothMinimum { kt } if !(kt > 0.0 && kt <= KT_MAX) => {
                Some(Complaint::new("kt", kt, "an energy above 0, at most 1e6"))
            }
            _ => None,
        }
    }
}
