use super::*;
use proptest::prelude::*;
use roadmill_workers::message::MESSAGE_BYTES_MAX;
use std::collections::VecDeque;
use std::sync::Arc;

/// A pipe that holds so many bytes.
struct Pipe {
    bytes: VecDeque<u8>,
    holds: usize,
}

impl Pipe {
    fn new(holds: usize) -> Pipe {
        Pipe { bytes: VecDeque::new(), holds }
    }

    /// Writes as much as there is room for, but no more than this.
    fn fill(&mut self, from: &mut Link, most: usize) -> usize {
        let room = self.holds - self.bytes.len();
        let output = from.output();
        let written = output.len().min(room).min(most);
        self.bytes.extend(&output[..written]);
        from.written(written);
        written
    }

    /// Reads no more than this.
    fn drain(&mut self, into: &mut Link, most: usize) -> Result<usize, LinkError> {
        let read = self.bytes.len().min(most);
        let bytes: Vec<u8> = self.bytes.drain(..read).collect();
        into.take_in(&bytes, 0).map(|()| read)
    }
}

/// Moves bytes between two ends, in steps of these lengths, until nothing moves any more. What the ends take they take at
/// once where `takes`, and otherwise only when nothing else moves.
fn talk(ends: [&mut Link; 2], holds: usize, steps: &[usize], takes: bool) -> [Vec<Vec<u8>>; 2] {
    let [near, far] = ends;
    let (mut there, mut back) = (Pipe::new(holds), Pipe::new(holds));
    let mut heard = [Vec::new(), Vec::new()];
    let mut steps = steps.iter().copied().cycle();
    loop {
        let mut step = || steps.next().expect("there is a step");
        let mut moved = there.fill(near, step()) + back.fill(far, step());
        moved += there.drain(far, step()).expect("it is a link");
        moved += back.drain(near, step()).expect("it is a link");
        if takes || moved == 0 {
            let before = heard[0].len() + heard[1].len();
            heard[0].extend(std::iter::from_fn(|| near.receive()));
            heard[1].extend(std::iter::from_fn(|| far.receive()));
            if moved == 0 && heard[0].len() + heard[1].len() == before {
                return heard;
            }
        }
    }
}

fn message(length: usize, fill: u8) -> Arc<Vec<u8>> {
    Arc::new((0..length).map(|at| fill.wrapping_add(at as u8)).collect())
}

proptest! {
    /// However long the messages, however little the pipes hold, whoever takes what has come when: all of them come, in
    /// order, and nobody waits for ever. Pipes of a few bytes are full at both ends most of the time.
    #[test]
    fn messages_come_whole_both_ways(
        there in proptest::collection::vec(0usize..400_000, 0..5),
        back in proptest::collection::vec(0usize..400_000, 0..5),
        holds in 1usize..70_000,
        steps in proptest::collection::vec(1usize..70_000, 1..20),
        takes in any::<bool>(),
    ) {
        let (mut near, mut far) = (Link::near(7), Link::far());
        // The coordinator speaks first: only then does an agent know which conversation it is.
        near.send(message(1, 42));
        // Nobody would answer it before the link is open.
        near.beat(5);
        for (number, length) in there.iter().enumerate() {
            near.send(message(*length, number as u8));
        }
        for (number, length) in back.iter().enumerate() {
            far.send(message(*length, 100 + number as u8));
        }
        let steps: Vec<usize> = steps.iter().map(|step| (*step).max(holds / 50)).collect();
        let [heard_near, heard_far] = talk([&mut near, &mut far], holds.max(500), &steps, takes);
        let sent = |lengths: &[usize], fill: u8| -> Vec<Vec<u8>> {
            lengths.iter().enumerate().map(|(n, length)| message(*length, fill + n as u8).to_vec()).collect()
        };
        prop_assert_eq!(&*heard_far[0], &[42][..]);
        prop_assert!(heard_far[1..] == sent(&there, 0));
        prop_assert!(heard_near == sent(&back, 100));
        prop_assert_eq!((near.queued(), far.queued()), (0, 0));
        prop_assert_eq!(near.round_trip(), None);
        near.beat(5);
        near.beat(6);
        talk([&mut near, &mut far], 500, &[100], true);
        prop_assert_eq!(near.round_trip(), Some(0));
    }

    /// Whatever comes instead of a link: an error or nothing, and never more memory than came.
    #[test]
    fn rubbish_is_refused(
        bytes in proptest::collection::vec(any::<u8>(), 0..5000),
        is_open in any::<bool>(),
    ) {
        let mut link = Link::near(7);
        if is_open {
            link.take_in(OPENING, 0).expect("it is the opening");
        }
        let taken = link.take_in(&bytes, 0);
        prop_assert!(link.receive().is_none());
        prop_assert!(!is_open || bytes.len() < HEADER_BYTES || taken.is_err());
    }

    /// One byte that is flipped: an error, a frame of another conversation, or nothing yet.
    #[test]
    fn damage_is_noticed(at: prop::sample::Index, flip in 1u8.., length in 0usize..300) {
        let mut far = Link::far();
        let mut bytes = OPENING.to_vec();
        let body = message(length, 9);
        let begin = bytes.len();
        let frame = Frame { kind: Kind::Last, session: 7, number: 0, bytes: &body };
        frame.write(&mut bytes);
        let at = begin + at.index(bytes.len() - begin);
        bytes[at] ^= flip;
        bytes.resize(bytes.len() + 70_000, 0);
        prop_assert!(far.take_in(&bytes, 0).is_err());
        prop_assert!(far.receive().is_none());
    }
}

