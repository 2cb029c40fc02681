//! What studies print.

/// A row of a table in Markdown.
pub fn row<T: AsRef<str>>(cells: &[T]) {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    println!("| {} |", cells.join(" | "));
}

/// The head of a table.
pub fn head<T: AsRef<str>>(cells: &[T]) {
    println!();
    row(cells);
    row(&vec!["---"; cells.len()]);
}

/// Whether numbers agree with the dissertation's, all within what a study states.
pub fn agreement(pairs: &[(f64, f64)], within: f64) -> &'static str {
    let agree = pairs.iter().filter(|(ours, paper)| (ours - paper).abs() <= within).count();
    match agree {
        _ if agree == pairs.len() => "yes",
        0 => "no",
        _ => "in part",
    }
}

/// What a study stated before it was run, and whether it came true; `None` where a run was not asked for.
pub fn stated(says: &str, came_true: Option<bool>) {
    let answer = match came_true {
        Some(true) => "yes",
        Some(false) => "no",
        None => "not run",
    };
    println!("- {says}: **{answer}**");
}

/// Numbers in the order of their size.
pub fn rises(numbers: &[f64]) -> bool {
    numbers.windows(2).all(|pair| pair[0] < pair[1])
}

/// A probability; none where there are too few runs for a test.
pub fn chance(probability: Option<f64>) -> String {
    match probability {
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
        None => "–".to_owned(),
    }
}
