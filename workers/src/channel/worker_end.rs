//! The worker's end.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use iceoryx2::pending_response::PendingResponse;
use iceoryx2::response::Response;

use super::WorkerId;
use super::assembly::Assembly;
use super::bell::{Bell, Note, Rung};
use super::error::ChannelError;
use super::header::{Fault, Header, Kind, Words};
use super::hub::check_length;
use super::private_memory::PrivateMemory;
use super::run_folder::{hub_socket, join, worker_socket};
use super::service::{self, RunNode, RunService, WorkerPort};

/// How long a worker sleeps at most before it asks `keep_waiting`.
const NAP: Duration = Duration::from_secs(1);
/// The same where the hub does not yet know that it sleeps.
const SHORT_NAP: Duration = Duration::from_millis(2);

/// A worker's end of the channel. It belongs to one thread.
pub struct WorkerEnd {
    // dropped in this order: what was sent, the port, its node, the right to be there last
    /// the message whose reply is awaited
    sent: Option<Sent>,
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

/// The last chunk of a message, while its answer is awaited.
struct Sent {
    pending: PendingResponse<PrivateMemory, [u8], Words, [u8], Words>,
    /// whether the hub knows that this end sleeps until the answer comes
    rung: Rung,
    /// whether the hub was told to look
    is_nudged: bool,
}

/// A chunk of the hub, copied out of shared memory only once it is put into its place.
type Answer = Response<PrivateMemory, [u8], Words>;

impl WorkerEnd {
    /// How many workers the hub was made for.
    pub fn workers_max(&self) -> usize {
        service::workers_max(&self.service)
    }