/// The far end of a link that is open, after it has heard these frames.
fn after(frames: &[Frame<'_>]) -> (Link, Result<(), LinkError>) {
    let mut bytes = OPENING.to_vec();
    frames.iter().for_each(|frame| frame.write(&mut bytes));
    let mut link = Link::near(7);
    let taken = link.take_in(&bytes, 0);
    (link, taken)
}

fn last(session: u64, number: u64, bytes: &[u8]) -> Frame<'_> {
    Frame { kind: Kind::Last, session, number, bytes }
}

#[test]
fn frames_that_come_again_end_the_link_and_those_of_others_are_dropped() {
    let (mut link, taken) = after(&[last(7, 0, b"one"), last(6, 0, b"old"), last(7, 1, b"two")]);
    assert_eq!((taken, link.stale()), (Ok(()), 1));
    assert_eq!(
        [link.receive(), link.receive(), link.receive()],
        [Some(b"one".to_vec()), Some(b"two".to_vec()), None]
    );
    let (_, taken) = after(&[last(7, 0, b"one"), last(7, 0, b"one")]);
    assert_eq!(taken, Err(FrameError::Number { found: 0, expected: 1 }.into()));
    let (_, taken) = after(&[last(7, 1, b"two")]);
    assert_eq!(taken, Err(FrameError::Number { found: 1, expected: 0 }.into()));
}

#[test]
fn what_is_said_before_the_opening_is_skipped_and_remembered() {
    let mut link = Link::near(7);
    link.take_in(b"Welcome to node1!\r\nlast login: never\n", 0).expect("anybody may say so");
    assert_eq!((link.is_open(), &*link.last_words()), (false, "last login: never"));
    let mut rest = OPENING.to_vec();
    last(7, 0, b"hello").write(&mut rest);
    // In pieces, none of which has the opening whole.
    for piece in rest.chunks(5) {
        link.take_in(piece, 0).expect("it is a link");
    }
    assert!(link.is_open());
    assert_eq!(link.receive().as_deref(), Some(&b"hello"[..]));
    let mut link = Link::near(7);
    let noise = [b'x'; 4096];
    let refused = (0..).find_map(|_| link.take_in(&noise, 0).err());
    assert!(matches!(refused, Some(LinkError::NotOpened(words)) if words.starts_with("xxx")));
}

