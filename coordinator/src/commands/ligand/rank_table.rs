//! The table of ranked ligands, and how well their order agrees with what was measured.

use crate::exit::Failure;
use crate::files::read_regular_text;
use crate::output::note;
use roadmill::binding::{Affinity, Interval, Kendall, PValue, interval};
use roadmill::internal::csv_field::csv_field;
use roadmill::internal::plain::plain;
use roadmill::seed::{Purpose, Seed};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// How often ligands are drawn again for an interval.
const RESAMPLES: usize = 2000;

/// Measured affinities.
pub(super) struct Measured {
    values: BTreeMap<String, f64>,
    larger_is_stronger: bool,
}

impl Measured {
    /// Reads lines NAME,VALUE; a first line whose value is no number is a heading. Values of other ligands are left out, with a note.
    ///
    /// # Errors
    /// Exit code 2: a line that is none, a ligand that is named twice, fewer than three values.
    pub fn read(
        file: &Path,
        larger_is_stronger: bool,
        names: &[String],
    ) -> Result<Measured, Failure> {
        let path = file.display();
        let text = read_regular_text(file)
            .map_err(|error| Failure::usage(format!("{path}: cannot be read: {error}")))?;
        let (mut values, mut unknown) = (BTreeMap::new(), Vec::new());
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            if line.trim().is_empty() {
                continue;
            }
            let refuse =
                |message: String| Failure::usage(format!("{path}:{}: {message}", index + 1));
            let unquoted = |word: &str| word.trim().trim_matches('"').to_owned();
            let fields: Vec<String> = line.split(',').map(unquoted).collect();
            let number = fields.get(1).and_then(|word| word.parse::<f64>().ok());
            let is_heading = index == 0 && fields.len() >= 2 && number.is_none();
            if is_heading {
                continue;
            }
            let Some(value) = number.filter(|number| number.is_finite()) else {
                return Err(refuse(format!("`{}` found; NAME,VALUE expected", plain(line))));
            };
            if !names.contains(&fields[0]) {
                unknown.push(plain(&fields[0]).into_owned());
                continue;
            }
            if values.insert(fields[0].clone(), value).is_some() {
                let name = plain(&fields[0]);
                return Err(refuse(format!(
                    "`{name}` found a second time; one value for each ligand expected"
                )));
            }
        }
        if !unknown.is_empty() {
            note(format_args!(
                "{path}: left out, as there are no such ligands: {}",
                unknown.join(", ")
            ));
        }
        if values.len() < 3 {
            let found = values.len();
            return Err(Failure::usage(format!(
                "{path}: values of {found} ligands found; of three or more expected, as fewer have no order to speak of"
            )));
        }
        Ok(Measured { values, larger_is_stronger })
    }
}

/// A ligand with its numbers.
#[derive(Serialize)]
pub(super) struct Ranked {
    pub name: String,
    pub heavy_atoms: usize,
    pub degrees_of_freedom: usize,
    pub samples: usize,
    /// Whether the samples were enough by the evaluator; `None` if there is none.
    pub is_covered: Option<bool>,
    /// In the order of [`Affinity::NAMES`]: three distances in Å, three energies in kJ/mol.
    pub numbers: [f64; 6],
}

/// How well a metric's order agrees with the measured one.
#[derive(Serialize)]
struct Agreement {
    metric: &'static str,
    tau: f64,
    p: f64,
    p_by: &'static str,
    low: Option<f64>,
    high: Option<f64>,
}

/// All of it.
#[derive(Serialize)]
pub(super) struct RankTable {
    ligands: Vec<Ranked>,
    measured: Vec<Option<f64>>,
    larger_is_stronger: bool,
    agreements: Vec<Agreement>,
    /// How many ligands have a measured value.
    compared: usize,
}

/// What the control is called.
const CONTROL: &str = "heavy atoms (control)";

