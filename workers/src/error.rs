use crate::channel::ChannelError;
use roadmill::wire::WireError;

/// Why a worker ended.
#[derive(Debug, thiserror::Error)]
pub enum WorkerError {
    /// The coordinator ended before the worker could be tied to it.
    #[error("the coordinator is gone")]
    Orphaned,
    /// The system refused something.
    #[error("{0}: {1}")]
    System(&'static str, #[source] std::io::Error),
    /// The channel failed.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The coordinator said something that is no message.
    #[error("the coordinator sent {0}")]
    Message(#[from] WireError),
    /// The coordinator said something out of turn.
    #[error("the coordinator sent {0} out of turn")]
    Turn(&'static str),
    /// What the coordinator has put into shared memory is not what it said.
    #[error("the store's bytes have another digest")]
    Store,
    /// The coordinator does not want this worker.
    #[error("refused: {0}")]
    Refused(String),
    /// A test asked for faults that there are not.
    #[error("{0}: `{1}` found, faults expected")]
    Faults(&'static str, String),
}
