#!/usr/bin/env python3
"""A NatNet server with one dancing skeleton, written from the layout of the packets alone: answers on port 1510 and streams
to the multicast group 239.255.42.99:1511 over the loopback device, as Motive does.

Arguments: version (3.1 or 4.1), 'global' or 'local' bones, seconds, file for the places of all joints of each frame."""
import json
import math
import select
import socket
import struct
import sys
import time

VERSION = tuple(int(part) for part in sys.argv[1].split('.'))
LOCAL = sys.argv[2] == 'local'
SECONDS = float(sys.argv[3])
GROUP = ('239.255.42.99', 1511)
HZ = 120.0
TICKS = 10_000_000
SKELETON_ID = 1

# Name, parent's number (from 1), offset from it in T-pose facing +Z, metres.
BONES = [
    ('Hip', 0, (0, 0.95, 0)), ('Ab', 1, (0, 0.09, 0)), ('Chest', 2, (0, 0.21, -0.01)), ('Neck', 3, (0, 0.24, -0.02)),
    ('Head', 4, (0, 0.13, 0.02)), ('LShoulder', 3, (0.04, 0.2, 0)), ('LUArm', 6, (0.13, 0, 0)), ('LFArm', 7, (0.28, 0, 0)),
    ('LHand', 8, (0.25, 0, 0)), ('RShoulder', 3, (-0.04, 0.2, 0)), ('RUArm', 10, (-0.13, 0, 0)), ('RFArm', 11, (-0.28, 0, 0)),
    ('RHand', 12, (-0.25, 0, 0)), ('LThigh', 1, (0.1, -0.03, 0)), ('LShin', 14, (0, -0.43, 0)), ('LFoot', 15, (0, -0.41, 0)),
    ('LToe', 16, (0, -0.06, 0.14)), ('RThigh', 1, (-0.1, -0.03, 0)), ('RShin', 18, (0, -0.43, 0)), ('RFoot', 19, (0, -0.41, 0)),
    ('RToe', 20, (0, -0.06, 0.14)), ('LThumb1', 9, (0.02, 0, 0.03)), ('LThumb2', 22, (0.04, 0, 0.02)),
    ('LIndex1', 9, (0.09, 0, 0.02)),
]


def times(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def turned(q, v):
    return times(times(q, (*v, 0.0)), (-q[0], -q[1], -q[2], q[3]))[:3]


def about(axis, angle):
    s = math.sin(angle / 2)
    return (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2))


def plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def pose(frame):
    """Of each bone its own and its global place and rotation."""
    t = frame / HZ
    own, glob = [], []
    for i, (_, parent, offset) in enumerate(BONES):
        axis = ((1, 0, 0), (0, 1, 0), (0, 0, 1))[i % 3]
        q = about(axis, 0.5 * math.sin(2.0 * t + i))
        p = offset if i else (-1.0 + 0.001 * frame, 0.95 + 0.03 * math.sin(6.0 * t), 0.4 * math.sin(t))
        own.append((p, q))
        if parent:
            above_p, above_q = glob[parent - 1]
            p, q = plus(above_p, turned(above_q, p)), times(above_q, q)
        glob.append((p, q))
    return own, glob


def text(value):
    return value.encode() + b'\0'


def section(count, content):
    return struct.pack('<I', count) + (struct.pack('<I', len(content)) if VERSION >= (4, 1) else b'') + content


def message(number, content):
    return struct.pack('<HH', number, len(content)) + content


def server_info():
    return message(1, b'Motive'.ljust(256, b'\0') + bytes((3, 1, 0, 0)) + bytes((*VERSION, 0, 0)) +
                   struct.pack('<QHB', TICKS, GROUP[1], 1) + socket.inet_aton(GROUP[0]))


def rigid_body_description(name, number, parent, offset, markers):
    content = text(name) + struct.pack('<ii3f', number, parent, *offset) + struct.pack('<I', markers)
    content += struct.pack('<3f', 0.01, 0.02, 0.03) * markers + struct.pack('<I', 7) * markers
    return content + (text('M') * markers if VERSION[0] >= 4 else b'')


def models():
    skeleton = text('Ana') + struct.pack('<iI', SKELETON_ID, len(BONES))
    for i, (name, parent, offset) in enumerate(BONES):
        skeleton += rigid_body_description(name, i + 1, parent, offset, 2)
    sets = [(0, text('all') + struct.pack('<I', 1) + text('M1')), (1, rigid_body_description('Wand', 9, -1, (0, 0, 0), 3)),
            (5, text('Camera 1') + struct.pack('<7f', 1, 2, 3, 0, 0, 0, 1)), (2, skeleton)]
    content = struct.pack('<I', len(sets))
    for kind, body in sets:
        content += struct.pack('<I', kind) + (struct.pack('<I', len(body)) if VERSION >= (4, 1) else b'') + body
    return message(5, content)


def rigid_body(number, p, q):
    return struct.pack('<I3f4ffH', number, *p, *q, 0.0003, 1)


def frame_of_data(frame, bones):
    skeleton = struct.pack('<II', SKELETON_ID, len(bones))
    for i, (p, q) in enumerate(bones):
        skeleton += rigid_body(SKELETON_ID << 16 | (i + 1), p, q)
    exposed = int(1e9 + frame * TICKS / HZ)
    content = struct.pack('<I', frame)
    content += section(1, text('all') + struct.pack('<I3f', 1, 1, 2, 3))
    content += section(2, struct.pack('<6f', 1, 2, 3, 4, 5, 6))
    content += section(1, rigid_body(9, (0, 1, 0), (0, 0, 0, 1)))
    content += section(1, skeleton)
    if VERSION >= (4, 1):
        content += section(0, b'')
    content += section(1, struct.pack('<I3ffHf', 5, 1, 2, 3, 0.014, 2, 0.1))
    content += section(0, b'') + section(0, b'')
    content += struct.pack('<IIdQQQ', 0, 0, frame / HZ, exposed, exposed + 100, exposed + 200)
    if VERSION >= (4, 1):
        content += struct.pack('<II', 1_700_000_000 + int(frame / HZ), 0x40000000)
    content += struct.pack('<H', 0)
    return message(7, content + struct.pack('<I', 0))


def main():
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind(('127.0.0.1', 1510))
    link.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton('127.0.0.1'))
    begun = time.monotonic()
    asked = {}
    with open(sys.argv[4], 'w') as truth:
        frame = 0
        while frame < SECONDS * HZ:
            due = begun + frame / HZ
            ready, _, _ = select.select([link], [], [], max(0.0, due - time.monotonic()))
            if ready:
                request, sender = link.recvfrom(2048)
                number = struct.unpack_from('<H', request)[0]
                asked[number] = asked.get(number, 0) + 1
                if number == 0:
                    link.sendto(server_info(), sender)
                elif number == 4:
                    link.sendto(models(), sender)
                continue
            own, glob = pose(frame)
            truth.write(json.dumps({'frame': frame, 'joints': {BONES[i][0]: glob[i][0] for i in range(len(BONES))}}) + '\n')
            link.sendto(frame_of_data(frame, own if LOCAL else glob), GROUP)
            frame += 1
    print(json.dumps({'frames': frame, 'asked': asked}))


main()
