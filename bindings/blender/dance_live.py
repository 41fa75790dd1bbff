"""The dancers of a house in Blender, live: drives armatures in the viewport. Install it as an add-on
(Edit > Preferences > Add-ons > Install) with dance_adapter.py beside it, or run it in the text
editor; the panel is in the 3D view's side bar (N), tab Dance.

A selected armature with humanoid bones is driven by the first dancer; every dancer without one gets
an armature of its own proportions, with a simple body. Meant for Blender 3.3 and later.

Units/frames: Blender's: right-handed, +Z up, metres; a dancer in T-pose faces -Y.
Ownership:    armatures that were made here are removed when their dancer leaves or live ends.
Threads:      Blender's main thread, in a timer; reading never waits for the house.
Failure:      no library, or an error while live: the panel says so. No house: nobody is there, until one comes.
"""

import os
import sys
from math import cos, pi, sin

import bpy
from mathutils import Quaternion, Vector

for _folder in (os.path.dirname(os.path.abspath(__file__)), os.environ.get("DANCE_BINDINGS", "")):
    for _place in (_folder, os.path.join(_folder, "..", "python"), os.path.join(_folder, "python")):
        if os.path.exists(os.path.join(_place, "dance_adapter.py")) and _place not in sys.path:
            sys.path.append(_place)
import dance_adapter as da  # noqa: E402

bl_info = {
    "name": "DanceGraph live",
    "description": "Drives armatures by the dancers of a DanceGraph house",
    "author": "DanceGraph",
    "version": (0, 1, 0),
    "blender": (3, 3, 0),
    "location": "View3D > Side bar > Dance",
    "category": "Animation",
}

BONES = da.BONES
PARENTS = da.PARENTS
# Names in common rigs, by canonical bone: lower case, without prefix, dots and underscores.
OTHER_NAMES = {
    "hips": ("pelvis",), "chest": ("spine1",), "upperChest": ("spine2",),
    "leftUpperArm": ("leftarm", "upperarml"), "leftLowerArm": ("leftforearm", "forearml", "lowerarml"),
    "leftHand": ("handl",), "leftShoulder": ("shoulderl", "claviclel"),
    "rightUpperArm": ("rightarm", "upperarmr"), "rightLowerArm": ("rightforearm", "forearmr", "lowerarmr"),
    "rightHand": ("handr",), "rightShoulder": ("shoulderr", "clavicler"),
    "leftUpperLeg": ("leftupleg", "thighl", "upperlegl"), "leftLowerLeg": ("leftleg", "shinl", "calfl", "lowerlegl"),
    "leftFoot": ("footl",), "leftToes": ("lefttoebase", "toel", "balll"),
    "rightUpperLeg": ("rightupleg", "thighr", "upperlegr"),
    "rightLowerLeg": ("rightleg", "shinr", "calfr", "lowerlegr"),
    "rightFoot": ("footr",), "rightToes": ("righttoebase", "toer", "ballr"),
}  # fmt: skip
# Limbs of a rig in A-pose are straightened: upper bone and the one at its end.
LIMBS = {7: 8, 8: 9, 11: 12, 12: 13, 14: 15, 15: 16, 18: 19, 19: 20}
FEET = (16, 17, 20, 21)
# Of the simple body, for each bone: half its thickness where it begins and where it ends, in metres.
ARM = ((0.05, 0.055), (0.055, 0.042), (0.042, 0.032), (0.036, 0.026))
LEG = ((0.088, 0.06), (0.06, 0.042), (0.044, 0.042), (0.038, 0.03))
THICKNESS = (
    (0.125, 0.115), (0.115, 0.115), (0.118, 0.125), (0.13, 0.075), (0.05, 0.048), (0.088, 0.098),
    *ARM, *ARM, *LEG, *LEG,
)  # fmt: skip
HEAD = BONES.index("head")
COLOURS = ((0.78, 0.17, 0.06, 1), (0.05, 0.28, 0.5, 1), (0.85, 0.42, 0.05, 1), (0.15, 0.4, 0.1, 1))


