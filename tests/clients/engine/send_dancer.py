"""The way back from Python: NAME SECONDS. A tracker's dancer with the left arm lowered, who walks along +X."""

import math
import sys
import time

import dance_adapter as da

with da.Producer(sys.argv[1]) as producer:
    pose = da.t_pose(0.9)
    arm = da.BONES.index("leftUpperArm")
    pose.rotation[arm][2], pose.rotation[arm][3] = math.sin(-0.6), math.cos(-0.6)
    end = time.monotonic() + float(sys.argv[2])
    turn = time.monotonic()
    sent = 0
    while turn < end:
        pose.hips_position[0] = 0.001 * (sent % 500)
        sent += producer.pose(pose)
        turn += 1 / 60
        time.sleep(max(0.0, turn - time.monotonic()))
    print("sent", sent)
