#!/usr/bin/env bash
# Agents over ssh, whose server has its own port, keys and settings and greets whoever logs in. Whatever happens to
# connections and agents, the ledger is that of a build in threads, and nothing is left of an agent.
#   ssh.sh ROADMILL [SECONDS]     ROADMILL: the program; SECONDS: for how long an agent is stopped, 60 by default
# Needs root, and the Debian packages openssh-server, openssh-client and iproute2.
set -euo pipefail
# Processes, network and shared memory of its own: whatever is found there belongs to this test.
if [ "${1:-}" != --inside ]; then
    exec unshare --pid --fork --kill-child --mount-proc --ipc --net --mount "$0" --inside "$@"
fi
shift
mount -t tmpfs -o size=512m tmpfs /dev/shm
ip link set lo up
here=$(dirname "$(realpath "$0")")
root=$(realpath "$here/../..")
. "$here/sshd.sh"
program=$(realpath "${1:?the program}")
stopped=${2:-60}
begun=$SECONDS
say() { printf '%4d s  %s\n' $((SECONDS - begun)) "$*"; }
fail() { echo "ssh: $*" >&2; tail -n 30 ./*.txt >&2; exit 1; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
sshd_up 127.0.0.1
# The default of --agent-command, with the settings of this test and the path of the program.
command="ssh -F $scratch/ssh_config -T -o BatchMode=yes {} $program agent"

{ sed '/^\[query\]/,$d' "$root/problems/walls.toml"; printf '[limits]\nnodes = 40000\n'; } > problem.toml
"$program" build problem.toml --threads 2 --out reference > reference.txt 2>&1
full=$(stat -c %s reference/ledger)
say "threads: $(grep '^digest' reference.txt)"
ls -A /dev/shm > shm.before

begin() {
    "$program" build problem.toml --out run --agents first,second --workers 1 --agent-command "$command" > build.txt 2>&1 &
    build=$!
}
# Waits until the run's ledger has so many hundredths of its bytes.
past() {
    for _ in $(seq 6000); do
        if [ "$(stat -c %s run/ledger 2>/dev/null || echo 0)" -ge $((full * $1 / 100)) ]; then return 0; fi
        kill -0 "$build" 2>/dev/null || fail "the build ended before $1 %"
        sleep 0.02
    done
    fail "the build does not come to $1 %"
}
# The ssh that the coordinator has started for a place.
carrier_of() { pgrep -P "$build" -f "BatchMode=yes $1 "; }
agents() { pgrep -f "^$program agent" || true; }
# All processes of the program, workers among them.
processes() {
    for process in /proc/[0-9]*; do
        if [ "$(readlink "$process/exe")" = "$program" ]; then echo "${process#/proc/}"; fi
    done
}
# Waits for the end, which has to be what it is without trouble; $2: how often agents had to be started again.
same() {
    wait "$build" || fail "$1: exit code $?"
    cmp reference/ledger run/ledger || fail "$1: another ledger"
    restarts=$(python3 -c 'import json; print(sum(m["restarts"] for m in json.load(open("run/summary.json"))["machines"]))')
    [ "$restarts" -ge "$2" ] || fail "$1: agents were started again $restarts times, $2 expected"
    say "$1: the same ledger; agents started again: $restarts"
    rm -rf run
}
# Nothing is left: no process, no shared memory, no file.
nothing_left() {
    for _ in $(seq 100); do [ -z "$(processes)" ] && break; sleep 0.1; done
    [ -z "$(processes)" ] || fail "processes are left: $(ps -fp "$(processes | paste -sd,)")"
    ls -A /dev/shm | diff shm.before - || fail "shared memory is left"
    [ -z "$(ls -A tmp)" ] || fail "files are left: $(find tmp)"
    say "nothing is left of the agents"
}

begin
same "greeted by a banner and by a shell" 0
nothing_left

begin
past 10
kill -KILL "$(carrier_of first)"
past 30
kill -TERM "$(carrier_of second)"
same "connections cut" 2
nothing_left

begin
past 10
kill -KILL "$(agents | head -1)"
past 30
# An agent that is to make room for another program hands back what it has.
kill -TERM "$(agents | head -1)"
same "an agent killed, and one told to end" 2
grep -q 'leaves: a signal came' build.txt || fail "the agent did not say that it leaves"
nothing_left

begin
past 10
kill -KILL "$build"
wait "$build" 2>/dev/null || true
nothing_left
"$program" resume run > resume.txt 2>&1
cmp reference/ledger run/ledger || fail "a resumed build has another ledger"
say "the coordinator killed: its agents end, and the resumed build has the same ledger"
rm -rf run

begin
past 10
agent=$(agents | head -1)
kill -STOP "$agent"
at=$SECONDS
same "an agent stopped" 1
grep -q 'it was silent for 30 s' build.txt || fail "the agent was not missed"
while [ $((SECONDS - at)) -lt "$stopped" ]; do sleep 0.1; done
kill -CONT "$agent" 2>/dev/null || true
nothing_left

say "all is well"
