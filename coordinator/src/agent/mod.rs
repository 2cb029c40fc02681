//! Agents: roadmill on other machines.
//!
//! An agent has workers of its own, and what they share, on its machine, so that the roadmap lies there once and everything
//! that is to be known of it is sent there once. To the coordinator it is one member with many cores. It opens no port:
//! its standard input and output are all that it needs, and whatever carries these (`ssh`, `srun`, `kubectl exec`, a relay
//! of Dask) sees to identity and secrecy.
//!
//! - [`link`]: messages along a pair of byte streams.
//! - [`message`]: what is said.
//! - [`Fleet`]: the coordinator's side, which starts agents and carries bytes; [`Carriers`] does so by a process for each
//!   [`Place`].
//!   What they are given to do is decided by [`Agents`](crate::dispatch::Agents).
//! - [`serve`]: the agent itself.

mod carriers;
mod fleet;
mod identity;
pub mod link;
pub mod message;
mod place;
mod serve;

pub use carriers::{Carriers, SILENCE_MAX};
pub use fleet::{Condition, Fleet, News, REFUSED};
pub use identity::Identity;
pub use message::{FromAgent, ToAgent};
pub use place::{PLACES_MAX, Place};
pub use serve::{Served, serve};
