#!/usr/bin/env python3
"""A slow link between two network namespaces, packet by packet: delay, rate, a bounded queue and loss, both ways.

    link.py NAMESPACE_A ADDRESS_A NAMESPACE_B ADDRESS_B [--delay MS] [--rate MBIT] [--loss PERCENT] [--queue PACKETS] [--seed N]

Makes an interface `slow` in each namespace and carries packets between the two until it is told to end. It does what the
kernel's netem does, and needs a kernel with TUN only. Which packets are lost follows from the seed and their order.
Prints "ready", and at the end how many packets each direction carried, lost and had no room for. Needs root and iproute2.
"""

import argparse
import collections
import ctypes
import fcntl
import os
import random
import select
import signal
import struct
import subprocess
import sys
import time

CLONE_NEWNET = 0x40000000
TUNSETIFF = 0x400454CA
IFF_TUN, IFF_NO_PI = 0x0001, 0x1000
MTU = 1500


def enter(namespace: int) -> None:
    """Brings this process into a network namespace."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.setns(namespace, CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "setns")


def interface(namespace: str, address: str, peer: str) -> int:
    """An interface in a namespace: the file from which its packets are read and to which packets for it are written."""
    own = os.open("/proc/self/ns/net", os.O_RDONLY)
    there = os.open(f"/run/netns/{namespace}", os.O_RDONLY)
    enter(there)
    try:
        tun = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH22x", b"slow", IFF_TUN | IFF_NO_PI))
    finally:
        enter(own)
        os.close(there)
        os.close(own)
    commands = [
        f"addr add {address} peer {peer} dev slow",
        f"link set slow mtu {MTU} txqueuelen 1000 up",
        "link set lo up",
    ]
    for command in commands:
        subprocess.run(["ip", "-n", namespace, *command.split()], check=True)
    return tun


class Direction:
    """One way of the link: packets leave the queue one after another at the rate, and arrive after the delay."""

    def __init__(self, source: int, sink: int, arguments: argparse.Namespace, seed: int) -> None:
        self.source, self.sink = source, sink
        self.delay = arguments.delay / 1e3
        self.seconds_per_byte = 8 / (arguments.rate * 1e6)
        self.loss = arguments.loss / 100
        self.longest_queue = arguments.queue * MTU * self.seconds_per_byte
        self.chance = random.Random(seed)
        self.free = 0.0  # when the packet that was queued last has left
        self.under_way: collections.deque[tuple[float, bytes]] = collections.deque()
        self.carried = self.lost = self.refused = 0

    def take(self) -> None:
        """Reads all packets that are there."""
        try:
            for _ in range(64):
                packet = os.read(self.source, MTU + 100)
                now = time.monotonic()
                leave = max(now, self.free)
                if leave - now > self.longest_queue:
                    self.refused += 1
                    continue
                self.free = leave + len(packet) * self.seconds_per_byte
                # A packet that is lost on the way has taken its time.
                if self.chance.random() < self.loss:
                    self.lost += 1
                    continue
                self.under_way.append((self.free + self.delay, packet))
        except BlockingIOError:
            pass

    def deliver(self) -> float | None:
        """Hands on what has arrived; when the next packet will have arrived."""
        while self.under_way:
            due, packet = self.under_way[0]
            if due > time.monotonic():
                return due
            self.under_way.popleft()
            os.write(self.sink, packet)
            self.carried += 1
        return None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ["namespace_a", "address_a", "namespace_b", "address_b"]:
        parser.add_argument(name)
    parser.add_argument("--delay", type=float, default=20, help="milliseconds one way")
    parser.add_argument("--rate", type=float, default=100, help="Mbit/s")
    parser.add_argument("--loss", type=float, default=0, help="per cent of the packets")
    parser.add_argument("--queue", type=int, default=1000, help="packets that wait at most")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    a = interface(arguments.namespace_a, arguments.address_a, arguments.address_b)
    b = interface(arguments.namespace_b, arguments.address_b, arguments.address_a)
    directions = [Direction(a, b, arguments, arguments.seed), Direction(b, a, arguments, arguments.seed + 1)]
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: sys.exit(0))
    print("ready", flush=True)
    try:
        while True:
            dues = [direction.deliver() for direction in directions]
            dues = [due for due in dues if due is not None]
            wait = max(0.0, min(dues) - time.monotonic()) if dues else None
            select.select([a, b], [], [], wait)
            for direction in directions:
                direction.take()
    finally:
        for name, direction in zip(["a to b", "b to a"], directions):
            print(f"{name}: {direction.carried} packets, {direction.lost} lost, {direction.refused} without room")


if __name__ == "__main__":
    main()
