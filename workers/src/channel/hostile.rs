//! Tests: a worker that does not keep to the protocol, next to one that does.

use std::time::Duration;

use proptest::prelude::*;

use super::header::{Fault, Header, Kind, Words};
use super::private_memory::PrivateMemory;
use super::service::{RunNode, RunService, WorkerPort, open_node, open_service};
use super::{CHUNK_BYTES, Hub, Received, WorkerId};

const HOSTILE: WorkerId = WorkerId(66);

/// The library's own port, with nothing of a link around it.
struct Raw {
    port: WorkerPort,
    _service: RunService,
    _node: RunNode,
}

type Pending = iceoryx2::pending_response::PendingResponse<PrivateMemory, [u8], Words, [u8], Words>;

impl Raw {
    fn open(hub: &Hub, worker: WorkerId) -> Raw {
        let node = open_node(hub.directory(), 0).expect("the node opens");
        let (service, port) = open_service(&node, worker).expect("the port opens");
        Raw { port, _service: service, _node: node }
    }

    fn send(&self, words: Words, chunk: &[u8]) -> Pending {
        let mut request = self.port.loan_slice_uninit(chunk.len()).expect("there are chunks");
        *request.user_header_mut() = words;
        let request = request.write_from_slice(chunk);
        request.send().expect("the hub is there")
    }

    fn send_message(&self, worker: WorkerId, sequence: u64, message: &[u8]) -> Pending {
        let (header, chunk) = Header::data(worker, sequence, message, 0);
        self.send(header.encode(chunk), chunk)
    }
}

fn receive(hub: &mut Hub) -> Option<Received> {
    hub.receive().expect("the hub can receive")
}

fn broken(reason: Fault) -> Option<Received> {
    Some(Received::Broken { worker: HOSTILE, reason })
}

/// What the hub says to one chunk of a fresh hostile worker.
fn said_to(words: Words, chunk: &[u8]) -> Option<Received> {
    let mut hub = Hub::create(2).expect("the hub opens");
    let raw = Raw::open(&hub, HOSTILE);
    let pending = raw.send(words, chunk);
    let received = receive(&mut hub);
    if matches!(received, Some(Received::Broken { .. })) {
        assert!(!pending.is_connected(), "the worker is not told");
        drop(pending);
        let _ignored = raw.send_message(HOSTILE, 1, &[1]);
        assert_eq!(receive(&mut hub), None);
    }
    received
}

#[test]
fn each_kind_of_nonsense_is_named() {
    let message = vec![1; CHUNK_BYTES + 1];
    let (good, chunk) = Header::data(HOSTILE, 1, &message, 0);
    let mut flipped = good.encode(chunk);
    flipped[7] ^= 1;
    let other_worker = Header { worker: WorkerId(1), ..good };
    let second = Header { sequence: 2, ..good };
    let go_on = Header::go_on(Kind::Continue, HOSTILE, 1, 9, 4).encode(&[]);
    let ack = Header::go_on(Kind::Ack, HOSTILE, 1, 9, 4).encode(&[]);
    assert_eq!(said_to([0; 8], &[]), broken(Fault::Magic));
    assert_eq!(said_to(flipped, chunk), broken(Fault::Checksum));
    assert_eq!(said_to(good.encode(chunk), &[1]), broken(Fault::Bounds));
    assert_eq!(said_to(other_worker.encode(chunk), chunk), broken(Fault::Worker));
    assert_eq!(said_to(second.encode(chunk), chunk), broken(Fault::Turn));
    assert_eq!(said_to(go_on, &[]), broken(Fault::Turn));
    assert_eq!(said_to(ack, &[]), broken(Fault::Turn));
    assert_eq!(said_to(good.encode(chunk), chunk), None);
}

#[test]
fn a_second_message_before_the_reply_breaks_only_its_sender() {
    let mut hub = Hub::create(2).expect("the hub opens");
    let hostile = Raw::open(&hub, HOSTILE);
    let honest = Raw::open(&hub, WorkerId(1));
    let _first = hostile.send_message(HOSTILE, 1, &[1]);
    assert!(matches!(receive(&mut hub), Some(Received::Message { .. })));
    let _second = hostile.send_message(HOSTILE, 2, &[2]);
    assert_eq!(receive(&mut hub), broken(Fault::Turn));
    let pending = honest.send_message(WorkerId(1), 1, &[3]);
    assert_eq!(
        receive(&mut hub),
        Some(Received::Message { worker: WorkerId(1), message: vec![3] })
    );
    let _ = hub.reply(WorkerId(1), vec![4]).expect("the hub can reply");
    let answer = pending.receive().expect("the port works");
    assert_eq!(answer.expect("the reply is there").payload(), [4]);
}

#[test]
fn many_broken_workers_leave_no_connection_behind() {
    let mut hub = Hub::create(1).expect("the hub opens");
    for id in 0..40 {
        let raw = Raw::open(&hub, WorkerId(id));
        let _pending = raw.send([id; 8], &[1, 2, 3]);
        if id % 2 == 0 {
            assert!(matches!(receive(&mut hub), Some(Received::Broken { .. })));
        }
        drop((_pending, raw));
        hub.forget(WorkerId(id));
        std::thread::sleep(Duration::from_micros(id));
    }
    assert_eq!(receive(&mut hub), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_bytes_never_harm_the_hub(words: Words, has_magic: bool, chunk: Vec<u8>) {
        let mut words = words;
        if has_magic {
            words[0] = Header::go_on(Kind::Continue, HOSTILE, 1, 2, 1).encode(&[])[0];
            words[1] = HOSTILE.0;
        }
        let is_broken = matches!(said_to(words, &chunk), Some(Received::Broken { .. }));
        prop_assert!(is_broken);
    }
}
