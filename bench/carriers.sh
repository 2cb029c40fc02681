#!/usr/bin/env bash
# How long cores of agents wait in each round, by what carries the agents' streams: a plain pipe, ssh on this machine, srun of a
# Slurm on this machine, and ssh along a link of 100 Mbit/s and 20 ms each way. Two agents of one worker each build roadmaps of
# problems/walls.toml; only sizes of sets and rounds differ.
#   bench/carriers.sh ROADMILL [CARRIER…]      carriers: pipe ssh srun link; all by default
# The work is the CPU time of the same build in one thread. What cores wait is told by the agents' machines in summary.json.
# Needs root and what tests/cluster/run.sh installs.
set -euo pipefail
if [ "${1:-}" != --inside ]; then
    exec unshare --pid --fork --kill-child --mount-proc --ipc --net --mount "$0" --inside "$@"
fi
shift
root=$(realpath "$(dirname "$0")/..")
tests=$root/tests/cluster
. "$tests/sshd.sh"
program=$(realpath "${1:?the program}")
shift
[ $# -gt 0 ] || set -- pipe ssh srun link
scratch=$(mktemp -d)
# A Slurm that is told to end still writes for a moment.
trap 'rm -rf "$scratch" 2>/dev/null || { sleep 1; rm -rf "$scratch"; }' EXIT
cd "$scratch"
mount -t tmpfs -o size=1g tmpfs /dev/shm
mkdir -p /run/netns
mount -t tmpfs tmpfs /run/netns
ip link set lo up
ip addr add 10.0.1.1/32 dev lo

# Nodes of a set, sets of a round, nodes of the roadmap.
sizes=("50 5 10000" "50 40 20000" "500 8 24000" "50 400 60000")
for size in "${sizes[@]}"; do
    read -r nodes sets limit <<< "$size"
    { printf '[img]\nsets_per_round = %s\n' "$sets"
      sed '/^\[query\]/,$d' "$root/problems/walls.toml"
      printf '[[strategies]]\nlabel = "uniform"\nnodes = %s\nsampler = { uniform = {} }\n[limits]\nnodes = %s\n' "$nodes" "$limit"
    } > "$nodes-$sets.toml"
    "$program" build "$nodes-$sets.toml" --threads 1 --out "threads-$nodes-$sets" > /dev/null 2>&1
done

pipe() { build "$program agent"; }
ssh() {
    (mkdir -p near-server && cd near-server && sshd_up 127.0.0.1)
    build "ssh -F $scratch/near-server/ssh_config -T -o BatchMode=yes {} $program agent"
}
srun() {
    export SLURM_TEST_DIR=$scratch/slurm SLURM_CONF=$scratch/slurm/slurm.conf
    "$tests/slurm-up.sh" up 2 2
    # The coordinator is outside of the allocation, which needs no batch script then.
    salloc --quiet --nodes=2 --ntasks-per-node=1 --cpus-per-task=2 bash -c "$(declare -p sizes program); $(declare -f build table)
        build 'srun --overlap --nodes=1 --ntasks=1 --cpus-per-task=2 --nodelist={} $program agent' n0,n1"
    "$tests/slurm-up.sh" down
}
link() {
    ip netns add near
    ip netns add far
    nice -n -10 python3 "$tests/link.py" near 10.0.0.1 far 10.0.0.2 --rate 100 --delay 20 > link.txt &
    local link=$!
    until grep -q ready link.txt; do sleep 0.1; done
    mkdir far-server
    export -f sshd_up
    ip netns exec far bash -c 'cd far-server && sshd_up 10.0.0.2'
    ip netns exec near bash -c "$(declare -p sizes program); $(declare -f build table)
        build 'ssh -F $scratch/far-server/ssh_config -T -o BatchMode=yes {} $program agent'"
    kill "$link"
}

# build COMMAND [NAMES]: builds all sizes with agents that are started so, and prints a line for each.
build() {
    local size nodes sets limit
    for size in "${sizes[@]}"; do
        read -r nodes sets limit <<< "$size"
        rm -rf run
        "$program" build "$nodes-$sets.toml" --out run --agents "${2:-first,second}" --workers 1 --agent-command "$1" > build.txt 2>&1
        cmp "threads-$nodes-$sets/ledger" run/ledger
        table "threads-$nodes-$sets/summary.json" run/summary.json "$nodes" "$sets"
    done
}
table() {
    python3 - "$@" <<'PY'
import json, sys
threads, agents = (json.load(open(name)) for name in sys.argv[1:3])
nodes, sets = map(int, sys.argv[3:])
machines = agents["machines"]
rounds = agents["sets"] / sets
work = threads["cpu_seconds"] / 2
waiting = sum(machine["waiting_seconds"] for machine in machines) / 2
trips = ["%.1f" % (1e3 * (machine["round_trip_seconds"] or 0)) for machine in machines]
print(f"| {nodes} | {sets} | {1e3 * 2 * work / agents['sets']:.1f} ms | {1e3 * work / rounds:.0f} ms | {1e3 * waiting / rounds:.0f} ms "
      f"| {work / (work + waiting):.2f} | {', '.join(trips)} ms |", flush=True)
PY
}

echo "| nodes of a set | sets of a round | work of a set | work of a core and round | waiting of a core and round | share of work | there and back at last |"
echo "|---|---|---|---|---|---|---|"
for carrier; do
    echo "| **$carrier** |"
    "$carrier"
done
