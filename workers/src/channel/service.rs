//! The iceoryx2 side: configuration, the one service, and the size of its memory.

use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::time::Duration;

use iceoryx2::active_request::ActiveRequest;
use iceoryx2::node::NodeView as _;
use iceoryx2::port::client::Client;
use iceoryx2::port::port_name::PortName;
use iceoryx2::port::server::Server;
use iceoryx2::prelude::*;
use iceoryx2::service::builder::request_response::Builder;
use iceoryx2::service::port_factory::PortFactory as _;
use iceoryx2::service::port_factory::request_response::PortFactory;

use super::error::ChannelError;
use super::header::Words;
use super::private_memory::PrivateMemory;
use super::run_folder::memory_folder;
use super::shared_files::{self, SHARED_MEMORY_FOLDER};
use super::{CHUNK_BYTES, WorkerId};

// the hub is one thread, and so is a worker's conversation
type Ipc = PrivateMemory;

pub(super) type RunNode = Node<Ipc>;
pub(super) type RunService = PortFactory<Ipc, [u8], Words, [u8], Words>;
pub(super) type HubPort = Server<Ipc, [u8], Words, [u8], Words>;
pub(super) type WorkerPort = Client<Ipc, [u8], Words, [u8], Words>;
/// A chunk that came and can be answered once. Dropping it unanswered tells the worker so.
pub(super) type Question = ActiveRequest<Ipc, [u8], Words, [u8], Words>;
type ServiceBuilder = Builder<[u8], Words, [u8], Words, Ipc>;

const SERVICE_NAME: &str = "roadmill";
/// What the names of the library's files begin with.
const PREFIX: &str = "roadmill_";
/// one with the hub, one being written, and one the hub has not yet given back
const REQUEST_CHUNKS: usize = 3;
/// connections of dead workers with chunks that nobody has taken out: the hub looks for them when it forgets
const ABANDONED_CONNECTIONS: usize = 64;
/// Another hub of the same process may be cleaning up, and the library allows one at a time.
const CLEANUP_PATIENCE: Duration = Duration::from_millis(200);
/// management files, and rounding up to pages
const OVERHEAD_BYTES_PER_WORKER: u64 = 64 << 10;
const OVERHEAD_BYTES: u64 = 1 << 20;

/// Workers that may be there at a time, with those that have died and are not yet forgotten.
fn clients_max(workers_max: usize) -> usize {
    2 * workers_max + 8
}

/// Chunks of the hub's: an answer for each worker, and two at hand.
fn response_chunks(workers_max: usize) -> usize {
    clients_max(workers_max) + 2
}

/// How many workers a service was made for.
pub(super) fn workers_max(service: &RunService) -> usize {
    service.static_config().max_clients().saturating_sub(8) / 2
}

/// Opens a node whose files and shared memory are in the memory folder of the run in `folder`, which must be private.
/// Hub and links derive the same configuration from the folder, so that nothing has to be stored, no global
/// configuration is touched, and several hubs can live in one process. `workers_max` matters to a hub.
pub(super) fn open_node(folder: &Path, workers_max: usize) -> Result<RunNode, ChannelError> {
    // the library tells about things it then copes with; failures come back as errors anyway
    set_log_level(LogLevel::Fatal);
    let unusable =
        || ChannelError::Unsafe { path: folder.into(), reason: "it is not the folder of a run" };
    let memory = memory_folder(folder).ok_or_else(unusable)?;
    shared_files::check_folder(&memory)?;
    let root = iceoryx2::prelude::Path::new(memory.as_os_str().as_bytes());
    let mut config = Config::default();
    config.global.prefix = FileName::new(PREFIX.as_bytes()).map_err(|_| unusable())?;
    config.global.set_root_path(&root.map_err(|_| unusable())?);
    // only the hub cleans up: a worker that is stopped while cleaning would make the hub wait
    config.global.node.cleanup_dead_nodes_on_creation = false;
    config.global.node.cleanup_dead_nodes_on_destruction = false;
    config.global.service.cleanup_dead_nodes_on_open = false;
    // connections of dead workers whose chunks the hub still holds: beyond, the library panics, and each
    // takes memory and time from the start
    config.defaults.request_response.server_expired_connection_buffer =
        clients_max(workers_max) + ABANDONED_CONNECTIONS;
    NodeBuilder::new()
        .config(&config)
        .signal_handling_mode(SignalHandlingMode::Disabled)
        .create::<Ipc>()
        .map_err(ChannelError::shared("could not create a node"))
}

/// Creates the run's service and the hub's port on it.
pub(super) fn create_service(
    node: &RunNode,
    workers_max: usize,
) -> Result<(RunService, HubPort), ChannelError> {
    let clients_max = clients_max(workers_max);
    let service = builder(node)?
        .max_servers(1)
        .max_clients(clients_max)
        .max_nodes(clients_max + 1)
        // with 1, a chunk that the hub is about to give back makes the next loan fail
        .max_active_requests_per_client(2)
        .max_loaned_requests(1)
        .max_response_buffer_size(2)
        .max_borrowed_responses_per_pending_response(1)
        .enable_safe_overflow_for_requests(false)
        .enable_safe_overflow_for_responses(false)
        .enable_fire_and_forget_requests(false)
        .create()
        .map_err(ChannelError::shared("could not create the service"))?;
    let port = service
        .server_builder()
        .initial_max_slice_len(CHUNK_BYTES)
        .allocation_strategy(AllocationStrategy::Static)
        // a worker has one answer at most, and gives it back before it asks again
        .override_response_preallocation(move |_| response_chunks(workers_max))
        .max_loaned_responses_per_request(2)
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .create()
        .map_err(ChannelError::shared("could not create the hub's port"))?;
    Ok((service, port))
}

