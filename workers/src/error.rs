use crate::channel::ChannelError;
use crate::stream::FrameError;
use roadmill::internal::wire::WireError;

/// Why a worker ended.
#[derive(Debug, thiserror::Error)]
pub enum WorkerError {
    /// The coordinator ended before the worker could be tied to it.
    #[error("the coordinator is gone")]
    Orphaned,
    /// The system refused something.
    #[error("{0}: {1}")]
    System(&'static str, #[source] std::io::Error),
    /// The channel in shared memory failed.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The stream to the coordinator has ended, or cannot be read or written any more.
    #[error("the coordinator is gone")]
    Gone,
    /// What came along the stream is no frame.
    #[error("the coordinator sent {0}")]
    Frame(#[from] FrameError),
    /// A message was to be sent before the last was answered, or a reply read where none is to come: a
    /// mistake of whoever uses the line.
    #[error("the line to the coordinator was used out of turn")]
    OutOfTurn,
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

impl WorkerError {
    /// Whether the coordinator is gone, which is how a worker learns that the build is over: nothing that it
    /// would have to complain of.
    pub fn is_end(&self) -> bool {
        matches!(
            self,
            WorkerError::Orphaned
                | WorkerError::Gone
                | WorkerError::Channel(ChannelError::HubGone | ChannelError::Abandoned)
        )
    }
}
