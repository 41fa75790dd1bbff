# The dancers of a house for GDScript, through libdance_godot.so and libdance_adapter.so.1.
# Metres, +Y up, a dancer in T-pose faces +Z: Godot's own axes. Rotations are of each bone in its
# parent, identity in T-pose. Without house, dancer or data a call returns null; `status` says why.
extends Reference

const OK = 0
const NO_HOUSE = 1
const NO_GUEST = 2
const NO_DATA = 3
const BUSY = 4

const BONES = [
	"hips", "spine", "chest", "upperChest", "neck", "head",
	"leftShoulder", "leftUpperArm", "leftLowerArm", "leftHand",
	"rightShoulder", "rightUpperArm", "rightLowerArm", "rightHand",
	"leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
	"rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
]
const PARENTS = [-1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20]
# The bones whose ends the five tips are.
const TIP_BONES = [5, 9, 13, 17, 21]

var status = OK
var _native = null
var _handle = -1


class Pose:
	var sequence = 0
	var kind = 0
	var presence = 0
	var confidence = 0.0
	var music_beats = NAN
	var time_ns = 0
	var hips = Vector3()
	var rotations = []  # a Quat for each of BONES


class Proportions:
	var version = 0
	var numbers = PoolRealArray()  # all below, to compare
	var offsets = []  # a Vector3 for each of BONES, from its parent in T-pose
	var tips = []


# The house's name ("" is the usual one). False where the plug-in is missing or the name unfit.
func open(house_name = ""):
	close()
	_native = GDNative.new()
	_native.library = load(get_script().resource_path.get_base_dir().plus_file("dance_adapter.gdnlib"))
	if not _native.initialize():
		_native = null
		push_error("DanceGraph: libdance_godot.so and libdance_adapter.so.1 must be in the folder of this script")
		return false
	_handle = _call("dance_open", [house_name])
	if _handle < 0:
		push_error("DanceGraph: a house's name is 1 to 24 characters of a-z, 0-9 and '-'")
	return _handle >= 0


func close():
	if _native == null:
		return
	if _handle >= 0:
		_call("dance_close", [_handle])
	_handle = -1
	# Godot keeps what is not terminated, and fails over it at exit.
	_native.terminate()
	_native = null


func _notification(what):
	# As close(): what is being deleted cannot call functions of its own.
	if what == NOTIFICATION_PREDELETE and _native != null:
		_native.call_native("standard_varcall", "dance_close", [_handle])
		_native.terminate()


func now_ns():
	return _call("dance_now", [])


func state():
	status = _call("dance_state", [_handle])
	return status


func status_text():
	return _call("dance_text", [status])


# {id: {slot, has_skeleton, has_hands, generation}}
func guests():
	var list = _call("dance_guests", [_handle])
	var found = {}
	for i in range(0, list.size(), 5):
		found[list[i]] = {
			"slot": list[i + 1], "has_skeleton": list[i + 2] != 0, "has_hands": list[i + 3] != 0,
			"generation": list[i + 4],
		}
	return found


# The newest pose, or with a time the one to show then: interpolated, or predicted.
func pose(slot, time_ns = 0):
	var read = _call("dance_pose_at", [_handle, slot, time_ns])
	status = read[0]
	if status != OK:
		return null
	var made = Pose.new()
	made.sequence = read[1]
	made.kind = read[2]
	made.presence = read[3]
	made.confidence = read[4]
	made.music_beats = read[5]
	made.time_ns = read[6]
	made.hips = Vector3(read[7][0], read[7][1], read[7][2])
	made.rotations = _quats(read[7], 3, BONES.size())
	return made


func skeleton(slot):
	var read = _call("dance_skeleton_of", [_handle, slot])
	status = read[0]
	if status != OK:
		return null
	var made = Proportions.new()
	made.version = read[1]
	made.numbers = read[2]
	made.offsets = _vectors(read[2], 0, BONES.size())
	made.tips = _vectors(read[2], 3 * BONES.size(), TIP_BONES.size())
	return made


# {presence, rotations}: 30 finger bones, left thumb to little, then right.
func hands(slot):
	var read = _call("dance_hands_of", [_handle, slot])
	status = read[0]
	if status != OK:
		return null
	return {"presence": read[1], "rotations": _quats(read[2], 0, 30)}


# {position_beats, tempo_bpm, beats_per_bar, confidence, playing} of the music heard here.
func beat(time_ns):
	var read = _call("dance_beat_at", [_handle, time_ns])
	status = read[0]
	if status != OK:
		return null
	return {
		"position_beats": read[1], "tempo_bpm": read[2], "beats_per_bar": read[3], "confidence": read[4],
		"playing": read[5] != 0,
	}


# {reads, retries, busy, damaged, attached}
func counters():
	var read = _call("dance_counted", [_handle])
	return {"reads": read[1], "retries": read[2], "busy": read[3], "damaged": read[4], "attached": read[5]}


# Where each bone is and how it is turned, as Transforms: forward kinematics.
static func world_of(pose, skeleton):
	var world = []
	for bone in range(BONES.size()):
		var parent = PARENTS[bone]
		if parent < 0:
			world.append(Transform(Basis(pose.rotations[bone]), pose.hips))
		else:
			world.append(world[parent] * Transform(Basis(pose.rotations[bone]), skeleton.offsets[bone]))
	return world


func _call(function, arguments):
	return _native.call_native("standard_varcall", function, arguments)


static func _quats(numbers, first, count):
	var made = []
	for i in range(count):
		var at = first + 4 * i
		made.append(Quat(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]))
	return made


static func _vectors(numbers, first, count):
	var made = []
	for i in range(count):
		var at = first + 3 * i
		made.append(Vector3(numbers[at], numbers[at + 1], numbers[at + 2]))
	return made
