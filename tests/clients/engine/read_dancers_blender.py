"""Reads a house inside Blender with dance_live.py: -- NAME SECONDS. Prints each new pose of each
dancer, as `pose GUEST SEQUENCE` and where the bones' heads of its armature are after Blender's own
evaluation, and at the end what the adapter counted."""

import sys
import time

import bpy
import dance_live

name, seconds = sys.argv[sys.argv.index("--") + 1 :][:2]
bpy.ops.wm.read_factory_settings(use_empty=True)
# Blender handles no timers without a window, so that the script calls what its timer calls.
live = dance_live.Live(name, lead_ms=-1.0)
last = {}
end = time.monotonic() + float(seconds)
turn = time.monotonic()
while turn < end:
    live.update()
    bpy.context.view_layer.update()
    for guest, dancer in live.dancers.items():
        if not dancer.is_shown or not dancer.has_own or last.get(guest) == dancer.pose.sequence:
            continue
        last[guest] = dancer.pose.sequence
        armature = dancer.rig.armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heads = [armature.matrix_world @ armature.pose.bones[bone].head for bone in dance_live.BONES]
        print("pose", guest, dancer.pose.sequence, " ".join(f"{value:.6f}" for head in heads for value in head))
    turn += 1 / 60
    time.sleep(max(0.0, turn - time.monotonic()))
counted = live.adapter.counters()
print("counters", counted.reads, counted.retries, counted.busy, counted.damaged, counted.attached)
live.close()
