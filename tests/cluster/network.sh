#!/usr/bin/env bash
# Agents over ssh along a slow link: two hosts that are network namespaces, and between them 100 Mbit/s, 20 ms each way and,
# the second time, a loss of 1 %. The digest is that of a build in threads; an agent that comes late is not lost while it is told
# what there is.
#   network.sh ROADMILL           ROADMILL: the program
#   network.sh ROADMILL RUN       measures how long an agent takes to be told all of RUN, a copy of which goes on
# LINK: other options of link.py for the measurement; CONGESTION: the kernel's congestion control, bbr, say. Needs root, the Debian packages openssh-server, openssh-client, iproute2 and
# python3, and a kernel with TUN.
set -euo pipefail
if [ "${1:-}" != --inside ]; then
    exec unshare --pid --fork --kill-child --mount-proc --ipc --net --mount "$0" --inside "$@"
fi
shift
here=$(dirname "$(realpath "$0")")
root=$(realpath "$here/../..")
. "$here/sshd.sh"
program=$(realpath "${1:?the program}")
run=${2:+$(realpath "$2")}
begun=$SECONDS
say() { printf '%4d s  %s\n' $((SECONDS - begun)) "$*"; }
fail() { echo "network: $*" >&2; tail -n 30 ./*.txt >&2; exit 1; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mount -t tmpfs -o size=2g tmpfs /dev/shm
mkdir -p /run/netns
mount -t tmpfs tmpfs /run/netns
ip netns add near
ip netns add far
near() { ip netns exec near "$@"; }
if [ -n "${CONGESTION:-}" ]; then
    for host in near far; do
        ip netns exec "$host" sh -c "echo $CONGESTION > /proc/sys/net/ipv4/tcp_congestion_control"
    done
fi
link_up() {
    nice -n -10 python3 "$here/link.py" near 10.0.0.1 far 10.0.0.2 "$@" > link.txt &
    link=$!
    for _ in $(seq 100); do grep -q ready link.txt && return 0; sleep 0.1; done
    fail "no link"
}
link_down() { kill "$link"; wait "$link" || true; say "the link: $(grep packets link.txt | paste -sd';')"; }
wide_open=(--rate 100 --delay 20)
link_up "${wide_open[@]}"
# Only the server is in the far namespace: what it starts is, too.
export -f sshd_up
ip netns exec far bash -c 'sshd_up 10.0.0.2'
ssh=(ssh -F "$scratch/ssh_config" -T -o BatchMode=yes)
command="${ssh[*]} {} $program agent"
# So much goes through ssh itself to the far host, in MB/s.
carried() {
    python3 - "${ssh[@]}" far 'cat > /dev/null' <<'PY'
import subprocess, sys, time
with subprocess.Popen(sys.argv[1:], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as ssh:
    ssh.stdout.readline()  # the greeting: the login is over
    begin = time.monotonic()
    ssh.stdin.write(bytes(40_000_000))
    ssh.stdin.close()
    ssh.wait()
print(f"{40 / (time.monotonic() - begin):.1f}")
PY
}
export -f carried
machines() { python3 -c 'import json, sys; print(*(m[sys.argv[2]] for m in json.load(open(sys.argv[1]))["machines"]))' "$1" "$2"; }

if [ -n "$run" ]; then
    link_down
    # shellcheck disable=SC2086
    link_up ${LINK:-"${wide_open[@]}"}
    say "ssh alone carries $(near bash -c "$(declare -p ssh); carried") MB/s"
    cp -r "$run" run
    nodes=$("$program" status run --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["nodes"])')
    near "$program" resume run --max-nodes $((nodes + 1000)) --agents far --workers 1 --agent-command "$command" > resume.txt 2>&1 &
    build=$!
    ready=
    while kill -0 "$build" 2>/dev/null; do
        if [ -s run/machines.json ]; then
            read -r state done sent < <(python3 -c 'import json
machine = json.load(open("run/machines.json"))["machines"][0]
print(machine["state"], machine["done"], machine["bytes_sent"])' 2>/dev/null || echo "? 0 0")
            now=$(date +%s.%N)
            if [ "$state" = ready ] && [ -z "$ready" ]; then ready=$now before=$sent; fi
            if [ "$done" != 0 ]; then break; fi
        fi
        sleep 0.1
    done
    [ -n "$ready" ] || fail "no agent came"
    say "$(python3 -c "seconds = $now - $ready; sent = ($sent - $before) / 1e6
print(f'{sent:.1f} MB in {seconds:.1f} s until the first job was done: {sent / seconds:.1f} MB/s')")"
    wait "$build" || fail "exit code $?"
    grep '^machine' resume.txt
    [ "$(machines run/summary.json restarts)" = 0 ] || fail "the agent was lost"
    link_down
    exit 0
fi

{ sed '/^\[query\]/,$d' "$root/problems/walls.toml"; printf '[limits]\nnodes = 20000\n'; } > problem.toml
"$program" build problem.toml --threads 2 --out reference > reference.txt 2>&1
full=$(stat -c %s reference/ledger)
say "threads: $(grep '^digest' reference.txt)"
cat > start.sh <<SH
#!/bin/sh
# The agent at the place "late" is started when a quarter of the ledger is written.
while [ "\$1" = late ] && [ "\$(stat -c %s "$scratch/run/ledger" 2>/dev/null || echo 0)" -lt $((full / 4)) ]; do sleep 0.1; done
exec ${ssh[*]} "\$1" $program agent
SH
chmod +x start.sh
for loss in 0 1; do
    link_down
    link_up "${wide_open[@]}" --loss "$loss"
    near "$program" build problem.toml --out run --agents far,late --workers 1 --agent-command "$scratch/start.sh {}" > build.txt 2>&1 ||
        fail "exit code $?"
    cmp reference/ledger run/ledger || fail "another ledger"
    [ "$(machines run/summary.json restarts)" = "0 0" ] || fail "an agent was lost"
    read -r _ late < <(machines run/summary.json done)
    [ "$late" -gt 0 ] || fail "the agent that came late did nothing"
    say "20 ms, 100 Mbit/s, $loss % loss: the same ledger; there and back in $(machines run/summary.json round_trip_seconds) s"
    rm -rf run
done
link_down
say "all is well"
