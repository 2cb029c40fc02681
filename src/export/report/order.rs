//! The two numbers by which the map is laid out: order parameters.

use super::Report;
use crate::model::Scratch;
use crate::pathways::DomainAngle;
use crate::structure::Residue;
use crate::structure::measure::CentredPoints;

/// Two numbers of every configuration.
pub(super) struct OrderParameters<'a> {
    report: &'a Report<'a>,
    kind: Kind<'a>,
}

enum Kind<'a> {
    /// Two angles between domains of a molecule, in degrees.
    Angles { residues: Vec<Residue>, angles: [&'a DomainAngle; 2] },
    /// The Cα RMSD from either end, in Å.
    Shapes([CentredPoints; 2]),
    /// The distance from either end in the space's metric.
    Metric,
}

impl<'a> OrderParameters<'a> {
    /// The first two angles that were asked for; without two, how far a configuration is from either end.
    pub fn of(report: &'a Report<'a>, scratch: &mut Scratch) -> OrderParameters<'a> {
        let ends = [&report.ends.start, &report.ends.goal];
        let molecule = report.problem.model.description().molecule();
        let kind = match (molecule, report.angles) {
            (Some(molecule), [one, other, ..]) => {
                let residues = molecule.chains_at(ends[0]).swap_remove(0);
                Kind::Angles { residues, angles: [one, other] }
            }
            _ => match ends.map(|q| report.cx.model.shape(q, scratch)) {
                [Some(a), Some(b)] => Kind::Shapes([&a, &b].map(|shape| CentredPoints::new(shape))),
                _ => Kind::Metric,
            },
        };
        OrderParameters { report, kind }
    }

    /// What the two numbers are, with their units.
    pub fn names(&self) -> [String; 2] {
        match &self.kind {
            Kind::Angles { angles, .. } => angles.map(|angle| format!("{} [°]", angle.name)),
            Kind::Shapes(_) => ["start", "goal"].map(|end| format!("Cα RMSD from the {end} [Å]")),
            Kind::Metric => ["start", "goal"].map(|end| format!("distance from the {end}")),
        }
    }

    /// The two numbers of a configuration.
    pub fn at(&self, q: &[f64], scratch: &mut Scratch) -> [f64; 2] {
        let Report { cx, ends, .. } = self.report;
        match &self.kind {
            Kind::Metric => [&ends.start, &ends.goal].map(|end| cx.space.distance(q, end)),
            Kind::Shapes(ends) => match cx.model.shape(q, scratch) {
                Some(shape) => {
                    let shape = CentredPoints::new(&shape);
                    ends.each_ref().map(|end| shape.rmsd(end))
                }
                None => [f64::NAN; 2],
            },
            Kind::Angles { residues, angles } => match cx.model.shape(q, scratch) {
                Some(alphas) => angles.map(|angle| angle.degrees_of_alphas(residues, &alphas)),
                None => [f64::NAN; 2],
            },
        }
    }
}
