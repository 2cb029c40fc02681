//! The energy along the path, with a mark that moves as the path is played.

use super::super::report::chart::{Axis, Frame};
use crate::deformation::DeformedPath;

/// Width and height of the picture, in pixels.
const SIZE: [f64; 2] = [1120.0, 230.0];

/// The section with the picture; the mark's places are those of the frames that the page has.
pub(super) fn energies(path: &DeformedPath, kept: &[usize]) -> String {
    let points: Vec<[f64; 2]> =
        path.frames.iter().map(|frame| [100.0 * frame.share, frame.energy]).collect();
    let energies = points.iter().map(|point| point[1]);
    let axes = ["way along the path, %", "energy"].map(str::to_owned);
    let (x, y) = (Axis::over([0.0, 100.0].into_iter()), Axis::over(energies.chain([0.0])));
    let mut frame = Frame::new("Energy of the deformation along the path", &axes, x, y, SIZE);
    frame.line(&points, "line", "currentColor", false);
    let places: Vec<String> = (kept.iter())
        .map(|index| {
            let [x, y] = frame.place(points[*index]).map(|x| if x.is_finite() { x } else { 0.0 });
            format!("{x:.1},{y:.1}")
        })
        .collect();
    frame.put(format_args!(
        "<circle class=\"cursor\" r=\"5\" data-places=\"{}\"/>",
        places.join(" ")
    ));
    format!(
        "<section id=\"energy\"><h2>The energy along the path</h2>\n<figure><figcaption>Energy of the deformation \
         <span class=\"legend\">0 where the robot is at rest; a click on the picture goes there</span></figcaption>\n{}</figure></section>\n",
        frame.finish()
    )
}
