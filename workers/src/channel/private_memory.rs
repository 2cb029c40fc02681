//! The kind of iceoryx2 service that keeps all its shared memory in the folder that it is given.
//!
//! The library's own kind for processes, [`iceoryx2::service::ipc`], puts memory into `/dev/shm` itself, under names
//! that every user can see and can create first, and makes one of its files writable for everybody. This kind differs
//! from it only in where memory is: in files below the root folder of the configuration, which for a run is a folder
//! in `/dev/shm` that nobody else may enter.

use core::fmt::Debug;

use iceoryx2::unique_id_generator::unique_system_id::UniqueSystemId;
use iceoryx2_bb_elementary_traits::testing::abandonable::Abandonable;
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
use iceoryx2_cal::shm_allocator::bump_allocator::BumpAllocator;
use iceoryx2_cal::shm_allocator::pool_allocator::PoolAllocator;
use iceoryx2_cal::{
    arc_sync_policy, bag, dynamic_storage, event, hash, monitoring, reactor,
    resizable_shared_memory, serialize, shared_memory, static_storage, zero_copy_connection,
};

/// Services between processes, in files of one folder.
#[derive(Debug, Clone)]
pub struct PrivateMemory {}

impl iceoryx2::service::Service for PrivateMemory {
    type StaticStorage = static_storage::recommended::Ipc;
    type ConfigSerializer = serialize::recommended::Recommended;
    type PersistentDynamicStorage<T: Debug + Send + Sync + ZeroCopySend + 'static> =
        dynamic_storage::file::Storage<T>;
    type Bag = bag::recommended::Recommended;
    type DynamicStorage<T: Debug + Send + Sync + ZeroCopySend + 'static> =
        dynamic_storage::file::Storage<T>;
    type ServiceNameHasher = hash::recommended::Recommended;
    type SharedMemory = shared_memory::file::Memory<PoolAllocator>;
    type ResizableSharedMemory = resizable_shared_memory::dynamic::DynamicMemory<
        PoolAllocator,
        shared_memory::file::Memory<PoolAllocator>,
    >;
    type Connection = zero_copy_connection::file::Connection;
    // Only services of another pattern, events, would make use of it.
    type Event = event::recommended::Ipc;
    type Monitoring = monitoring::recommended::Ipc;
    type Reactor = reactor::recommended::Ipc;
    type ArcThreadSafetyPolicy<T: Send + Debug + Abandonable> =
        arc_sync_policy::single_threaded::SingleThreaded<T>;
    type BlackboardMgmt<KeyType: Send + Sync + Debug + ZeroCopySend + 'static> =
        dynamic_storage::file::Storage<KeyType>;
    type BlackboardPayload = shared_memory::file::Memory<BumpAllocator>;
    type UniqueId = UniqueSystemId;
}

impl iceoryx2::service::internal::ServiceInternal<PrivateMemory> for PrivateMemory {}
