//! The page about a comparison of strategies: what each took over several seeds, and how large a roadmap each needed.

use super::super::markup::escaped;
use super::super::palette::colour;
use super::chart::{Chart, Series};
use super::page;
use std::fmt::Write;

/// One build of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedBuild {
    /// The strategy's label.
    pub strategy: String,
    /// The base seed.
    pub seed: u64,
    /// Nodes and edges at its end.
    pub nodes: u64,
    /// Edges at its end.
    pub edges: u64,
    /// CPU seconds of all processes, of all calls that grew it; `None` where they are not known, since one was killed.
    pub cpu_seconds: Option<f64>,
    /// The nodes at the end of the first round after which all criteria were met; `None` where they never were.
    pub enough: Option<u64>,
    /// The share of drawn valid configurations that can be connected to the roadmap at its end.
    pub coverage: f64,
    /// For each round the nodes, and what every evaluator said, in the order of [`Comparison::evaluators`].
    pub rounds: Vec<(u64, Vec<f64>)>,
}

/// Strategies side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The problem's name.
    pub problem: String,
    /// The labels of the strategies, in the order in which they are shown.
    pub strategies: Vec<String>,
    /// The evaluators' names, each with the value that it asks for.
    pub evaluators: Vec<(String, f64)>,
    /// The builds, in any order.
    pub builds: Vec<ComparedBuild>,
}

/// What the builds of a strategy came to.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedStrategy<'a> {
    /// Its label.
    pub strategy: &'a str,
    /// How many builds there are.
    pub builds: usize,
    /// How many met all criteria.
    pub enough: usize,
    /// Least, median and greatest number of nodes of those that did.
    pub nodes: Option<[f64; 3]>,
    /// Least, median and greatest CPU seconds of those that did and whose CPU seconds are known.
    pub cpu_seconds: Option<[f64; 3]>,
    /// The median of all builds' coverage.
    pub coverage: f64,
}

impl Comparison {
    /// What each strategy came to.
    pub fn summary(&self) -> Vec<ComparedStrategy<'_>> {
        let summed = self.strategies.iter().map(|strategy| {
            let of = || self.builds.iter().filter(|build| build.strategy == *strategy);
            let met = || of().filter(|build| build.enough.is_some());
            let nodes = met().filter_map(|build| build.enough).map(|nodes| nodes as f64);
            ComparedStrategy {
                strategy,
                builds: of().count(),
                enough: met().count(),
                nodes: spread(nodes.collect()),
                cpu_seconds: spread(met().filter_map(|build| build.cpu_seconds).collect()),
                coverage: spread(of().map(|build| build.coverage).collect())
                    .map_or(f64::NAN, |[_, median, _]| median),
            }
        });
        summed.collect()
    }

    /// A table with a line per build; CPU seconds that are not known are left empty.
    pub fn csv(&self) -> String {
        let mut csv = String::from(
            "strategy,seed,nodes,edges,cpu_seconds,criteria_met,nodes_when_met,coverage\n",
        );
        for build in &self.builds {
            let ComparedBuild {
                strategy, seed, nodes, edges, cpu_seconds, enough, coverage, ..
            } = build;
            let when = enough.map_or(String::new(), |nodes| nodes.to_string());
            let met = enough.is_some();
            let cpu_seconds = cpu_seconds.map_or(String::new(), |seconds| seconds.to_string());
            writeln!(
                csv,
                "{strategy},{seed},{nodes},{edges},{cpu_seconds},{met},{when},{coverage}"
            )
            .expect("memory");
        }
        csv
    }

    /// A table with a line per build and round: the nodes, and the value of every evaluator.
    pub fn curves_csv(&self) -> String {
        let names = self.evaluators.iter().map(|(name, _)| format!(",{}", name.replace(", ", ":")));
        let mut csv = format!("strategy,seed,nodes{}\n", names.collect::<String>());
        for ComparedBuild { strategy, seed, rounds, .. } in &self.builds {
            for (nodes, values) in rounds {
                let values: String = values.iter().map(|value| format!(",{value}")).collect();
                writeln!(csv, "{strategy},{seed},{nodes}{values}").expect("memory");
            }
        }
        csv
    }

    /// The page: HTML without references to other files. The same bytes for the same builds.
    pub fn html(&self) -> String {
        let mut body = format!("<header><h1>{}: strategies compared</h1></header>\n<main>\n", {
            escaped(&self.problem)
        });
        body += &self.table();
        body += "<section><h2>How large a roadmap?</h2>\n<p>What each evaluator says over the number of nodes: a line per \
            seed, a colour per strategy. The level line is what the criterion asks for; a build stops where all are \
            met.</p>\n<div class=\"charts\">\n";
        for (index, (name, threshold)) in self.evaluators.iter().enumerate() {
            body += &self.chart(index, name, *threshold).html();
        }
        body += "</div></section>\n</main>\n";
        page(&self.problem, &body)
    }

    fn table(&self) -> String {
        let mut html = String::from(
            "<section><h2>Builds</h2>\n<p>Nodes and CPU seconds are least, <b>median</b> and greatest over the builds that \
             met all criteria, and whose CPU seconds are known; coverage is the median of all.</p>\n<div class=\"scroll\"><table><tr><th>strategy</th>\
             <th>met</th><th>nodes</th><th>CPU seconds</th><th>coverage</th></tr>\n",
        );
        let three = |spread: Option<[f64; 3]>, decimals: usize| match spread {
            None => "–".to_owned(),
            Some([least, median, most]) => {
                format!("{least:.decimals$} <b>{median:.decimals$}</b> {most:.decimals$}")
            }
        };
        for (index, of) in self.summary().into_iter().enumerate() {
            let ComparedStrategy { strategy, builds, enough, nodes, cpu_seconds, coverage } = of;
            writeln!(
                html,
                "<tr><th><span class=\"swatch\" style=\"background:{}\"></span>{}</th><td>{enough} of {builds}</td>\
                 <td>{}</td><td>{}</td><td>{coverage:.2}</td></tr>",
                colour(index),
                escaped(strategy),
                three(nodes, 0),
                three(cpu_seconds, 2),
            )
            .expect("memory");
        }
        html + "</table></div></section>\n"
    }

    fn chart(&self, index: usize, name: &str, threshold: f64) -> Chart {
        let mut series = Vec::new();
        for (place, strategy) in self.strategies.iter().enumerate() {
            let mut first = true;
            for build in self.builds.iter().filter(|build| build.strategy == *strategy) {
                let point =
                    |(nodes, values): &(u64, Vec<f64>)| Some([*nodes as f64, *values.get(index)?]);
                series.push(Series {
                    // One line of a strategy stands for all in the legend.
                    name: if first { strategy.clone() } else { String::new() },
                    colour: colour(place),
                    dashed: false,
                    points: build.rounds.iter().filter_map(point).collect(),
                });
                first = false;
            }
        }
        Chart {
            title: name.to_owned(),
            axes: ["nodes".to_owned(), name.to_owned()],
            series,
            levels: vec![(threshold, format!("asked for: {threshold}"))],
        }
    }
}

