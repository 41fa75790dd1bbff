#!/usr/bin/env python3
"""listen.py: prints where each dancer's hips are.

The decoders are made of the messages' .lcm files, here into the folder "types":
    lcm-gen --python --ppath types /usr/share/dancegraph/lcmtypes/*.lcm
    PYTHONPATH=types python3 listen.py POSE/stage/ 10

Debian has no Python binding of LCM itself, and a short message needs none: it is one datagram to a multicast group,
"LC02", a number of 32 bits, the channel's name, a zero byte, and the message. (Messages above 65,000 bytes come in
parts that begin with "LC03"; none of ours is as long.) With LCM's own Python module, where it is installed, the same is
lcm.LCM(url).subscribe("POSE/stage/.*", handler).
"""
import os
import re
import socket
import struct
import sys
import time

from dancelcm.pose_t import pose_t


IP_MULTICAST_ALL = 49  # Linux's number; the module socket has no name for it


def open_bus(url):
    """A socket that receives the group of an URL like udpm://239.255.76.67:7667?ttl=0.

    It joins on the loopback device, over which programs of DanceGraph send, and receives from no other: no host of the
    network can send to it.
    """
    group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
    bus = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    bus.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    bus.setsockopt(socket.IPPROTO_IP, IP_MULTICAST_ALL, 0)
    bus.bind((group, int(port)))
    membership = struct.pack("=4s4si", socket.inet_aton(group), socket.inet_aton("0.0.0.0"), socket.if_nametoindex("lo"))
    bus.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    bus.settimeout(0.2)
    return bus


def messages(bus, end):
    """Channel and bytes of each message, until the time is up."""
    while time.monotonic() < end:
        try:
            datagram = bus.recv(65536)
        except socket.timeout:
            continue
        if datagram[:4] == b"LC02" and b"\0" in datagram[8:]:
            channel, data = datagram[8:].split(b"\0", 1)
            yield channel.decode("ascii", "replace"), data


def main():
    prefix = sys.argv[1] if len(sys.argv) > 1 else "POSE/stage/"
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 1e9
    bus = open_bus(os.environ.get("DANCE_BUS_URL", "udpm://239.255.76.67:7667?ttl=0"))
    for channel, data in messages(bus, time.monotonic() + seconds):
        if not channel.startswith(prefix):
            continue
        try:
            pose = pose_t.decode(data)
        except (ValueError, struct.error):
            continue  # a message of another type or version
        print(channel, pose.sequence, *("%.3f" % metres for metres in pose.hips_m), flush=True)


if __name__ == "__main__":
    main()
