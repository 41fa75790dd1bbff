"""Reads a house as a Python program does: NAME SECONDS. Prints each new pose of each dancer, as
`pose GUEST SEQUENCE` and where its 22 bones are, and at the end what the adapter counted."""

import sys
import time

import dance_adapter as da

name, seconds = sys.argv[1], float(sys.argv[2])
last = {}
pose, skeleton, world = da.Pose(), da.Skeleton(), da.World()
with da.Adapter(name) as adapter:
    end = time.monotonic() + seconds
    turn = time.monotonic()
    while turn < end:
        for guest in adapter:
            if not guest.has_skeleton or not adapter.skeleton(guest.slot, skeleton):
                continue
            if not adapter.newest(guest.slot, pose) or last.get(guest.name) == pose.sequence:
                continue
            last[guest.name] = pose.sequence
            da.world_of(skeleton, pose, world)
            numbers = " ".join(f"{value:.6f}" for bone in world.position for value in bone)
            print("pose", guest.name, pose.sequence, numbers)
        turn += 1 / 60
        time.sleep(max(0.0, turn - time.monotonic()))
    counted = adapter.counters()
    print("counters", counted.reads, counted.retries, counted.busy, counted.damaged, counted.attached)
