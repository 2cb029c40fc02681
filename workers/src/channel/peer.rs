//! The hub's side of the conversation with one worker.

use std::sync::Arc;

use super::WorkerId;
use super::assembly::Assembly;
use super::header::{Fault, Header, Kind, Words};
use super::service::Question;

/// How far the conversation with a worker has come.
pub(super) struct Peer {
    worker: WorkerId,
    /// sequence number of the last message begun
    sequence: u64,
    /// that of the message for whose answer the worker has said it sleeps
    asleep: u64,
    stage: Stage,
}

enum Stage {
    /// It owes the next message.
    Idle,
    /// It is sending a message.
    Sending(Assembly),
    /// It waits for the answer to its message.
    Waiting(Question),
    /// It is pulling an answer, and has been given so many bytes of it.
    Pulling(Arc<Vec<u8>>, usize),
}

/// What came of a chunk.
pub(super) enum Step {
    /// The conversation goes on; the worker has to be woken.
    Answered,
    /// A whole message has come.
    Complete(Vec<u8>),
}

impl Peer {
    /// A worker that has not said anything.
    pub fn new(worker: WorkerId) -> Peer {
        Peer { worker, sequence: 0, asleep: 0, stage: Stage::Idle }
    }

    /// Takes a chunk from this worker. After a fault the peer is not to be used any more.
    pub fn take(&mut self, question: Question) -> Result<Step, Fault> {
        let words: Words = *question.user_header();
        let header = Header::decode(&words)?;
        if header.worker != self.worker {
            return Err(Fault::Worker);
        }
        match header.kind {
            Kind::Data => self.take_data(&header, &words, question),
            Kind::Continue => self.take_continue(&header, &words, question),
            Kind::Ack => Err(Fault::Turn),
        }
    }

    fn take_data(
        &mut self,
        header: &Header,
        words: &Words,
        question: Question,
    ) -> Result<Step, Fault> {
        let mut assembly = match std::mem::replace(&mut self.stage, Stage::Idle) {
            Stage::Idle if header.sequence == self.sequence.wrapping_add(1) => {
                self.sequence = header.sequence;
                Assembly::new(header)
            }
            Stage::Sending(assembly) => assembly,
            _ => return Err(Fault::Turn),
        };
        assembly.push(header, words, question.payload())?;
        if assembly.is_complete() {
            self.stage = Stage::Waiting(question);
            return Ok(Step::Complete(assembly.into_bytes()));
        }
        let ack = Header::go_on(
            Kind::Ack,
            self.worker,
            self.sequence,
            header.total_bytes,
            assembly.len(),
        );
        answer(&question, &ack, &[])?;
        self.stage = Stage::Sending(assembly);
        Ok(Step::Answered)
    }

    fn take_continue(
        &mut self,
        header: &Header,
        words: &Words,
        question: Question,
    ) -> Result<Step, Fault> {
        super::header::verify(words, question.payload())?;
        match std::mem::replace(&mut self.stage, Stage::Idle) {
            Stage::Pulling(message, given)
                if header.sequence == self.sequence
                    && header.offset == given as u64
                    && header.total_bytes == message.len() as u64 =>
            {
                self.give(&question, message, given)?;
                Ok(Step::Answered)
            }
            _ => Err(Fault::Turn),
        }
    }

    /// Answers the message that waits; whether the worker has to be woken. `Ok(None)` if none waits.
    pub fn reply(&mut self, message: Arc<Vec<u8>>) -> Result<Option<bool>, Fault> {
        match std::mem::replace(&mut self.stage, Stage::Idle) {
            Stage::Waiting(question) => {
                self.give(&question, message, 0)?;
                Ok(Some(self.asleep == self.sequence))
            }
            other => {
                self.stage = other;
                Ok(None)
            }
        }
    }

    /// The worker says that it sleeps until this message is answered; whether it is, so that the worker
    /// has to be woken. To be told after all chunks that came before.
    pub fn sleeps(&mut self, sequence: u64) -> bool {
        self.asleep = sequence;
        sequence == self.sequence && matches!(self.stage, Stage::Idle | Stage::Pulling(..))
    }

    fn give(
        &mut self,
        question: &Question,
        message: Arc<Vec<u8>>,
        offset: usize,
    ) -> Result<(), Fault> {
        let (header, chunk) = Header::data(self.worker, self.sequence, &message, offset);
        answer(question, &header, chunk)?;
        let given = offset + chunk.len();
        if given < message.len() {
            self.stage = Stage::Pulling(message, given);
        }
        Ok(())
    }
}

fn answer(question: &Question, header: &Header, chunk: &[u8]) -> Result<(), Fault> {
    let mut response = question.loan_slice_uninit(chunk.len()).map_err(|_| Fault::Undeliverable)?;
    *response.user_header_mut() = header.encode(chunk);
    response.write_from_slice(chunk).send().map_err(|_| Fault::Undeliverable)
}
