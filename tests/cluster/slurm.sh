#!/usr/bin/env bash
# The recipes of docs/cluster.md, as they stand there, under a Slurm of six nodes on this machine. Whatever ends jobs, steps and
# nodes, the digest is that of a build in threads.
#   slurm.sh ROADMILL                          ROADMILL: the program; needs root, slurm-wlm, munge, iproute2
set -euo pipefail
# Processes and network of its own: other Slurms on this machine use the same ports, and nothing outlives this test.
if [ "${1:-}" != --inside ]; then
    exec unshare --pid --fork --kill-child --mount-proc --net --mount "$0" --inside "$@"
fi
shift
ip link set lo up
# Where the only address is 127.0.0.1 the system's resolver takes it for no network at all.
ip addr add 10.0.0.1/32 dev lo
here=$(dirname "$(realpath "$0")")
root=$(realpath "$here/../..")
PATH=$(dirname "$(realpath "${1:?the program}")"):$PATH
export PATH
begun=$SECONDS
say() { printf '%4d s  %s\n' $((SECONDS - begun)) "$*"; }
fail() { echo "slurm: $*" >&2; show_logs >&2; exit 1; }
show_logs() { tail -n 30 slurm-*.out "$SLURM_TEST_DIR/log/slurmctld.log" 2>/dev/null || true; }
# Calls a function, in a folder of its own with the recipes, and at the same time as others.
tracks=()
track() {
    (mkdir "$1" && cp ./*.sh "$1" && cd "$1" && "$1") &
    tracks+=($!)
}

scratch=$(mktemp -d)
export SLURM_TEST_DIR=$scratch/slurm SLURM_CONF=$scratch/slurm/slurm.conf
slurm() { "$here/slurm-up.sh" "$@"; }
cleanup() {
    slurm down
    # Nodes that were killed hold their mounts until all their processes are gone.
    for _ in $(seq 50); do rm -rf "$scratch" 2>/dev/null && return; sleep 0.1; done
}
trap cleanup EXIT
slurm up 6 16
say "Slurm $(sinfo --version | cut -d' ' -f2) is up with six nodes"
mkdir "$scratch/work"
cd "$scratch/work"

# The recipes, each in a file that has the name of its job.
awk '/^```sh$/ { getline; if ($0 == "#!/bin/bash") { reading = 1; text = "" } }
     /^```$/ { if (reading) printf "%s", text > (name ".sh"); reading = 0 }
     reading { text = text $0 "\n"; if (match($0, /--job-name=/)) name = substr($0, RSTART + RLENGTH) }' "$root/docs/cluster.md"
import=$(sed -n "s/.*--or-resume \(--import '[^']*'\).*/\1/p" "$root/docs/cluster.md" | head -1)
sed "s|--or-resume|--or-resume $import|" walls.sh > walls-import.sh

# Builds without criteria end at their limit of nodes, with success. By that many nodes a problem is named.
for nodes in 20000 40000; do
    { sed '/^\[query\]/,$d' "$root/problems/walls.toml"; printf '[limits]\nnodes = %s\n' "$nodes"; } > "$nodes.toml"
    cp "$nodes.toml" problem.toml
    roadmill build problem.toml --threads 2 --out "threads-$nodes" > "threads-$nodes.txt" 2>&1
    say "threads, $nodes nodes: $(grep '^digest' "threads-$nodes.txt")"
done
# Makes one of them the problem of the recipes.
use() {
    reference=$(realpath "../threads-$1")
    full=$(stat -c %s "$reference/ledger")
    cp "../$1.toml" problem.toml
}

# Lets a requeued job begin at once instead of two minutes later. Not within the second in which it was requeued: a node's slurmd tells
# credentials of before from later ones by whole seconds, and refuses the new one ("Job credential revoked"), which fails the job.
begin() {
    sleep 2.1
    scontrol update jobid="$1" StartTime=now 2>/dev/null || true
}
# Waits until a job has ended with success.
ended() {
    local state
    for _ in $(seq 1200); do
        state=$(squeue -h -a -t all -j "$1" -o '%T %r' | sort -u)
        case $state in
        *BeginTime*) begin "$1" ;;
        COMPLETED*) return 0 ;;
        FAILED* | CANCELLED* | TIMEOUT* | NODE_FAIL*) fail "job $1: $state" ;;
        esac
        sleep 0.1
    done
    fail "job $1 does not end: $state"
}
# Waits until a job runs and its ledger has so many hundredths of its bytes.
past() {
    for _ in $(seq 1200); do
        case $(squeue -h -j "$1" -o '%T %r') in
        *BeginTime*) begin "$1" ;;
        RUNNING*)
            if [ "$(stat -c %s runs/walls/ledger 2>/dev/null || echo 0)" -ge $((full * $2 / 100)) ]; then
                return 0
            fi
            ;;
        esac
        sleep 0.1
    done
    fail "job $1 does not come to $2 %"
}
# Waits until a job is no longer in the queue, however it ends.
gone() {
    for _ in $(seq 1200); do
        [ -z "$(squeue -h -j "$1" -o %T 2>/dev/null)" ] && return 0
        sleep 0.1
    done
    fail "job $1 stays in the queue"
}
# Pulls a node's plug and lets Slurm know, as its administrator may. By itself Slurm finds out after 5 to 40 seconds, and a job whose
# coordinator goes on with the machine that is left may have ended by then.
lose() {
    slurm node_down "${1#n}"
    scontrol update nodename="$1" state=down reason="its plug is pulled"
}
# Plugs the node in again.
find_again() {
    slurm node_up "${1#n}"
    for _ in $(seq 50); do
        scontrol update nodename="$1" state=resume 2>/dev/null && return 0
        sleep 0.1
    done
    # Slurm resumes by itself a node that it took for dead and that answers again.
    return 0
}
restarts() { scontrol show job "$1" | sed -n 's/.*Restarts=\([0-9]*\).*/\1/p'; }
# How often agents were started again, by the last part of a build.
agent_restarts() {
    python3 -c 'import json; print(sum(m["restarts"] for m in json.load(open("runs/walls/summary.json"))["machines"]))'
}
# The run has the reference's roadmap.
same() {
    roadmill diff "$reference" runs/walls > diff.txt || fail "$1: another roadmap: $(cat diff.txt)"
    say "$1: the same digest"
    rm -rf runs
}
# The run has the reference's ledger: nobody was told to stop, so that nothing is written down of what happened.
same_bytes() {
    cmp "$reference/ledger" runs/walls/ledger || fail "$1: another ledger"
    same "$1"
}

