use super::stream::{Ending, FarEnd, Started, StreamCrew};
use roadmill_workers::stream::StreamLine;
use roadmill_workers::{NothingShared, WorkerError, WorkerId, build_id, serve};
use std::io;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

/// A worker as a thread of this process, at the far end of a pair of sockets. It cannot be killed: once its
/// stream has ended it ends by itself, when the job that it is at is done.
pub struct WorkerThread(Option<JoinHandle<WorkerError>>);

impl WorkerThread {
    /// A crew of so many threads, each of which does `work` with its name and its end of the stream, until
    /// that says why it ended: usually [`serve_stream`].
    ///
    /// # Errors
    /// When this process cannot say which program it runs.
    pub fn crew(
        size: usize,
        work: impl Fn(WorkerId, UnixStream) -> WorkerError + Send + Sync + 'static,
    ) -> io::Result<StreamCrew> {
        Ok(StreamCrew::new(size, "this program", build_id()?, WorkerThread::starter(work)))
    }

    /// What starts such threads, for a crew in which not all members need be threads.
    pub fn starter(
        work: impl Fn(WorkerId, UnixStream) -> WorkerError + Send + Sync + 'static,
    ) -> impl FnMut(WorkerId) -> io::Result<Started> + 'static {
        let work = Arc::new(work);
        move |id| {
            let (near, far) = UnixStream::pair()?;
            let work = work.clone();
            let thread = Builder::new().name(format!("worker {id}"));
            let thread = thread.spawn(move || work(id, far))?;
            Ok((near, Box::new(WorkerThread(Some(thread)))))
        }
    }
}

impl FarEnd for WorkerThread {
    fn ended(&mut self) -> Ending {
        match self.0.take().map(JoinHandle::join) {
            Some(Ok(error)) => Ending::Left(error.to_string()),
            Some(Err(_)) => Ending::Died("its thread panicked".to_owned()),
            None => Ending::Left("it ended before".to_owned()),
        }
    }

    fn wait(&mut self) {
        // How it ended matters to nobody any more.
        let _ = self.0.take().map(JoinHandle::join);
    }
}

/// Works for the coordinator at the other end of `stream` until that ends it; why the work ended.
pub fn serve_stream(stream: UnixStream) -> WorkerError {
    let open = || {
        let writer = stream.try_clone()?;
        Ok((StreamLine::open(stream, writer)?, build_id()?))
    };
    let (mut line, build) = match open() {
        Ok(opened) => opened,
        Err(error) => return WorkerError::System("cannot open the stream", error),
    };
    match serve(&mut line, &NothingShared, build) {
        Ok(never) => match never {},
        Err(error) => error,
    }
}