impl RankTable {
    pub fn of(ligands: Vec<Ranked>, measured: Option<&Measured>, seed: u64) -> RankTable {
        let value = |ligand: &Ranked| measured?.values.get(&ligand.name).copied();
        let values: Vec<Option<f64>> = ligands.iter().map(value).collect();
        let larger_is_stronger = measured.is_some_and(|measured| measured.larger_is_stronger);
        let sign = if larger_is_stronger { -1.0 } else { 1.0 };
        // Only ligands with a measured value; smaller means stronger in both lists.
        let known: Vec<(&Ranked, f64)> = ligands
            .iter()
            .zip(&values)
            .filter_map(|(ligand, value)| Some((ligand, sign * (*value)?)))
            .collect();
        let truth: Vec<f64> = known.iter().map(|(_, value)| *value).collect();
        let agreement = |metric: &'static str, numbers: Vec<f64>| {
            let Kendall { tau, p, method } = Kendall::of(&numbers, &truth)?;
            let label = format!("interval of {metric}");
            let mut stream = Seed::of_calibration(seed, &label).stream(Purpose::Sampling);
            let found: Option<Interval> = interval(&numbers, &truth, RESAMPLES, &mut stream);
            let p_by = match method {
                PValue::Permutations => "permutations",
                PValue::Inversions => "inversions",
                PValue::Normal => "normal distribution",
            };
            let (low, high) = (found.map(|it| it.low), found.map(|it| it.high));
            Some(Agreement { metric, tau, p, p_by, low, high })
        };
        let of_metric = |index: usize| known.iter().map(|(it, _)| it.numbers[index]).collect();
        let control = known.iter().map(|(ligand, _)| ligand.heavy_atoms as f64).collect();
        let agreements = Affinity::NAMES
            .iter()
            .enumerate()
            .filter_map(|(index, name)| agreement(name, of_metric(index)))
            .chain(agreement(CONTROL, control))
            .collect();
        let compared = truth.len();
        RankTable { agreements, compared, measured: values, larger_is_stronger, ligands }
    }

    fn has_measured(&self) -> bool {
        self.measured.iter().any(Option::is_some)
    }

    /// The table for a terminal.
    pub fn text(&self) -> String {
        let mut out = String::from(
            "distances of the centres of mass in Å, energies by exact sums in kJ/mol: minimum, mean of the lowest 1 % and 10 %\n",
        );
        let width = self.ligands.iter().map(|ligand| ligand.name.len()).max().unwrap_or(0).max(6);
        let mut add = |line: std::fmt::Arguments| {
            out.write_fmt(line).expect("writing to memory cannot fail");
            out.push('\n');
        };
        let measured = if self.has_measured() { "  measured" } else { "" };
        add(format_args!(
            "{:<width$}  heavy  dofs  samples  covered  distance      1 %     10 %    energy       1 %      10 %{measured}",
            "ligand"
        ));
        for (ligand, value) in self.ligands.iter().zip(&self.measured) {
            let [a, b, c, d, e, f] = ligand.numbers;
            let value = match (self.has_measured(), value) {
                (false, _) => String::new(),
                (true, None) => format!("{:>10}", "-"),
                (true, Some(value)) => format!("{value:>10}"),
            };
            add(format_args!(
                "{:<width$}{:>7}{:>6}{:>9}{:>9}{a:>10.2}{b:>9.2}{c:>9.2}{d:>10.1}{e:>10.1}{f:>10.1}{value}",
                ligand.name,
                ligand.heavy_atoms,
                ligand.degrees_of_freedom,
                ligand.samples,
                covered(ligand),
            ));
        }
        if !self.agreements.is_empty() {
            add(format_args!(
                "Kendall's tau-b with the measured order of {} ligands; 1: the same order",
                self.compared
            ));
            add(format_args!("{:<24}{:>7}{:>9}   95 % interval", "metric", "tau", "p"));
            for it in &self.agreements {
                add(format_args!(
                    "{:<24}{:>7.3}{:>9.4}   {}",
                    it.metric,
                    it.tau,
                    it.p,
                    it.interval()
                ));
            }
            add(format_args!("{}", self.reading()));
        }
        out
    }

    /// How the agreements are to be read.
    fn reading(&self) -> String {
        format!(
            "Smaller numbers are taken as stronger binding, of heavy atoms too: a tau of the control below 0 says that larger ligands bind more \
             strongly. The interval is of ligands drawn again, {RESAMPLES} times; one that contains 0 shows no order."
        )
    }

    /// The table as CSV, ligands only.
    pub fn csv(&self) -> String {
        let mut csv = "ligand,heavy_atoms,degrees_of_freedom,samples,covered,distance_minimum [A],distance_1_percent [A],\
                       distance_10_percent [A],energy_minimum [kJ/mol],energy_1_percent [kJ/mol],energy_10_percent [kJ/mol],measured\n"
            .to_owned();
        for (ligand, value) in self.ligands.iter().zip(&self.measured) {
            let numbers = ligand.numbers.map(|number| number.to_string()).join(",");
            writeln!(
                csv,
                "{},{},{},{},{},{numbers},{}",
                csv_field(&ligand.name),
                ligand.heavy_atoms,
                ligand.degrees_of_freedom,
                ligand.samples,
                covered(ligand),
                value.map_or(String::new(), |value| value.to_string()),
            )
            .expect("writing to memory cannot fail");
        }
        csv
    }

    /// Both tables as Markdown.
    pub fn markdown(&self) -> String {
        let mut out = String::from(
            "# Ligands ranked\n\nDistances of the centres of mass of protein and ligand in Å, energies by exact sums in kJ/mol: the minimum over all \
             samples, and the means of the lowest 1 % and 10 %.\n\n\
             | ligand | heavy atoms | dofs | samples | covered | distance | 1 % | 10 % | energy | 1 % | 10 % | measured |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|\n",
        );
        let mut add = |line: std::fmt::Arguments| {
            out.write_fmt(line).expect("writing to memory cannot fail");
            out.push('\n');
        };
        for (ligand, value) in self.ligands.iter().zip(&self.measured) {
            let [a, b, c, d, e, f] = ligand.numbers;
            add(format_args!(
                "| {} | {} | {} | {} | {} | {a:.2} | {b:.2} | {c:.2} | {d:.1} | {e:.1} | {f:.1} | {} |",
                ligand.name,
                ligand.heavy_atoms,
                ligand.degrees_of_freedom,
                ligand.samples,
                covered(ligand),
                value.map_or(String::new(), |value| value.to_string()),
            ));
        }
        if !self.agreements.is_empty() {
            add(format_args!(
                "\nKendall's τ-b with the measured order of {} ligands (1: the same order).\n",
                self.compared
            ));
            add(format_args!("| metric | τ | p | 95 % interval | p by |\n|---|---|---|---|---|"));
            for it in &self.agreements {
                let Agreement { metric, tau, p, p_by, .. } = it;
                add(format_args!("| {metric} | {tau:.3} | {p:.4} | {} | {p_by} |", it.interval()));
            }
            add(format_args!("\n{}", self.reading()));
        }
        out
    }
}

impl Agreement {
    fn interval(&self) -> String {
        match (self.low, self.high) {
            (Some(low), Some(high)) => format!("{low:.3} to {high:.3}"),
            _ => "-".to_owned(),
        }
    }
}

/// Whether a ligand's samples are enough, in a word.
fn covered(ligand: &Ranked) -> &'static str {
    match ligand.is_covered {
        Some(true) => "yes",
        Some(false) => "no",
        None => "-",
    }
}