one_node() {
    use 40000
    # A build that does not end: a job on another node sees that whoever holds the run is alive.
    sed -i 's/^nodes = .*/nodes = 4000000000/' problem.toml
    job=$(sbatch --parsable walls.sh)
    past "$job" 1
    other=$(sbatch --parsable walls.sh)
    gone "$other"
    [[ $(scontrol show job "$other") == *ExitCode=2:0* ]] || fail "a second job on one run was not refused"
    scancel "$job"
    gone "$job"
    say "a second job on one run: refused"
    rm -rf runs

    use 40000
    job=$(sbatch --parsable walls.sh)
    past "$job" 10
    # What Slurm does before the time limit.
    scancel --signal=TERM "$job.0"
    ended "$job"
    [ "$(restarts "$job")" = 1 ] || fail "the script did not put itself back into the queue"
    same "one node, signalled as before the time limit, requeued"

    job=$(sbatch --parsable walls.sh)
    past "$job" 10
    node=$(squeue -h -j "$job" -o %N)
    slurm node_down "${node#n}"
    ended "$job"
    same_bytes "one node, and its plug pulled"
    slurm node_up "${node#n}"
}

array() {
    use 40000
    sets=$(sbatch --parsable walls-sets.sh)
    job=$(sbatch --parsable --dependency=afterok:"$sets" walls-import.sh)
    ended "$job"
    same_bytes "an array and its import, $(find parts -name '*.sets' | wc -l) files"

    # A build that ends at a limit without success, exit code 3, is a failure to Slurm: what is to follow success does not.
    cp "$root/problems/sealed.toml" problem.toml
    job=$(sbatch --parsable walls.sh)
    after=$(sbatch --parsable --dependency=afterok:"$job" --output=/dev/null --wrap=true)
    whatever=$(sbatch --parsable --dependency=afterany:"$job" --output=/dev/null --wrap=true)
    ended "$whatever"
    [[ $(scontrol show job "$job") == *ExitCode=3:0* ]] || fail "a sealed room was not left with exit code 3"
    [[ $(squeue -h -j "$after" -o %r) == DependencyNeverSatisfied ]] || fail "afterok does not mind exit code 3"
    scancel "$after"
    say "exit code 3: afterok does not follow, afterany does"
}

