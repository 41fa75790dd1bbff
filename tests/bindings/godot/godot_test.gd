# The plug-in given what a script should not give it, without a house; and the rig script on rigs with
# other names, in A-pose, with bones missing. The last line is `passed` or `FAILED`.
extends SceneTree

const Adapter = preload("res://dance_adapter.gd")
const Rig = preload("res://dance_rig.gd")

var failures = 0


func expect(holds, what):
	if not holds:
		print("failed: ", what)
		failures += 1


func _init():
	misuse()
	rigs()
	stage()
	print("passed" if failures == 0 else "FAILED")
	quit()


func misuse():
	var adapter = Adapter.new()
	expect(adapter.open("no-house-here"), "a house need not be there")
	expect(adapter.state() == Adapter.NO_HOUSE, "no house")
	expect(adapter.guests().empty() and adapter.pose(0) == null and adapter.beat(1) == null, "nobody is there")
	expect(adapter.status_text().length() > 3, "a status has a text")
	var others = []
	for _i in range(15):
		others.append(adapter._call("dance_open", ["other"]))
	expect(others.max() == 15 and adapter._call("dance_open", ["one-more"]) == -1, "16 can be open")
	for handle in others:
		adapter._call("dance_close", [handle])
	for handle in [-1, 15, 16, 1 << 40, "text", null, [], 0.5]:
		for function in ["dance_state", "dance_close", "dance_send_close"]:
			if handle is String or handle is Array or handle == null or handle is float:
				continue
			adapter._call(function, [handle])
		expect(adapter._call("dance_guests", [99]).empty(), "a handle that is none")
		for function in ["dance_pose_at", "dance_skeleton_of", "dance_hands_of"]:
			expect(adapter._call(function, [15, handle, 5])[0] == 7, function)
	for slot in [64, -1, 1 << 32, 1 << 62]:
		expect(adapter._call("dance_pose_at", [adapter._handle, slot, 5])[0] == 7, "a slot that is none")
	for function in ["dance_state", "dance_close", "dance_open", "dance_text", "dance_guests", "dance_pose_at",
			"dance_skeleton_of", "dance_hands_of", "dance_beat_at", "dance_counted", "dance_send_open",
			"dance_send_close", "dance_send_pose", "dance_send_skeleton", "dance_send_hands"]:
		adapter._call(function, [])
	for name in ["No Name!", "x".repeat(25), "x".repeat(5000), "caf\u00e9", "\n"]:
		expect(adapter._call("dance_open", [name]) == -1, "an unfit name")
	var sender = adapter._call("dance_send_open", ["no-house-here"])
	expect(sender >= 0, "a sender")
	var numbers = PoolRealArray()
	for count in [0, 1, 90]:
		numbers.resize(count)
		expect(adapter._call("dance_send_pose", [sender, numbers, -1, 1 << 50]) == 7, "too few numbers")
	numbers.resize(91)
	for i in range(91):
		numbers[i] = NAN
	expect(adapter._call("dance_send_pose", [sender, numbers, 0, 1000]) == 8, "not finite")
	expect(adapter._call("dance_send_pose", [sender, "text", 0, 1000]) == 7, "no numbers")
	for i in range(91):
		numbers[i] = 1.0 if i % 4 == 2 and i > 3 else 0.0
	expect(adapter._call("dance_send_pose", [sender, numbers, 0, 1000]) == Adapter.NO_HOUSE, "no house to send to")
	adapter.close()


# A stage that is taken out of the tree and put in again reads again.
func stage():
	var made = load("res://dance_stage.gd").new()
	made.house_name = "no-house-here"
	for _i in range(2):
		root.add_child(made)
		expect(made.adapter.state() == Adapter.NO_HOUSE and made.is_processing(), "in the tree it reads")
		root.remove_child(made)
		expect(made.adapter._native == null and not made.is_processing(), "out of it not")
	made.free()


