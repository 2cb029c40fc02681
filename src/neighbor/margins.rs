//! What rounding may take from distances as [`Space::distance`](crate::space::Space::distance) computes them, for the bounds in double
//! precision by which searches pass over what cannot be an answer. The index, in single precision, has bounds of its own
//! (`embedding.rs`).

/// Relative to a distance, or to a bound on it.
pub(super) const MARGIN: f64 = 1e-12;
/// Besides, per unit of a rotation's weight: small angles of rotations are rounded to about 10⁻⁸.
pub(super) const ROTATION_MARGIN: f64 = 1e-6;
/// And what squares lose that are too small to be numbers.
pub(super) const TINY: f64 = 1e-150;