    /// Joins the run in `directory` (see [`Hub::directory`](super::Hub::directory)) as `worker`.
    ///
    /// # Errors
    ///
    /// [`ChannelError::HubGone`] if the run has ended, and whatever files and shared memory may
    /// refuse, for example because more workers are there than the hub was made for.
    pub fn open(directory: &Path, worker: WorkerId) -> Result<WorkerEnd, ChannelError> {
        let membership = join(directory)?;
        let bell = Bell::bind(&worker_socket(directory, worker))?;
        let node = service::open_node(directory, 0)?;
        let (service, port) = service::open_service(&node, worker)?;
        service::reserve_port_memory(directory, &port)?;
        Ok(WorkerEnd {
            sent: None,
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

    /// Sends `message` and sleeps until the whole reply is there.
    ///
    /// # Errors
    ///
    /// Those of [`send`](WorkerEnd::send) and [`receive`](WorkerEnd::receive).
    pub fn call(
        &mut self,
        message: &[u8],
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Vec<u8>, ChannelError> {
        self.send(message, keep_waiting)?;
        self.receive(keep_waiting)
    }

    /// Sends `message`, whose reply is to be received before the next is sent. The hub finds it when it next
    /// looks: when anybody rings, this end by [`nudge`](WorkerEnd::nudge) or [`receive`](WorkerEnd::receive).
    /// Sleeps only between the chunks of a long message, and wakes about once a second to ask `keep_waiting`.
    ///
    /// # Errors
    ///
    /// [`ChannelError::Abandoned`] if `keep_waiting` says false, [`ChannelError::HubGone`],
    /// [`ChannelError::Refused`], [`ChannelError::BrokenReply`], [`ChannelError::TooLarge`]. After
    /// any but the last the link is spoiled.
    pub fn send(
        &mut self,
        message: &[u8],
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<(), ChannelError> {
        check_length(message.len())?;
        let is_out_of_turn = self.sent.is_some();
        if std::mem::replace(&mut self.is_spoiled, true) || is_out_of_turn {
            return Err(ChannelError::Spoiled);
        }
        self.sequence += 1;
        let mut offset = 0;
        loop {
            let (header, chunk) = Header::data(self.worker, self.sequence, message, offset);
            offset += chunk.len();
            if offset == message.len() {
                self.sent = Some(self.submit(&header, chunk)?);
                self.is_spoiled = false;
                return Ok(());
            }
            let answer = self.exchange(&header, chunk, keep_waiting)?;
            let words: Words = *answer.user_header();
            let ack = self.read(&words, Kind::Ack)?;
            super::header::verify(&words, answer.payload()).map_err(ChannelError::BrokenReply)?;
            if (ack.offset, ack.total_bytes) != (offset as u64, message.len() as u64) {
                return Err(ChannelError::BrokenReply(Fault::Turn));
            }
        }
    }

    /// Wakes the hub for the message sent last, if that was not done.
    pub fn nudge(&mut self) {
        if let Some(sent) = self.sent.as_mut().filter(|sent| !sent.is_nudged) {
            sent.is_nudged = true;
            // what could not be rung is when this end sleeps
            let _ = self.bell.ring(&self.hub_socket, Note::Look);
        }
    }

    /// Whether a message was sent whose reply has not been received.
    pub fn is_awaiting(&self) -> bool {
        self.sent.is_some()
    }

    /// Sleeps until the whole reply to the message sent last is there. Wakes about once a second to ask
    /// `keep_waiting`.
    ///
    /// # Errors
    ///
    /// As [`send`](WorkerEnd::send); [`ChannelError::Spoiled`] also if nothing was sent.
    pub fn receive(
        &mut self,
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Vec<u8>, ChannelError> {
        let mut sent = self.take_sent()?;
        let first = match self.look(&sent)? {
            (Some(first), _) => first,
            (None, _) => self.answer(&mut sent, keep_waiting)?,
        };
        let reply = self.pull(first, keep_waiting)?;
        self.is_spoiled = false;
        Ok(reply)
    }

    /// The same, but `None` if nothing of the reply is there yet.
    ///
    /// # Errors
    ///
    /// As [`receive`](WorkerEnd::receive).
    pub fn try_receive(
        &mut self,
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<u8>>, ChannelError> {
        let mut sent = self.take_sent()?;
        let first = match self.look(&sent)? {
            (Some(first), _) => Some(first),
            (None, true) => None,
            // nothing will come any more: this finds out why
            (None, false) => Some(self.answer(&mut sent, keep_waiting)?),
        };
        let reply = match first {
            Some(first) => Some(self.pull(first, keep_waiting)?),
            None => {
                self.sent = Some(sent);
                None
            }
        };
        self.is_spoiled = false;
        Ok(reply)
    }

    fn take_sent(&mut self) -> Result<Sent, ChannelError> {
        self.is_spoiled = true;
        self.sent.take().ok_or(ChannelError::Spoiled)
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
        self.answer(&mut self.submit(header, chunk)?, keep_waiting)
    }

    /// Sends one chunk.
    fn submit(&self, header: &Header, chunk: &[u8]) -> Result<Sent, ChannelError> {
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
        Ok(Sent { pending, rung: Rung::Later, is_nudged: false })
    }

    /// Waits for the chunk that answers another.
    fn answer(
        &self,
        sent: &mut Sent,
        keep_waiting: &mut dyn FnMut() -> bool,
    ) -> Result<Answer, ChannelError> {
        loop {
            if sent.rung == Rung::Later {
                sent.rung =
                    self.bell.ring(&self.hub_socket, Note::Asleep(self.worker, self.sequence));
            }
            match self.look(sent)? {
                (Some(answer), _) => return Ok(answer),
                (None, _) if sent.rung == Rung::Gone => return Err(ChannelError::HubGone),
                (None, false) => return Err(ChannelError::Refused),
                (None, true) => {}
            }
            if !keep_waiting() {
                return Err(ChannelError::Abandoned);
            }
            let nap = if sent.rung == Rung::Later { SHORT_NAP } else { NAP };
            self.bell.wait(nap).map_err(ChannelError::io("could not wait at", &self.hub_socket))?;
        }
    }

    /// The chunk that answers another, if it is there, and whether one may still come.
    fn look(&self, sent: &Sent) -> Result<(Option<Answer>, bool), ChannelError> {
        // asked before the answer is looked for, which may come in between
        let is_connected = sent.pending.is_connected();
        let answer =
            sent.pending.receive().map_err(ChannelError::shared("could not receive a chunk"))?;
        Ok((answer, is_connected))
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