/// Opens the run's service and a worker's port on it, which bears the worker's name.
pub(super) fn open_service(
    node: &RunNode,
    worker: WorkerId,
) -> Result<(RunService, WorkerPort), ChannelError> {
    let service =
        builder(node)?.open().map_err(ChannelError::shared("could not open the service"))?;
    let name = PortName::new(&worker.to_string())
        .map_err(ChannelError::shared("could not name the worker's port"))?;
    let port = service
        .client_builder()
        .name(&name)
        .initial_max_slice_len(CHUNK_BYTES)
        .allocation_strategy(AllocationStrategy::Static)
        .override_request_preallocation(|_| REQUEST_CHUNKS)
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .create()
        .map_err(ChannelError::shared("could not create the worker's port"))?;
    Ok((service, port))
}

fn builder(node: &RunNode) -> Result<ServiceBuilder, ChannelError> {
    let name = ServiceName::new(SERVICE_NAME)
        .map_err(ChannelError::shared("could not name the service"))?;
    Ok(node
        .service_builder(&name)
        .request_response::<[u8], [u8]>()
        .request_user_header::<Words>()
        .response_user_header::<Words>())
}

/// The worker whose port has the library's number `client`, if that port is still there.
pub(super) fn worker_of(service: &RunService, client: u128) -> Option<WorkerId> {
    let mut worker = None;
    service.dynamic_config().list_clients(|details| {
        if details.client_id.value() != client {
            return CallbackProgression::Continue;
        }
        worker = details.client_name.as_str().parse().ok().map(WorkerId);
        CallbackProgression::Stop
    });
    worker
}

/// Cleans up after the workers of the run in `folder` that have died. What fails now is left
/// until the run ends.
pub(super) fn clean_up_dead_nodes(node: &RunNode, folder: &Path) {
    let mut dead = Vec::new();
    let _ = RunNode::list(node.config(), |state| {
        match state {
            // without its details the library would look for a node's files in the wrong place
            NodeState::Dead(view) if view.details().is_some() => dead.push(view),
            _ => {}
        }
        CallbackProgression::Continue
    });
    let Some(memory) = memory_folder(folder) else {
        return;
    };
    // only now: all files of those that are found dead are there. `Node::blocking_cleanup_dead_nodes`
    // would also meet the files of a worker that dies after this.
    if dead.is_empty() || shared_files::lengthen_empty(&memory).is_err() {
        return;
    }
    for view in dead {
        let _ = view.blocking_remove_stale_resources(CLEANUP_PATIENCE);
    }
}

/// Makes the files private that the hub of the run in `folder` has made, and takes all memory that they may need.
pub(super) fn secure_hub_memory(folder: &Path) -> Result<(), ChannelError> {
    let Some(memory) = memory_folder(folder) else {
        return Ok(());
    };
    shared_files::protect(&memory)?;
    shared_files::reserve(&memory, |_| true)
}

/// Keeps the library's descriptors of the run in `folder` from programs that this process starts.
pub(super) fn close_on_exec(folder: &Path) {
    if let Some(memory) = memory_folder(folder) {
        shared_files::close_on_exec(&memory);
    }
}

/// Takes all memory that a worker's port may need: its own, and that of its connections to the hub.
pub(super) fn reserve_port_memory(folder: &Path, port: &WorkerPort) -> Result<(), ChannelError> {
    let Some(memory) = memory_folder(folder) else {
        return Ok(());
    };
    // The library names these files by the number of the port.
    let number = port.id().value().to_string();
    shared_files::reserve(&memory, |name| name.contains(&number))
}

/// Refuses to start where the memory is too short for the channel, before anything is made of it.
pub(super) fn check_free_space(workers_max: usize) -> Result<(), ChannelError> {
    let needed_bytes = needed_bytes(workers_max);
    let free_bytes =
        free_bytes().map_err(ChannelError::io("could not inspect", SHARED_MEMORY_FOLDER))?;
    if free_bytes < needed_bytes {
        return Err(ChannelError::NoSpace {
            path: SHARED_MEMORY_FOLDER.into(),
            free_bytes,
            needed_bytes,
            workers_max,
        });
    }
    Ok(())
}

/// Shared memory that the channel takes.
fn needed_bytes(workers_max: usize) -> u64 {
    let hub = response_chunks(workers_max) as u64 * CHUNK_BYTES as u64;
    OVERHEAD_BYTES + hub + workers_bytes(workers_max)
}

/// Of it, what is taken only as workers come: everybody else has to leave it free.
pub(super) fn workers_bytes(workers_max: usize) -> u64 {
    let per_worker = REQUEST_CHUNKS as u64 * CHUNK_BYTES as u64 + OVERHEAD_BYTES_PER_WORKER;
    workers_max as u64 * per_worker
}

/// Shared memory that nobody has taken.
pub(super) fn free_bytes() -> std::io::Result<u64> {
    let space = rustix::fs::statvfs(SHARED_MEMORY_FOLDER)?;
    Ok(space.f_bavail.saturating_mul(space.f_frsize))
}
