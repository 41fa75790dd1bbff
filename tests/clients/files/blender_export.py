# Run by Blender without its window: imports a BVH and exports it as GLB, as an animator would.
#   blender -b --factory-startup -P blender_export.py -- FILE.bvh OUT.glb FRAMES RATE_HZ
import builtins
import sys

import bpy
import numpy

# See blender_joints.py.
if not hasattr(numpy, "bool"):
    numpy.bool = bool
plain_open = builtins.open
builtins.open = lambda file, mode="r", *args, **named: plain_open(file, mode.replace("U", ""), *args, **named)

path, out, frames, rate = sys.argv[sys.argv.index("--") + 1 :][:4]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.context.scene.render.fps = round(float(rate))
bpy.ops.import_anim.bvh(filepath=path, axis_forward="-Z", axis_up="Y", update_scene_fps=False, use_fps_scale=False)
bpy.context.scene.frame_start = 1
bpy.context.scene.frame_end = int(frames)
bpy.ops.export_scene.gltf(filepath=out, export_format="GLB", export_frame_range=True, export_force_sampling=True)
