# Run by Blender without its window: opens an avatar as its File > Import does, and writes what it found as JSON.
#   blender -b --factory-startup -P blender_avatar.py -- FILE OUT.json
import builtins
import json
import math
import sys

import bpy
import numpy

# See ../files/blender_joints.py.
if not hasattr(numpy, "bool"):
    numpy.bool = bool
plain_open = builtins.open
builtins.open = lambda file, mode="r", *args, **named: plain_open(file, mode.replace("U", ""), *args, **named)

path, out = sys.argv[sys.argv.index("--") + 1 :][:2]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.import_scene.gltf(filepath=path)
armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
meshes = [o for o in bpy.data.objects if o.type == "MESH" and o.find_armature()]
joints = {}
for bone in armature.data.bones:
    p = armature.matrix_world @ bone.head_local
    joints[bone.name] = [p.x, p.z, -p.y]
high = max((o.matrix_world @ v.co).z for o in meshes for v in o.data.vertices)
low = min((o.matrix_world @ v.co).z for o in meshes for v in o.data.vertices)
# A raised arm takes its hand along, and nothing tears.
bone = armature.pose.bones["leftUpperArm"]
bone.rotation_mode = "XYZ"
bone.rotation_euler = (math.radians(60), 0, 0)
bpy.context.view_layer.update()
graph = bpy.context.evaluated_depsgraph_get()
longest = 0.0
moved = 0
for thing in meshes:
    seen = thing.evaluated_get(graph)
    mesh = seen.to_mesh()
    for edge in mesh.edges:
        a, b = (mesh.vertices[v].co for v in edge.vertices)
        c, d = (thing.data.vertices[v].co for v in edge.vertices)
        longest = max(longest, (a - b).length - (c - d).length)
    moved += sum((v.co - w.co).length > 0.1 for v, w in zip(mesh.vertices, thing.data.vertices))
    seen.to_mesh_clear()
keys = sorted({k.name for o in meshes if o.data.shape_keys for k in o.data.shape_keys.key_blocks})
with open(out, "w", encoding="utf-8") as file:
    json.dump({"blender": bpy.app.version_string, "joints": joints, "low_m": low, "high_m": high, "moved": moved,
               "stretched_m": longest, "shape_keys": keys, "images": [list(i.size) for i in bpy.data.images],
               "triangles": sum(len(o.data.polygons) for o in meshes)}, file)
