//! The worker's end.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::WorkerId;
use super::assembly::Assembly;
use super::bell::{Bell, Rung};
use super::error::ChannelError;
use super::header::{Fault, Header, Kind, Words};
use super::hub::check_length;
use super::run_folder::{hub_socket, join, worker_socket};
use super::service::{self, RunNode, RunService, WorkerPort};

/// How long a worker sleeps at most before it asks `keep_waiting`.
const NAP: Duration = Duration::from_secs(1);

/// A worker's end of the channel. It belongs to one thread.
pub struct Link {
    // dropped in this order: the port before its node, the right to be there last
    port: WorkerPort,
    service: RunService,
    _node: RunNode,
    bell: Bell,
    hub_socket: PathBuf,
    _membership: File,
    worker: WorkerId,
    sequence: u64,
    is_spoiled: bool,
}

/// A chunk of the hub, copied out of shared memory only once it is put into its place.
type Answer = iceoryx2::response::Response<iceoryx2::service::ipc::Service, [u8], Words>;

impl Link {
    /// Joins the run in `directory` (see [`Hub::directory`](super::Hub::directory)) as `worker`.
    ///
    /// # Errors
    ///
    /// [`ChannelError::HubGone`] if the run has ended, and whatever files and shared memory may
    /// refuse, for example because more workers are there than the hub was made for.
    pub fn open(directory: &Path, worker: WorkerId) -> Result<Link, ChannelError> {
        let membership = join(directory)?;
        let bell = Bell::bind(&worker_socket(directory, worker))?;
        let node = service::open_node(directory)?;
        let (service, port) = service::open_service(&node, worker)?;
        Ok(Link {
            port,
            service,
            _node: node,
            bell,
            hub_socket: hub_socket(directory),
            _membership: membership,
            worker,
            sequence: 0,
            is_spoiled: false,
        })
    }

    /// How many workers the hub was made for.
    pub fn workers_max(&self) -> usize {
        service::workers_max(&self.service)
    }

    /// Sends `message` and sleeps until the whole reply is there. Wakes about once a second to ask
    /// `keep_waiting`.
    ///
    /// # Errors
    ///
    /// [`ChannelError::Abandoned`] if `keep_waiting` says false, [`ChannelError::HubGone`],
    /// [`ChannelError::Refused`], [`ChannelError::BrokenReply`], [`ChannelError::TooLarge`]. After
    /// any but the last the link is spoiled.
    pub fn call(
        &mut self,
        message: &[u8],
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Vec<u8>, ChannelError> {
        check_length(message.len())?;
        if std::mem::replace(&mut self.is_spoiled, true) {
            return Err(ChannelError::Spoiled);
        }
        self.sequence += 1;
        let first = self.send(message, keep_waiting)?;
        let reply = self.pull(first, keep_waiting)?;
        self.is_spoiled = false;
        Ok(reply)
    }

    /// Sends all chunks; the answer to the last is the first chunk of the reply.
    fn send(
        &mut self,
        message: &[u8],
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Answer, ChannelError> {
        let mut offset = 0;
        loop {
            let (header, chunk) = Header::data(self.worker, self.sequence, message, offset);
            let answer = self.exchange(&header, chunk, keep_waiting)?;
            offset += chunk.len();
            if offset == message.len() {
                return Ok(answer);
            }
            let words: Words = *answer.user_header();
            let ack = self.read(&words, Kind::Ack)?;
            super::header::verify(&words, answer.payload()).map_err(ChannelError::BrokenReply)?;
            if (ack.offset, ack.total_bytes) != (offset as u64, message.len() as u64) {
                return Err(ChannelError::BrokenReply(Fault::Turn));
            }
        }
    }

    /// Asks for the rest of a reply until it is complete.
    fn pull(
        &mut self,
        first: Answer,
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Vec<u8>, ChannelError> {
        let mut answer = first;
        let mut words: Words = *answer.user_header();
        let mut header = self.read(&words, Kind::Data)?;
        let mut assembly = Assembly::new(&header);
        loop {
            assembly.push(&header, &words, answer.payload()).map_err(ChannelError::BrokenReply)?;
            if assembly.is_complete() {
                return Ok(assembly.into_bytes());
            }
            let go_on = Header::go_on(
                Kind::Continue,
                self.worker,
                self.sequence,
                header.total_bytes,
                assembly.len(),
            );
            // the chunk goes back to the hub before the next is asked for: it has only so many
            drop(answer);
            answer = self.exchange(&go_on, &[], keep_waiting)?;
            words = *answer.user_header();
            header = self.read(&words, Kind::Data)?;
        }
    }

    /// Sends one chunk and waits for the one that answers it.
    fn exchange(
        &self,
        header: &Header,
        chunk: &[u8],
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Answer, ChannelError> {
        let mut request = self
            .port
            .loan_slice_uninit(chunk.len())
            .map_err(ChannelError::shared("could not get a chunk"))?;
        *request.user_header_mut() = header.encode(chunk);
        let pending = request
            .write_from_slice(chunk)
            .send()
            .map_err(ChannelError::shared("could not send a chunk"))?;
        if pending.number_of_server_connections() == 0 {
            return Err(ChannelError::HubGone);
        }
        let mut rung = Rung::Later;
        loop {
            if rung == Rung::Later {
                rung = self.bell.ring(&self.hub_socket);
            }
            // asked before the answer is looked for, which may come in between
            let is_connected = pending.is_connected();
            let answer =
                pending.receive().map_err(ChannelError::shared("could not receive a chunk"))?;
            match answer {
                Some(answer) => return Ok(answer),
                None if rung == Rung::Gone => return Err(ChannelError::HubGone),
                None if !is_connected => return Err(ChannelError::Refused),
                None => {}
            }
            if !keep_waiting() {
                return Err(ChannelError::Abandoned);
            }
            self.bell.wait(NAP).map_err(ChannelError::io("could not wait at", &self.hub_socket))?;
        }
    }

    fn read(&self, words: &Words, kind: Kind) -> Result<Header, ChannelError> {
        let header = Header::decode(words).map_err(ChannelError::BrokenReply)?;
        let fault = if header.worker != self.worker {
            Fault::Worker
        } else if header.kind != kind || header.sequence != self.sequence {
            Fault::Turn
        } else {
            return Ok(header);
        };
        Err(ChannelError::BrokenReply(fault))
    }
}
