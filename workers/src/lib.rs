//! workers
pub mod channel;
