# Run by Blender without its window: opens a file as its File > Import does, and writes, for some frames, where every joint
# is (heads of bones, tails of those without children) and what became of the skinned meshes, in metres with +Y up.
#   blender -b --factory-startup -P blender_joints.py -- FILE OUT.json FIRST_FRAME COUNT STEP RATE_HZ
import builtins
import json
import math
import sys

import bpy
import numpy

# Debian 12's Blender 3.4 is older than the NumPy and the Python that it runs with: its importers use a name and a file mode
# that those have no more.
if not hasattr(numpy, "bool"):
    numpy.bool = bool
plain_open = builtins.open
builtins.open = lambda file, mode="r", *args, **named: plain_open(file, mode.replace("U", ""), *args, **named)

path, out, first, count, step, rate = sys.argv[sys.argv.index("--") + 1 :][:6]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
scene = bpy.context.scene
scene.render.fps = round(float(rate))
if path.endswith(".bvh"):
    bpy.ops.import_anim.bvh(filepath=path, axis_forward="-Z", axis_up="Y", update_scene_fps=False, use_fps_scale=False)
    first_frame = 1  # Blender's first frame of a BVH
else:
    bpy.ops.import_scene.gltf(filepath=path)
    first_frame = 0


def y_up(p):
    return [p.x, p.z, -p.y]


frames = []
for i in range(int(count)):
    frame = int(first) + i * int(step)
    scene.frame_set(first_frame + frame)
    graph = bpy.context.evaluated_depsgraph_get()
    joints = {}
    bodies = {}
    for armature in (o for o in bpy.data.objects if o.type == "ARMATURE"):
        of = {}
        for bone in armature.pose.bones:
            of[bone.name] = y_up(armature.matrix_world @ bone.head)
            if not bone.children:
                of[bone.name + "/tail"] = y_up(armature.matrix_world @ bone.tail)
        joints[armature.name] = of
    for thing in (o for o in bpy.data.objects if o.type == "MESH" and o.find_armature()):
        seen = thing.evaluated_get(graph)
        mesh = seen.to_mesh()
        bones = [thing.find_armature().matrix_world @ b.head for b in thing.find_armature().pose.bones]
        furthest = 0.0
        finite = True
        low = math.inf
        for v in range(0, len(mesh.vertices), 41):
            p = seen.matrix_world @ mesh.vertices[v].co
            finite = finite and all(math.isfinite(c) for c in p)
            furthest = max(furthest, min((p - b).length for b in bones))
            low = min(low, p.z)
        bodies[thing.name] = {"vertices": len(mesh.vertices), "finite": finite, "furthest_from_bones_m": furthest,
                              "lowest_m": low}
        seen.to_mesh_clear()
    frames.append({"frame": frame, "joints": joints, "bodies": bodies})
with open(out, "w", encoding="utf-8") as file:
    json.dump({"blender": bpy.app.version_string, "frames": frames}, file)
