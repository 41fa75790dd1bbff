# Reads a house as a project of Godot does, with bindings/godot/dance_stage.gd: -s read_dancers.gd
# NAME SECONDS. The dancers move Skeletons of their proportions whose bones lie any way; printed is
# where Godot then has their bones, as `pose GUEST SEQUENCE` and 22 places, and at the end what the
# adapter counted.
extends SceneTree

const Adapter = preload("res://dance_adapter.gd")
const Rig = preload("res://dance_rig.gd")

var stage = null
var rigs = {}
var last = {}
var end = 0


func _init():
	Engine.target_fps = 60
	var arguments = OS.get_cmdline_args()
	var seconds = float(arguments[arguments.size() - 1])
	stage = load("res://dance_stage.gd").new()
	stage.house_name = arguments[arguments.size() - 2]
	stage.display_lead_ms = -1.0
	root.call_deferred("add_child", stage)
	end = OS.get_ticks_msec() + int(seconds * 1000)


func _idle(_delta):
	for id in stage.figures:
		_read(id, stage.figures[id])
	if OS.get_ticks_msec() < end or end == 0:
		return
	end = 0
	var counted = stage.adapter.counters()
	print("counters %d %d %d %d %d" % [counted.reads, counted.retries, counted.busy, counted.damaged, counted.attached])
	quit()


func _read(id, figure):
	if figure.pose == null or not stage.adapter.guests().get(id, {}).get("has_skeleton", false):
		return
	if last.get(id, -1) == figure.pose.sequence:
		return
	last[id] = figure.pose.sequence
	if not rigs.has(id):
		rigs[id] = _rig_of(figure.skeleton)
	rigs[id].show(figure.pose)
	var line = "pose %s %d" % [id, figure.pose.sequence]
	for bone in range(Adapter.BONES.size()):
		var at = rigs[id].skeleton.get_bone_global_pose(bone).origin
		line += " %.6f %.6f %.6f" % [at.x, at.y, at.z]
	print(line)


# A rig of the dancer's proportions, arms lowered, bones lying any way.
func _rig_of(dancer):
	seed(5)
	var skeleton = Skeleton.new()
	root.add_child(skeleton)
	var stances = []
	var rests = []
	for bone in range(Adapter.BONES.size()):
		var parent = Adapter.PARENTS[bone]
		var stance = Quat() if parent < 0 else stances[parent]
		if Adapter.BONES[bone] == "leftUpperArm":
			stance = stance * Quat(Vector3.BACK, -0.7)
		if Adapter.BONES[bone] == "rightUpperArm":
			stance = stance * Quat(Vector3.BACK, 0.7)
		stances.append(stance)
		var at = dancer.offsets[bone]
		if parent >= 0:
			at = rests[parent].origin + stances[parent].xform(dancer.offsets[bone])
		var lies = stance * Quat(randf(), randf(), randf(), randf()).normalized()
		rests.append(Transform(Basis(lies), at))
		skeleton.add_bone(Adapter.BONES[bone])
		if parent >= 0:
			skeleton.set_bone_parent(bone, parent)
		skeleton.set_bone_rest(bone, rests[bone] if parent < 0 else rests[parent].affine_inverse() * rests[bone])
	var rig = Rig.new()
	rig.setup(skeleton)
	rig.set_dancer(dancer)
	return rig