# The rig of a dancer's size with names as Mixamo writes them, arms lowered, bones lying any way.
func rig_of(offsets, missing, children_first):
	var skeleton = Skeleton.new()
	root.add_child(skeleton)
	var stances = []
	var rests = []
	var index_of = []
	for bone in range(22):
		var parent = Adapter.PARENTS[bone]
		var stance = Quat() if parent < 0 else stances[parent]
		if bone == 7 or bone == 11:
			stance = stance * Quat(Vector3.BACK, -0.7 if bone == 7 else 0.7)
		stances.append(stance)
		var at = offsets[bone] if parent < 0 else rests[parent].origin + stances[parent].xform(offsets[bone])
		rests.append(Transform(Basis(stance * Quat(randf(), randf(), randf(), randf()).normalized()), at))
		while parent >= 0 and parent in missing:
			parent = Adapter.PARENTS[parent]
		index_of.append(skeleton.get_bone_count())
		if bone in missing:
			continue
		skeleton.add_bone("mixamorig_" + Rig.MIXAMO[bone].capitalize().replace(" ", ""))
		if parent >= 0:
			skeleton.set_bone_parent(index_of[bone], index_of[parent])
		skeleton.set_bone_rest(index_of[bone], rests[bone] if parent < 0 else rests[parent].affine_inverse() * rests[bone])
	return reversed(skeleton, index_of) if children_first else [skeleton, index_of]


# The same rig with each bone before its parent.
func reversed(skeleton, index_of):
	var count = skeleton.get_bone_count()
	var made = Skeleton.new()
	root.add_child(made)
	for i in range(count):
		made.add_bone(skeleton.get_bone_name(count - 1 - i))
		made.set_bone_rest(i, skeleton.get_bone_rest(count - 1 - i))
	for i in range(count):
		var parent = skeleton.get_bone_parent(count - 1 - i)
		if parent >= 0:
			made.set_bone_parent(i, count - 1 - parent)
	var index = []
	for i in index_of:
		index.append(count - 1 - i)
	return [made, index]


func rigs():
	seed(11)
	var dancer = Adapter.Proportions.new()
	for bone in range(22):
		var left = 1 if Adapter.BONES[bone].begins_with("left") else -1
		var part = Adapter.BONES[bone].trim_prefix("left").trim_prefix("right").to_lower()
		dancer.offsets.append({
			"hips": Vector3(0, 0.95, 0), "shoulder": Vector3(0.03 * left, 0.1, 0), "upperarm": Vector3(0.13 * left, 0, 0),
			"lowerarm": Vector3(0.28 * left, 0, 0), "hand": Vector3(0.26 * left, 0, 0),
			"upperleg": Vector3(0.09 * left, -0.05, 0), "lowerleg": Vector3(0, -0.42, 0), "foot": Vector3(0, -0.4, 0),
			"toes": Vector3(0, -0.06, 0.14),
		}.get(part, Vector3(0, 0.12, 0)))
	for kind in [[[], false], [[3], false], [[2, 3], false], [[2, 3, 4, 6, 10, 17, 21], false], [[3], true]]:
		var missing = kind[0]
		var made = rig_of(dancer.offsets, missing, kind[1])
		var rig = Rig.new()
		rig.setup(rig_of(dancer.offsets, [2, 3], false)[0])  # another one before
		expect(rig.setup(made[0]), "the names of Mixamo are known")
		rig.set_dancer(dancer)
		for _i in range(20):
			var pose = Adapter.Pose.new()
			pose.hips = Vector3(randf(), 0.9, randf())
			for _bone in range(22):
				pose.rotations.append(Quat(Vector3(randf() - 0.5, randf() - 0.5, randf() - 0.5).normalized(), randf()))
			var world = Adapter.world_of(pose, dancer)
			rig.show(pose)
			for limb in Rig.LIMBS:
				var wanted = world[limb[1]].origin - world[limb[0]].origin
				var got = made[0].get_bone_global_pose(made[1][limb[1]]).origin - made[0].get_bone_global_pose(made[1][limb[0]]).origin
				expect(got.angle_to(wanted) < 0.002, "limb %s without %s: %f" % [limb, missing, got.angle_to(wanted)])
	var none = Skeleton.new()
	none.add_bone("tail")
	expect(not Rig.new().setup(none), "a skeleton without hips is refused")
	none.free()
