#!/usr/bin/env bash
# What docs/cluster.md says, tried under a real Slurm and a real sshd on this machine.
#   run.sh ROADMILL               ROADMILL: the program
# Installs the Debian packages that are missing. What cannot be tried here is skipped, with a message.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
program=$(realpath "${1:?the program}")

skip() { echo "cluster: $1: nothing is tried"; exit 0; }
[ "$(id -u)" = 0 ] || skip "not root, who alone can start machines on this machine"
unshare --uts --ipc --mount --pid --net --fork --mount-proc true 2>/dev/null || skip "no namespaces can be made"

# have PROGRAM PACKAGE…: whether there is such a program, once these packages are installed.
have() {
    local path=$PATH:/usr/sbin
    PATH=$path command -v "$1" >/dev/null && return 0
    { apt-get update -qq && apt-get install -y -qq --no-install-recommends "${@:2}"; } >/dev/null 2>&1 || true
    PATH=$path command -v "$1" >/dev/null && return 0
    echo "cluster: no $1, and the packages ${*:2} cannot be installed: not tried"
    return 1
}

if have ip iproute2 && have sshd openssh-server && have ssh openssh-client; then
    echo "-- ssh"
    "$here/ssh.sh" "$program"
    if have python3 python3 && [ -c /dev/net/tun ]; then
        echo "-- ssh along a slow link"
        "$here/network.sh" "$program"
    else
        echo "cluster: no /dev/net/tun: no slow link can be made"
    fi
fi
if have ip iproute2 && have slurmctld slurm-wlm munge && have slurmd slurm-wlm && have munged munge; then
    echo "-- Slurm"
    "$here/slurm.sh" "$program"
fi
