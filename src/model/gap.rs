/// The capability of a model whose robot and whose obstacles both have gaps: places where two stretches of one surface face each other nearby across free space,
/// such as the two ends of an open ring, or the sides of a slot.
///
/// Something that is to get out of an obstacle has to pass through the obstacle's gaps, or the obstacle through its own. The configurations at which a
/// gap of the one is at a gap of the other are few, and often in the narrowest passages that there are (X. Zhang, R. Belfer, P. G. Kry, E. Vouga, *C-space
/// tunnel discovery for puzzle path planning*, ACM Transactions on Graphics 39, 2020, who match gaps and notches).
pub trait Gaps {
    /// How many pairs there are of a gap of the robot and one of the obstacles; at least one.
    fn pairs(&self) -> usize;

    /// The widths of the two gaps of a pair, in the scene's unit: the robot's, then the obstacles'.
    fn widths(&self, pair: usize) -> [f64; 2];

    /// Moves the robot's base, and nothing else, so that the middle of the robot's gap comes to that of the obstacles' and `offset` farther, in the
    /// world's frame. `q` may come to lie out of bounds.
    fn align(&self, pair: usize, offset: [f64; 3], q: &mut [f64]);
}
