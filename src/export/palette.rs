//! Colours of the paths, in reports and in the scripts for other programs alike.

/// Told apart also by those who see no red or green (after B. Wong, *Points of view: color blindness*, Nature Methods 8 (2011)
/// 441), darkened where they have to show on a light ground.
pub(super) const COLOURS: [&str; 8] =
    ["#0072b2", "#c1440e", "#00805e", "#b0568f", "#a07800", "#3a8fc7", "#5b3fa0", "#4d4d4d"];

/// The start and the goal, where both are shown beside a path.
pub(super) const ENDS: [&str; 2] = ["#7a8288", "#c9a21f"];

/// The colour of the path `index`, counted from 0.
pub(super) fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}