def plain(name):
    """A bone's name for comparison: mixamorig:LeftArm, left_arm and LeftArm are one."""
    name = name.rsplit(":", 1)[-1].lower()
    for letter in "._- ":
        name = name.replace(letter, "")
    return name.removeprefix("mixamorig").removeprefix("jbipc").removeprefix("deform")


def rest_points(skeleton):
    """Where each bone and each tip is in T-pose, above the floor of the armature."""
    points = []
    for bone, parent in enumerate(PARENTS):
        offset = Vector(skeleton.offset[bone])
        points.append(offset if parent < 0 else points[parent] + offset)
    tips = {bone: points[bone] + Vector(skeleton.tip[i]) for i, bone in enumerate(da.TIP_BONES)}
    return points, tips


# Where a bone with several children leads to.
AFTER = {0: 1, 3: 4, 5: None, 9: None, 13: None, 17: None, 21: None}


def make_armature(name, skeleton, collection):
    """An armature of the dancer's own proportions, in T-pose."""
    data = bpy.data.armatures.new(name)
    made = bpy.data.objects.new(name, data)
    collection.objects.link(made)
    before = bpy.context.view_layer.objects.active
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    points, tips = rest_points(skeleton)
    bones = []
    for bone, parent in enumerate(PARENTS):
        one = data.edit_bones.new(BONES[bone])
        one.head = points[bone]
        after = AFTER.get(bone, bone + 1)
        one.tail = tips[bone] if after is None else points[after]
        if one.length < 0.01:
            one.tail = one.head + Vector((0, 0, 0.05))
        if parent >= 0:
            one.parent = bones[parent]
        bones.append(one)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = before
    return made