# Starts the recipe with agents, on two nodes.
agents() {
    use 20000
    job=$(sbatch --parsable --nodes=2 "$@" walls-agents.sh)
}
# The nodes of a job: the first has the coordinator, and each an agent.
nodes_of() { scontrol show hostnames "$(squeue -h -j "$1" -o %N)"; }
# The last step of a job that runs on this node: its agent.
agent_of() { squeue -h -s -j "$1" -o '%i %N' | awk -v node="$2" '$2 == node && $1 !~ /batch/ { step = $1 } END { print step }'; }

agents_lost() {
    agents
    past "$job" 10
    mapfile -t nodes < <(nodes_of "$job")
    # scancel may say of a step that it cannot be signalled, and signals it.
    scancel "$(agent_of "$job" "${nodes[0]}")" 2>/dev/null || true
    past "$job" 30
    scancel --signal=TERM "$(agent_of "$job" "${nodes[1]}")" 2>/dev/null || true
    ended "$job"
    [ "$(agent_restarts)" -ge 2 ] || fail "agents were ended, but not started again"
    same_bytes "agents, one's step cancelled, the other's signalled"

    # Told not to, Slurm does not end a job that loses a node.
    agents --no-kill
    past "$job" 10
    mapfile -t nodes < <(nodes_of "$job")
    slurm node_down "${nodes[1]#n}"
    past "$job" 40
    slurm node_up "${nodes[1]#n}"
    ended "$job"
    [ "$(restarts "$job")" = 0 ] || fail "the job was begun anew"
    same_bytes "agents, and a node's plug pulled of a job that goes on"
}

agents_preempted() {
    agents
    for share in 10 20 30; do
        past "$job" "$share"
        urgent=$(sbatch --parsable --partition=urgent --nodes=2 --nodelist="$(squeue -h -j "$job" -o %N)" --ntasks-per-node=1 \
            --cpus-per-task=16 --output=/dev/null --wrap=true)
        ended "$urgent"
    done
    ended "$job"
    [ "$(restarts "$job")" = 3 ] || fail "preempted $(restarts "$job") times, 3 expected"
    same "agents, preempted three times"

    agents
    past "$job" 10
    node=$(nodes_of "$job" | tail -1)
    lose "$node"
    ended "$job"
    find_again "$node"
    [ "$(restarts "$job")" = 1 ] || fail "the job was not begun anew"
    same "agents, and a node's plug pulled"
}

coordinator_lost() {
    agents
    past "$job" 10
    node=$(nodes_of "$job" | head -1)
    slurm node_down "${node#n}"
    ended "$job"
    slurm node_up "${node#n}"
    same_bytes "agents, and the coordinator's plug pulled"
}

track one_node
track coordinator_lost
track agents_lost
track agents_preempted
track array
failed=0
for pid in "${tracks[@]}"; do wait "$pid" || failed=1; done
[ "$failed" = 0 ] || exit 1
say "all is well"
