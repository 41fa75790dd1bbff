"""Inside Blender: an armature that stands in A-pose, with other names, rolled bones and without optional ones, has its
bones where the dancer has them. LIBRARY is the argument. The last line is `passed` or `FAILED`."""

import math
import random
import sys

import bpy
import dance_adapter as da
import dance_live
from mathutils import Quaternion, Vector

da.load(sys.argv[-1])
random.seed(7)
MIXAMO = {"leftUpperArm": "LeftArm", "leftLowerArm": "LeftForeArm", "rightUpperArm": "RightArm"}


def skeleton_of(lowered):
    """A dancer's proportions in Blender's axes, the arms lowered by so many radians."""
    skeleton = da.Skeleton(version=1)
    for bone, name in enumerate(da.BONES):
        left = 1.0 if name.startswith("left") else -1.0
        part = name.removeprefix("left").removeprefix("right").lower()
        offset = Vector({
            "hips": (0, 0, 0.95), "shoulder": (0.03 * left, 0, 0.1), "upperarm": (0.13 * left, 0, 0),
            "lowerarm": (0.28 * left, 0, 0), "hand": (0.26 * left, 0, 0), "upperleg": (0.09 * left, 0, -0.05),
            "lowerleg": (0, 0, -0.42), "foot": (0, 0, -0.4), "toes": (0, -0.14, -0.06),
        }.get(part, (0, 0, 0.12)))  # fmt: skip
        if part in ("lowerarm", "hand"):
            offset.rotate(Quaternion((0, 1, 0), lowered * left))
        skeleton.offset[bone][:] = offset
    for tip, along in enumerate(((0, 0, 0.2), (0.18, 0, 0), (-0.18, 0, 0), (0, -0.07, 0), (0, -0.07, 0))):
        skeleton.tip[tip][:] = along
    return skeleton


def random_pose():
    pose = da.t_pose(0.9, da.Axes.BLENDER)
    for rotation in pose.rotation:
        axis = Vector([random.uniform(-1, 1) for _ in range(3)]).normalized()
        turn = Quaternion(axis, random.uniform(-1, 1))
        rotation[:] = (turn.x, turn.y, turn.z, turn.w)
    pose.hips_position[:2] = (random.uniform(-1, 1), random.uniform(-1, 1))
    return pose


def furthest_of(lowered, missing):
    """How far the limbs' ends are from their beginnings in another direction than the dancer's, in metres."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    armature = dance_live.make_armature("rig", skeleton_of(lowered), bpy.context.scene.collection)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    edit = armature.data.edit_bones
    for name in missing:
        edit.remove(edit[name])
    for bone in edit:
        bone.roll = random.uniform(-3, 3)
        bone.name = "mixamorig:" + MIXAMO.get(bone.name, bone.name)
    for child, parent in (("Neck", "chest"), ("LeftShoulder", "chest"), ("RightShoulder", "chest")):
        name = "mixamorig:" + child[0].lower() + child[1:]
        if "upperChest" in missing and name in edit:
            edit[name].parent = edit["mixamorig:" + parent]
    bpy.ops.object.mode_set(mode="OBJECT")
    rig = dance_live.Rig(armature)
    dancer = skeleton_of(0.0)
    rig.set_dancer(dancer)
    furthest = 0.0
    for _ in range(20):
        pose = random_pose()
        rig.show(pose)
        bpy.context.view_layer.update()
        world = da.world_of(dancer, pose)
        heads = [armature.pose.bones[name].head if name else None for name in rig.bone_of]
        for begin, end in dance_live.LIMBS.items():
            wanted = Vector(world.position[end]) - Vector(world.position[begin])
            furthest = max(furthest, (heads[end] - heads[begin] - wanted).length)
    return furthest


failures = 0
for lowered, missing in ((0.0, ()), (0.8, ()), (0.8, ("upperChest",)), (0.6, ("leftToes", "rightToes"))):
    furthest = furthest_of(lowered, missing)
    print(f"arms lowered by {lowered}, without {list(missing)}: furthest {1000 * furthest:.4f} mm")
    failures += not furthest < 1e-4 or math.isnan(furthest)


class Guest:
    """As the adapter lists one whose own proportions have not come."""

    name, slot, has_skeleton = "alice", 0, 0


class House:
    """The reads of an adapter, answered without a house."""

    problem = None

    def guests(self):
        if self.problem:
            raise self.problem
        return [Guest]

    def skeleton(self, _slot, _into):
        return skeleton_of(0.0)

    def at(self, _slot, _time_ns, _into):
        return random_pose()

    def close(self):
        pass


def expect(holds, what):
    global failures
    failures += not holds
    print("passed:" if holds else "FAILED:", what)


def live_of(armatures):
    live = dance_live.Live("no-house-here", armatures)
    live.adapter.close()
    live.adapter = House()
    return live


bpy.ops.wm.read_factory_settings(use_empty=True)
live = live_of(())
live.update()
dancer = live.dancers["alice"]
expect(dancer.is_shown, "a dancer without proportions of its own gets an armature of average ones")
bpy.data.objects.remove(dancer.rig.armature)
dance_live._live = live
dance_live._tick()
expect(dance_live._tick() is not None and dancer.is_shown, "an armature that was deleted is made again")
House.problem = RuntimeError("the house burns")
expect(dance_live._tick() is None and dance_live._live is None, "an error ends live")
expect(dance_live._problem == "the house burns", "and the panel says which")
House.problem = None
mine = dance_live.make_armature("mine", skeleton_of(0.5), bpy.context.scene.collection)
for one in mine.pose.bones:
    one.rotation_mode = "XYZ"
live = live_of([mine])
live.update()
expect(mine.pose.bones[0].rotation_mode == "QUATERNION", "a selected armature is driven")
live.close()
expect(all(one.rotation_mode == "XYZ" for one in mine.pose.bones), "and has its rotation modes again at the end")
print("passed" if failures == 0 else "FAILED")
