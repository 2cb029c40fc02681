#!/usr/bin/env bash
# One roadmap from an x86-64 agent and an aarch64 agent, the latter under qemu's emulation of a single program.
#   mixed.sh ROADMILL AARCH64_ROADMILL QEMU_AARCH64 [PROBLEM [MAX_NODES]]
# Both programs must be of the same sources: agents of other sources are refused. To cross-build one under Debian:
#   apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross; rustup target add aarch64-unknown-linux-gnu
#   CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
#       cargo build --release --target aarch64-unknown-linux-gnu -p roadmill-coordinator
# QEMU_AARCH64 is a static qemu-aarch64; versions from 11 on are known to do (7.2 loses the program's own name). Its registration
# with the kernel is in a namespace of this script, needs Linux 6.7, and is gone with the script. Not part of `.ci/run`: the second build takes minutes.
set -euo pipefail
if [ "${MIXED:-}" != inside ]; then
    exec env MIXED=inside unshare --user --map-root-user --mount --pid --fork --mount-proc bash "$(realpath "$0")" "$@"
fi
here=$(dirname "$(realpath "$0")")
export X86=$(realpath "$1") ARM=$(realpath "$2")
qemu=$(realpath "$3")
problem=${4:-$here/../../problems/maze3d.toml}
nodes=${5:-20000}
export QEMU_LD_PREFIX=${QEMU_LD_PREFIX:-/usr/aarch64-linux-gnu}
mount -t binfmt_misc binfmt_misc /proc/sys/fs/binfmt_misc
# A file that begins as an aarch64 executable does goes to qemu, open (flag O, which C implies) and under its own name (P).
printf '%s' ':aarch64:M::\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00:\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff:'"$qemu"':PO' \
    > /proc/sys/fs/binfmt_misc/register

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
digest() { sed -n 's/^digest //p' "$work/$1.log"; }
built() { # NAME PROGRAM ARGUMENT…: a build, which may end by its limit of nodes
    local name=$1 program=$2
    shift 2
    "$program" build "$problem" --max-nodes "$nodes" --out "$work/$name" "$@" > "$work/$name.log" 2>&1 \
        || [ $? = 3 ] || { cat "$work/$name.log"; exit 1; }
}
built x86 "$X86" --threads 1
built arm "$ARM" --workers 2
printf '%s\n' '#!/bin/sh' 'case $1 in x86) exec "$X86" agent --workers 1;; arm) exec "$ARM" agent --workers 1;; esac' > "$work/carry"
chmod +x "$work/carry"
built mixed "$X86" --agents x86,arm --agent-wait 60s --audit 20% --agent-command "$work/carry {}"
grep -E '^(machine|audit)' "$work/mixed.log"
for name in x86 arm mixed; do echo "$name $(digest $name)"; done
[ "$(digest x86)" = "$(digest arm)" ] && [ "$(digest x86)" = "$(digest mixed)" ]
grep -q '^machine .*arm.* [1-9][0-9]* done' "$work/mixed.log" || { echo "the aarch64 agent did nothing"; exit 1; }