def make_body(armature, colour):
    """A simple body, one mesh: a rounded limb for each bone, skinned to it."""
    data = bpy.data.meshes.new(armature.name + " body")
    corners, faces, groups = [], [], []
    rings, around = 7, 14
    for index, bone in enumerate(armature.data.bones):
        first = len(corners)
        begin, end = THICKNESS[index]
        # Rounded ends go beyond the joints; a head begins above its neck.
        start, stop = (0.4 * bone.length, 0.66 * bone.length) if index == HEAD else (0.0, bone.length)
        for ring in range(2 * rings):
            at_end = ring >= rings
            angle = (ring if not at_end else ring - 1) / (2 * rings - 2) * pi
            radius = end if at_end else begin
            y = -cos(angle) * radius * 0.85 + (stop if at_end else start)
            for corner in range(around):
                turn = 2 * pi * corner / around
                out = sin(angle) * radius
                corners.append(bone.matrix_local @ Vector((out * cos(turn), y, out * sin(turn))))
        for ring in range(2 * rings - 1):
            for corner in range(around):
                a, b = first + ring * around + corner, first + ring * around + (corner + 1) % around
                faces.append((a, b, b + around, a + around))
        groups.append((bone.name, range(first, len(corners))))
    data.from_pydata(corners, [], faces)
    for face in data.polygons:
        face.use_smooth = True
    body = bpy.data.objects.new(armature.name + " body", data)
    for bone_name, members in groups:
        body.vertex_groups.new(name=bone_name).add(list(members), 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = armature
    body.parent = armature
    material = bpy.data.materials.new(armature.name)
    material.diffuse_color = colour
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.6
    data.materials.append(material)
    armature.users_collection[0].objects.link(body)
    return body


class Rig:
    """An armature and how its bones are turned as a dancer's: each bone's turn in the world is the
    dancer's, on top of how the rig's bone lies in T-pose."""

    def __init__(self, armature):
        self.armature = armature
        known = {plain(bone.name): bone.name for bone in armature.pose.bones}
        self.bone_of = []
        for name in BONES:
            found = [known[one] for one in (plain(name), *OTHER_NAMES.get(name, ())) if one in known]
            self.bone_of.append(found[0] if found else None)
        if self.bone_of[0] is None:
            raise da.DanceError(f"the armature '{armature.name}' has no hips by a known name")
        self.dancer_bone_of = {name: bone for bone, name in enumerate(self.bone_of) if name}
        # A rig without upper chest carries its shoulders on the spine that it has.
        self.turn_of = list(range(len(BONES)))
        for bone in (3, 2, 1):
            if self.bone_of[bone]:
                self.turn_of[bone] = 3
                break
        self.order = self._parents_first()
        # The user's, for release().
        self.modes = {one.name: one.rotation_mode for one in self.order}
        for one in self.order:
            one.rotation_mode = "QUATERNION"
        self.rest = {one.name: one.bone.matrix_local.to_quaternion() for one in self.order}
        hips = armature.data.bones[self.bone_of[0]]
        self.hips_rest = hips.matrix_local.inverted()
        self.hips_height = max(hips.head_local.z, 0.05)
        self.scale = 1.0
        self.t_pose = {}
        self.set_dancer(None)

    def release(self):
        """Gives the armature back: as it stands, with its bones' rotation modes as they were."""
        for one in self.order:
            one.rotation_mode = self.modes[one.name]

    def _parents_first(self):
        order = []

        def add(bone):
            order.append(bone)
            for child in bone.children:
                add(child)

        for bone in self.armature.pose.bones:
            if bone.parent is None:
                add(bone)
        return order

    def set_dancer(self, skeleton):
        """The dancer's proportions: how high its hips are, which way its limbs lie in T-pose."""
        if skeleton is not None:
            self.scale = self.hips_height / max(skeleton.offset[0][2], 0.05)
        bones = self.armature.data.bones
        carries = {}
        for one in self.order:
            bone = self.dancer_bone_of.get(one.name)
            carry = Quaternion() if one.parent is None or bone in FEET else carries[one.parent.name]
            end = self.bone_of[LIMBS[bone]] if bone in LIMBS else None
            if end:
                lies = carry @ (bones[end].head_local - bones[one.name].head_local)
                carry = lies.rotation_difference(self._direction(bone, skeleton)) @ carry
            carries[one.name] = carry
            self.t_pose[one.name] = carry @ self.rest[one.name]

    @staticmethod
    def _direction(bone, skeleton):
        if skeleton is not None:
            along = Vector(skeleton.offset[LIMBS[bone]])
            if along.length > 0.01:
                return along
        if bone >= 14:
            return Vector((0, 0, -1))
        return Vector((1 if bone < 10 else -1, 0, 0))

    def show(self, pose):
        turns = []
        for bone, parent in enumerate(PARENTS):
            x, y, z, w = pose.rotation[bone]
            local = Quaternion((w, x, y, z))
            turns.append(local if parent < 0 else turns[parent] @ local)
        world = {}
        for one in self.order:
            name = one.name
            above = one.parent
            lies = self.rest[name]
            if above is not None:
                lies = world[above.name] @ self.rest[above.name].inverted() @ self.rest[name]
            bone = self.dancer_bone_of.get(name)
            if bone is None:
                world[name] = lies @ one.rotation_quaternion
                continue
            world[name] = turns[self.turn_of[bone]] @ self.t_pose[name]
            one.rotation_quaternion = (lies.inverted() @ world[name]).normalized()
            if bone == 0:
                x, y, z = pose.hips_position
                one.location = self.hips_rest @ Vector((x, y, z * self.scale))


class Live:
    """The dancers of a house, each on an armature. update() once a frame."""

    def __init__(self, name=None, armatures=(), with_body=True, lead_ms=20.0):
        self.adapter = da.Adapter(name or None, da.Axes.BLENDER)
        self.waiting = list(armatures)  # of the user, not driven yet
        self.with_body = with_body
        self.lead_ms = lead_ms  # < 0: the newest pose, as it came
        self.dancers = {}  # id -> Dancer
        self.skeleton = da.Skeleton()

    class Dancer:
        def __init__(self, slot):
            self.slot = slot
            self.rig = None
            self.is_made = False
            self.has_own = False  # proportions; else those of an average adult
            self.proportions = None
            self.pose = da.Pose()
            self.is_shown = False

    def update(self):
        """Shows every dancer; returns how many there are."""
        here = {guest.name: guest for guest in self.adapter.guests()}
        for name in [one for one in self.dancers if one not in here]:
            self._remove(self.dancers.pop(name))
        seen_at = da.now_ns() + int(self.lead_ms * 1e6)
        for name, guest in here.items():
            dancer = self.dancers.setdefault(name, self.Dancer(guest.slot))
            dancer.slot = guest.slot
            dancer.has_own = bool(guest.has_skeleton)
            skeleton = self.adapter.skeleton(guest.slot, self.skeleton)
            proportions = bytes(skeleton.offset) + bytes(skeleton.tip) if skeleton else None
            if proportions and proportions != dancer.proportions:
                dancer.proportions = proportions
                self._fit(name, dancer, skeleton)
            pose = (
                self.adapter.newest(guest.slot, dancer.pose)
                if self.lead_ms < 0
                else self.adapter.at(guest.slot, seen_at, dancer.pose)
            )
            dancer.is_shown = bool(pose and dancer.rig)
            try:
                if dancer.is_shown:
                    dancer.rig.show(pose)
            except (ReferenceError, KeyError):
                # The armature was deleted, or its bones were: the dancer gets another.
                self._remove(dancer)
                dancer.proportions = None
                dancer.is_shown = False
        return len(here)

    def close(self):
        try:
            for dancer in self.dancers.values():
                self._remove(dancer)
        finally:
            self.dancers.clear()
            self.adapter.close()

    def _fit(self, name, dancer, skeleton):
        while dancer.rig is None and self.waiting:
            try:
                dancer.rig = Rig(self.waiting.pop(0))
            except ReferenceError:
                continue  # deleted since it was selected
        if dancer.rig is None or dancer.is_made:
            self._remove(dancer)
            armature = make_armature(f"dancer {name}", skeleton, bpy.context.scene.collection)
            if self.with_body:
                make_body(armature, COLOURS[sum(name.encode()) % len(COLOURS)])
            dancer.rig = Rig(armature)
            dancer.is_made = True
        dancer.rig.set_dancer(skeleton)

    def _remove(self, dancer):
        rig, dancer.rig = dancer.rig, None
        try:
            if rig is not None and dancer.is_made:
                for child in rig.armature.children:
                    bpy.data.objects.remove(child)
                bpy.data.objects.remove(rig.armature)
            elif rig is not None:
                rig.release()
                self.waiting.append(rig.armature)
        except (ReferenceError, KeyError):
            pass  # somebody deleted it
        dancer.is_made = False


_live = None
_problem = ""  # why live ended by itself; shown in the panel
_PERIOD_S = 1 / 60


def _tick():
    global _live, _problem
    if _live is None:
        return None
    try:
        _live.update()
    except Exception as error:  # an error that leaves a timer ends it, and nobody would say so
        _problem = str(error) or type(error).__name__
        print(f"DanceGraph: live ended: {_problem}", file=sys.stderr)
        ended, _live = _live, None
        ended.close()
        return None
    return _PERIOD_S


class DANCE_OT_live(bpy.types.Operator):
    bl_idname = "dance.live"
    bl_label = "Start"
    bl_description = "Shows the dancers of the house; a selected armature is driven by the first of them"

    def execute(self, context):
        global _live, _problem
        _problem = ""
        if _live is not None:
            ended, _live = _live, None
            ended.close()
            return {"FINISHED"}
        try:
            chosen = [one for one in context.selected_objects if one.type == "ARMATURE"]
            _live = Live(context.scene.dance_house, chosen)
        except da.DanceError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        bpy.app.timers.register(_tick, persistent=False)
        return {"FINISHED"}


class DANCE_PT_panel(bpy.types.Panel):
    bl_label = "DanceGraph"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Dance"

    def draw(self, context):
        column = self.layout.column()
        column.prop(context.scene, "dance_house")
        column.operator("dance.live", text="Stop" if _live else "Start")
        if _live is not None:
            count = len(_live.dancers)
            column.label(text=f"{count} dance" if count else _live.adapter.status_text())
        elif _problem:
            column.label(text=_problem, icon="ERROR")


_CLASSES = (DANCE_OT_live, DANCE_PT_panel)


def register():
    bpy.types.Scene.dance_house = bpy.props.StringProperty(
        name="House", description="Name of the house's memory; empty is the usual one"
    )
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister():
    global _live
    if _live is not None:
        _live.close()
        _live = None
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
    del bpy.types.Scene.dance_house


if __name__ == "__main__":
    register()
