//! The query of §5: a path of the roadmap along which the robot can be deformed.

use super::search::Search;
use super::{DeformableRobot, DeformingAnswer, NoDeformedPath};
use crate::cancel::Cancel;
use crate::context::{Context, Ends};
use crate::local::Planner;
use crate::model::Scratch;
use crate::query::{Attachment, Ways};
use crate::roadmap::Roadmap;
use crate::space::Configs;

/// Looks for a path of the roadmap along which the robot can be deformed (§5, *Path query*).
///
/// First the robot is deformed at the ends. Then the ends are attached to the roadmap, by motions of the rigid robot that the problem's model
/// accepts; their direct motion is an edge like the others. A path of least weight is looked for, and the robot is deformed along its edges, from
/// the heaviest to the lightest, of edges of one weight first along that nearer to the start. An edge along which it cannot be deformed is
/// removed, and the search repeated. What is found of an edge holds for the whole query, and the roadmap stays as it is.
///
/// Of several goals the first, in the order of the problem, to which there is a path is taken.
pub fn deform_query(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    robot: DeformableRobot,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> DeformingAnswer {
    let mut search = Search::new(robot, cancel);
    let mut found = Err(NoDeformedPath::Apart);
    for goal in ends.goals() {
        let path = match search.ends([&ends.start, goal]) {
            Err(no) => Err(no),
            Ok(()) => {
                let both = [&ends.start[..], goal];
                let ways = Ways::between(cx, roadmap, both, attachment, scratch);
                let motion = |index: u32| {
                    let edge = ways.edges[index as usize];
                    let planner =
                        Planner::from_tag(edge.planner).expect("edges carry known planners");
                    planner.motion(cx, ways.config(edge.low), ways.config(edge.high))
                };
                search.path(&ways.graph, ways.ends(), &motion)
            }
        };
        found = match (found, path) {
            (_, Ok(path)) => Ok(path),
            // Of several goals what is said of the first that the roadmap comes to says most.
            (Err(NoDeformedPath::Refused), Err(no)) if no != NoDeformedPath::Cancelled => {
                Err(NoDeformedPath::Refused)
            }
            (_, Err(no)) => Err(no),
        };
        if matches!(found, Ok(_) | Err(NoDeformedPath::Start(_) | NoDeformedPath::Cancelled)) {
            break;
        }
        // Edges beyond those of the roadmap belong to this goal.
        search.forget_edges_from(roadmap.edges().len());
    }
    search.answer(found)
}

/// Deforms the robot along a path that is given by its configurations, at least one, leg by leg from the start: a path that was found for
/// another robot, say, as in the paper's sliding experiment (§7).
///
/// The answer's removed edge is the first leg along which the robot cannot be deformed; its ends are the numbers of configurations, from 0.
pub fn deform_path(configs: &Configs, robot: DeformableRobot, cancel: &Cancel) -> DeformingAnswer {
    let mut search = Search::new(robot, cancel);
    let found = search.along(configs);
    search.answer(found)
}