/// Least, median and greatest; of an even number of values the median is the mean of the two in the middle.
fn spread(mut values: Vec<f64>) -> Option<[f64; 3]> {
    values.sort_by(f64::total_cmp);
    let (first, last) = (*values.first()?, *values.last()?);
    let middle = values.len() / 2;
    let median = match values.len() % 2 {
        1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    };
    Some([first, median, last])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build(
        strategy: &str,
        seed: u64,
        enough: Option<u64>,
        cpu_seconds: impl Into<Option<f64>>,
    ) -> ComparedBuild {
        ComparedBuild {
            strategy: strategy.to_owned(),
            seed,
            nodes: 500,
            edges: 900,
            cpu_seconds: cpu_seconds.into(),
            enough,
            coverage: 0.5,
            rounds: vec![(250, vec![0.0]), (500, vec![f64::from(u8::from(enough.is_some()))])],
        }
    }

    fn comparison() -> Comparison {
        Comparison {
            problem: "a<b".to_owned(),
            strategies: vec!["x".to_owned(), "y".to_owned()],
            evaluators: vec![("query".to_owned(), 1.0)],
            builds: vec![
                build("x", 1, Some(500), 3.0),
                build("x", 2, Some(300), 1.0),
                build("x", 3, None, 9.0),
                build("y", 1, None, 2.0),
                build("y", 2, Some(400), None),
            ],
        }
    }

    #[test]
    fn medians_are_of_the_builds_that_met_the_criteria() {
        let comparison = comparison();
        let [x, y] = &comparison.summary()[..] else { panic!("two strategies") };
        assert_eq!((x.builds, x.enough), (3, 2));
        assert_eq!((x.nodes, x.cpu_seconds), (Some([300.0, 400.0, 500.0]), Some([1.0, 2.0, 3.0])));
        // Of the one build that met the criteria nobody knows the seconds.
        let expected = (2, 1, Some([400.0; 3]), None);
        assert_eq!((y.builds, y.enough, y.nodes, y.cpu_seconds), expected);
        assert_eq!(spread(vec![3.0, 1.0, 2.0]), Some([1.0, 2.0, 3.0]));
    }

    #[test]
    fn tables_and_the_page_hold_every_build() {
        let comparison = comparison();
        assert_eq!(comparison.csv().lines().count(), 6);
        assert!(comparison.csv().contains("\ny,2,500,900,,true,400,0.5\n"), "{}", comparison.csv());
        assert!(comparison.csv().contains("\nx,3,500,900,9,false,,0.5\n"), "{}", comparison.csv());
        assert_eq!(comparison.curves_csv().lines().count(), 11);
        assert!(comparison.curves_csv().contains("\ny,1,500,0\n"));
        let html = comparison.html();
        assert!(html.contains("a&lt;b") && !html.contains("a<b"), "names are text");
        assert!(
            html.contains("<td>2 of 3</td>")
                && html.contains("<td>1 of 2</td><td>400 <b>400</b> 400</td><td>–</td>")
        );
        // A line per build, and per strategy a key in the legend.
        assert_eq!(html.matches("class=\"line\" d=\"M").count(), 5 + 2);
        assert_eq!(html, comparison.html());
    }
}
