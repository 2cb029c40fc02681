use super::Residue;
use std::fmt::Write;

/// Chains as mmCIF, by the dictionary PDBx/mmCIF of the wwPDB: what is read from it is equal to the last bit. Occupancies and
/// displacements are left away, and chains get the names that stand beside them.
pub fn mmcif(name: &str, chains: &[(&str, &[Residue])]) -> String {
    let mut out = String::new();
    write_all(&mut out, name, chains).expect("writing to memory cannot fail");
    out
}

fn write_all(out: &mut String, name: &str, chains: &[(&str, &[Residue])]) -> std::fmt::Result {
    writeln!(out, "data_{name}\n#")?;
    modified(out, chains)?;
    writeln!(out, "loop_")?;
    for column in [
        "group_PDB",
        "id",
        "type_symbol",
        "label_atom_id",
        "label_alt_id",
        "label_comp_id",
        "label_asym_id",
        "label_entity_id",
        "label_seq_id",
        "pdbx_PDB_ins_code",
        "Cartn_x",
        "Cartn_y",
        "Cartn_z",
        "occupancy",
        "B_iso_or_equiv",
        "auth_seq_id",
        "auth_comp_id",
        "auth_asym_id",
        "auth_atom_id",
        "pdbx_PDB_model_num",
    ] {
        writeln!(out, "_atom_site.{column}")?;
    }
    let mut id = 0;
    for (entity, (chain, residues)) in chains.iter().enumerate() {
        for (place, residue) in residues.iter().enumerate() {
            let (number, insertion) = (residue.number.number, insertion(residue));
            let (residue_name, entity, place) = (word(&residue.name), entity + 1, place + 1);
            for atom in &residue.atoms {
                id += 1;
                let (atom_name, [x, y, z]) = (word(&atom.name), atom.position.into());
                writeln!(
                    out,
                    "ATOM {id} {} {atom_name} . {residue_name} {chain} {entity} {place} {insertion} \
                     {x:?} {y:?} {z:?} 1.0 0.0 {number} {residue_name} {chain} {atom_name} 1",
                    word(&atom.element),
                )?;
            }
        }
    }
    writeln!(out, "#")
}

/// The residues that were amino acids before they were modified.
fn modified(out: &mut String, chains: &[(&str, &[Residue])]) -> std::fmt::Result {
    let all = chains.iter().flat_map(|(chain, residues)| residues.iter().map(move |r| (chain, r)));
    let modified = all.filter_map(|(chain, residue)| {
        let parent = residue.amino_acid?.code();
        (parent != residue.name).then_some((chain, residue, parent))
    });
    let modified: Vec<_> = modified.collect();
    if modified.is_empty() {
        return Ok(());
    }
    writeln!(out, "loop_")?;
    for column in
        ["id", "auth_asym_id", "auth_comp_id", "auth_seq_id", "PDB_ins_code", "parent_comp_id"]
    {
        writeln!(out, "_pdbx_struct_mod_residue.{column}")?;
    }
    for (id, (chain, residue, parent)) in modified.iter().enumerate() {
        let (name, number) = (word(&residue.name), residue.number.number);
        writeln!(out, "{} {chain} {name} {number} {} {parent}", id + 1, insertion(residue))?;
    }
    writeln!(out, "#")
}

fn insertion(residue: &Residue) -> char {
    residue.number.insertion.unwrap_or('?')
}

/// A name as mmCIF writes it: in quotes where it could be taken for something else.
fn word(name: &str) -> String {
    let is_plain = name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '+' | '*'));
    match (is_plain, name.contains('"')) {
        (true, _) => name.to_owned(),
        (false, false) => format!("\"{name}\""),
        (false, true) => format!("'{name}'"),
    }
}
