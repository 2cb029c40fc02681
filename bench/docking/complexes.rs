//! Complexes whose poses are known, in `ROADMILL_DATA`.

use std::path::PathBuf;

/// A complex.
pub struct Complex {
    /// Its name, as in `bench/peers/docking-boxes.csv`.
    pub name: &'static str,
    /// The key `protein` of the table `[docking]`.
    protein: &'static str,
    /// The key `ligand`.
    ligand: &'static str,
}

/// All of them.
pub const COMPLEXES: [Complex; 7] = [
    Complex {
        name: "3PTB",
        protein: "{ file = \"DATA/structures/3PTB.pdb\" }",
        ligand: "{ file = \"DATA/structures/3PTB_BEN.sdf\" }",
    },
    Complex {
        name: "1STP",
        protein: "{ file = \"DATA/structures/1STP.pdb\" }",
        ligand: "{ file = \"DATA/structures/1STP.pdb\", residue = \"BTN\" }",
    },
    Complex {
        name: "4DFR-A",
        protein: "{ file = \"DATA/structures/4DFR.pdb\", chains = [\"A\"] }",
        ligand: "{ file = \"DATA/structures/4DFR.pdb\", residue = \"MTX\", chain = \"A\" }",
    },
    Complex {
        name: "4DFR-B",
        protein: "{ file = \"DATA/structures/4DFR.pdb\", chains = [\"B\"] }",
        ligand: "{ file = \"DATA/structures/4DFR.pdb\", residue = \"MTX\", chain = \"B\" }",
    },
    Complex {
        name: "1HVR",
        protein: "{ file = \"DATA/structures/1HVR.pdb\" }",
        ligand: "{ file = \"DATA/structures/1HVR.pdb\", residue = \"XK2\" }",
    },
    Complex {
        name: "1A28",
        protein: "{ file = \"DATA/structures/1A28.pdb\", chains = [\"A\"] }",
        ligand: "{ file = \"DATA/structures/1A28.pdb\", residue = \"STR\", chain = \"A\" }",
    },
    Complex {
        name: "thrombin",
        protein: "{ file = \"DATA/ligands/thrombin/protein.pdb\" }",
        ligand: "{ file = \"DATA/ligands/thrombin/ligands.sdf\", molecule = \"lig_4\" }",
    },
];

/// The folder of data.
///
/// # Panics
/// If the environment does not name it.
pub fn data() -> PathBuf {
    let folder = std::env::var_os("ROADMILL_DATA").expect("ROADMILL_DATA names the folder of data");
    PathBuf::from(folder)
}

impl Complex {
    /// The table `[docking]`, in a box about the known pose, or blind.
    pub fn table(&self, is_boxed: bool) -> String {
        let folder = data();
        let folder = folder.to_str().expect("a path of UTF-8");
        let mut text = format!("[docking]\nprotein = {}\nligand = {}\n", self.protein, self.ligand);
        if is_boxed {
            let boxes = include_str!("../peers/docking-boxes.csv");
            let line = boxes.lines().find(|line| line.split(',').next() == Some(self.name));
            let numbers: Vec<&str> = line.expect("every complex has a box").split(',').collect();
            text += &format!(
                "box = {{ centre = [{}, {}, {}], size = [{3}, {3}, {3}] }}\n",
                numbers[1], numbers[2], numbers[3], numbers[4],
            );
        }
        text.replace("DATA", folder)
    }
}

/// Those that are asked for; all of them if none is.
pub fn chosen(names: &[String]) -> Vec<&'static Complex> {
    let is_chosen =
        |complex: &&Complex| names.is_empty() || names.iter().any(|name| name == complex.name);
    COMPLEXES.iter().filter(is_chosen).collect()
}
