#!/usr/bin/env bash
# A Slurm of several nodes on one machine, for tests: all of it lies in one folder and listens on loopback only.
#   slurm-up.sh up [NODES [CPUS_PER_NODE]]    then: export SLURM_CONF=$SLURM_TEST_DIR/slurm.conf
#   slurm-up.sh node_down N                   pulls the plug of node N
#   slurm-up.sh node_up N                     plugs it in again
#   slurm-up.sh down
# Needs root and the Debian packages slurm-wlm and munge. SLURM_TEST_DIR is the folder, SLURM_TEST_PORT the first of the ports.
set -euo pipefail
dir=${SLURM_TEST_DIR:?a folder for the files of Slurm}
port=${SLURM_TEST_PORT:-27100}
host=$(hostname -s)

# A node is a slurmd with a host name, processes and a /dev/shm of its own; the disk is shared. To kill the first process of
# its namespace is to pull its plug: everything in it dies at once, and it says nothing to anyone.
node_up() {
    mkdir -p "$dir/spool/n$1"
    # What the node starts with may not hold the caller's lock or pipe open.
    SLURM_CONF="$dir/slurm.conf" unshare --uts --ipc --mount --pid --fork --kill-child --mount-proc \
        sh -c "echo n$1 > /proc/sys/kernel/hostname; mount -t tmpfs -o size=512m tmpfs /dev/shm; mount --bind $dir/hosts /etc/hosts
               exec slurmd -D -N n$1" > "$dir/log/n$1.out" 2>&1 < /dev/null &
    echo $! > "$dir/run/node-$1.pid"
}

node_down() {
    kill -KILL "$(cat "$dir/run/node-$1.pid")"
}

down() {
    for file in "$dir"/run/node-*.pid; do
        if [ -s "$file" ]; then kill -KILL "$(cat "$file")" 2>/dev/null || true; fi
    done
    for file in "$dir"/run/{slurmctld,munged}.pid; do
        if [ -s "$file" ]; then kill "$(cat "$file")" 2>/dev/null || true; fi
    done
}

up() {
    local nodes=${1:-4} cpus=${2:-2}
    local last=$((nodes - 1))
    mkdir -p "$dir"/{run,state,log,spool}
    chmod 755 "$dir" "$dir/run"
    # --force: munged expects folders that only its own user can write to, all the way up.
    head -c 128 /dev/urandom > "$dir/munge.key"
    chmod 600 "$dir/munge.key"
    munged --force --key-file="$dir/munge.key" --socket="$dir/run/munge.socket" \
        --pid-file="$dir/run/munged.pid" --log-file="$dir/log/munged.log" --seed-file="$dir/munge.seed"
    { echo 127.0.0.1 localhost "$host"; for node in $(seq 0 "$last"); do echo 127.0.0.1 "n$node"; done; } > "$dir/hosts"
    # A node that says nothing for SlurmdTimeout seconds is taken for dead. Jobs of the partition `urgent` preempt those of `test`.
    cat > "$dir/slurm.conf" <<CONF
ClusterName=roadmill
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/run/munge.socket
CredType=cred/munge
SlurmctldPort=$port
SlurmctldPidFile=$dir/run/slurmctld.pid
SlurmdPidFile=$dir/run/slurmd-%n.pid
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=sched_min_interval=0,bf_interval=1,batch_sched_delay=0,requeue_setup_env_fail
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
ReturnToService=2
SlurmdTimeout=5
InactiveLimit=0
KillWait=5
MinJobAge=300
PropagateResourceLimits=NONE
SlurmdParameters=config_overrides
NodeName=n[0-$last] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + nodes))] CPUs=$cpus RealMemory=1000 State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO PriorityTier=1
PartitionName=urgent Nodes=ALL MaxTime=INFINITE State=UP OverSubscribe=NO PriorityTier=2 PreemptMode=OFF
CONF
    export SLURM_CONF="$dir/slurm.conf"
    slurmctld -c
    for node in $(seq 0 "$last"); do
        node_up "$node"
    done
    for _ in $(seq 100); do
        if [ "$(sinfo -h -p test -t idle -o %D 2>/dev/null)" = "$nodes" ]; then return 0; fi
        sleep 0.2
    done
    echo "Slurm's nodes do not come up; its logs are in $dir/log" >&2
    return 1
}

command=${1:?up, down, node_down or node_up}
shift
case $command in
up | down | node_up | node_down) "$command" "$@" ;;
*) echo "unknown command $command" >&2; exit 2 ;;
esac