#[test]
fn nobody_sends_more_than_there_is_credit_for() {
    let piece = vec![1; PIECE_BYTES];
    // The first message is taken by nobody, so that everything behind it waits.
    let many = WINDOW_BYTES as usize / PIECE_BYTES + 2;
    let frames: Vec<_> = (0..many as u64).map(|number| last(7, number, &piece)).collect();
    assert_eq!(after(&frames).1, Err(LinkError::Credit));
    let credit = 1u64.to_le_bytes();
    let taken = Frame { kind: Kind::Credit, session: 7, number: 0, bytes: &credit };
    assert_eq!(after(&[taken]).1, Err(LinkError::Taken(1, 0)));
    // An end that keeps to the rules stops by itself.
    let (mut near, mut far) = (Link::near(7), Link::far());
    near.send(message(3 * WINDOW_BYTES as usize, 0));
    near.send(message(10, 0));
    near.send(message(3 * WINDOW_BYTES as usize, 0));
    let (mut there, mut back) = (Pipe::new(1 << 16), Pipe::new(1 << 16));
    let mut moved = 1;
    while moved > 0 {
        moved = there.fill(&mut near, usize::MAX) + back.fill(&mut far, usize::MAX);
        moved += there.drain(&mut far, usize::MAX).expect("it is a link");
        moved += back.drain(&mut near, usize::MAX).expect("it is a link");
    }
    // The first, which nobody has taken, and a window behind it.
    let (came, _) = far.bytes();
    assert!((3 * WINDOW_BYTES..5 * WINDOW_BYTES).contains(&came), "{came} bytes have come");
}

#[test]
fn a_sign_of_life_waits_behind_one_frame_at_most() {
    let mut link = Link::near(7);
    link.take_in(OPENING, 0).expect("it is the opening");
    link.send(message(1 << 20, 0));
    let opening = link.output().len();
    link.written(opening);
    let first = link.output().len();
    assert_eq!(first, 64 << 10);
    link.beat(1);
    link.written(first);
    let (frame, _) = Frame::read(link.output()).expect("it is a frame").expect("it is whole");
    assert_eq!(frame.kind, Kind::Beat);
}

/// Whoever sends signs of life without reading the answers does not make the other end remember them all.
#[test]
fn only_the_last_sign_of_life_is_answered() {
    let beats: Vec<_> = (0..1000u64).map(|number| (number, number.to_le_bytes())).collect();
    let frame = |(number, bytes): &'static (u64, [u8; 8])| Frame {
        kind: Kind::Beat,
        session: 7,
        number: *number,
        bytes,
    };
    let (mut link, taken) = after(&beats.leak().iter().map(frame).collect::<Vec<_>>());
    assert_eq!(taken, Ok(()));
    let opening = link.output().len();
    link.written(opening);
    let (answer, _) = Frame::read(link.output()).expect("it is a frame").expect("it is whole");
    assert_eq!((answer.kind, answer.value()), (Kind::Echo, Ok(999)));
    let all = link.output().len();
    link.written(all);
    assert_eq!(link.output(), b"");
}

#[test]
fn the_end_comes_behind_all_messages() {
    let (mut near, mut far) = (Link::near(7), Link::far());
    near.send(message(200_000, 0));
    near.end();
    near.beat(0);
    let heard = talk([&mut near, &mut far], 4096, &[1000], true);
    assert_eq!(heard[1].len(), 1);
    assert!(far.has_ended() && !near.has_ended());
}

#[test]
fn frames_are_no_longer_than_they_may_be() {
    let good = |kind| {
        let mut bytes = Vec::new();
        Frame { kind, session: 0, number: 0, bytes: b"12345678" }.write(&mut bytes);
        bytes
    };
    let with = |at: usize, value: u8| {
        let mut bytes = good(Kind::Last);
        bytes[at] = value;
        Frame::read(&bytes).map(|found| found.is_some())
    };
    assert_eq!(with(0, b'x'), Err(FrameError::Magic(*b"xml1")));
    assert_eq!(with(4, 9), Err(FrameError::Kind(9)));
    assert_eq!(with(6, 1), Err(FrameError::Kind(2)));
    assert_eq!(with(26, 1), Err(FrameError::TooLong(8 | 1 << 16)));
    assert_eq!(with(30, 1), Err(FrameError::TooLong(8)));
    assert_eq!(with(45, 0), Err(FrameError::Checksum));
    assert_eq!(
        Frame::read(&good(Kind::Beat)).unwrap().unwrap().0.value(),
        Ok(u64::from_le_bytes(*b"12345678"))
    );
    const { assert!(MESSAGE_BYTES_MAX > WINDOW_BYTES, "a long message needs credit while it comes") };
}
