//! Which set comes next: the schedule over the strategies, by the problem file or by what the strategies have
//! come to.

mod adaptive;
mod history;
mod plan;

pub use adaptive::{Adaptive, Yield};
pub use plan::Plan;
