# Turns the bones of an avatar's Skeleton as a dancer's are, whatever way the rig's bones lie: each
# bone's turn in the world is the dancer's, on top of how the rig's bone lies in T-pose. Arms and legs
# of a rig in A-pose are straightened first. Bones that the rig lacks are left out.
extends Reference

const Adapter = preload("dance_adapter.gd")

# Limbs that are straightened, and the bone at their end.
const LIMBS = [[7, 8], [8, 9], [11, 12], [12, 13], [14, 15], [15, 16], [18, 19], [19, 20]]
const FEET = [16, 17, 20, 21]
# Names that common rigs use, in the order of BONES, without prefix, in lower case.
const MIXAMO = [
	"hips", "spine", "spine1", "spine2", "neck", "head",
	"leftshoulder", "leftarm", "leftforearm", "lefthand",
	"rightshoulder", "rightarm", "rightforearm", "righthand",
	"leftupleg", "leftleg", "leftfoot", "lefttoebase",
	"rightupleg", "rightleg", "rightfoot", "righttoebase",
]

var skeleton = null
var _bone_of = []  # index in the Skeleton of each of BONES, or -1
var _dancer_bone_of = {}  # and back
var _order = []  # indices of the Skeleton's bones, parents first
var _rest = []  # global rests
var _t_pose = []
var _turn_of = []
var _hips_height = 1.0
var _dancer_hips_height = 1.0


# False where the Skeleton has no hips by a known name. `names` gives others: {"hips": "pelvis", …}.
func setup(of_skeleton, names = {}):
	skeleton = of_skeleton
	_bone_of.clear()
	_dancer_bone_of.clear()
	_rest.clear()
	_turn_of.clear()
	_order = _parents_first()
	_rest.resize(skeleton.get_bone_count())
	if _order.size() != skeleton.get_bone_count():
		return false
	for i in _order:
		var parent = skeleton.get_bone_parent(i)
		var rest = skeleton.get_bone_rest(i)
		_rest[i] = rest if parent < 0 else _rest[parent] * rest
	for bone in range(Adapter.BONES.size()):
		var found = _find(bone, names)
		_bone_of.append(found)
		_turn_of.append(bone)
		if found >= 0:
			_dancer_bone_of[found] = bone
	if _bone_of[0] < 0:
		return false
	# A rig without upper chest carries its shoulders on the spine that it has.
	for bone in [3, 2, 1]:
		if _bone_of[bone] >= 0:
			_turn_of[bone] = 3
			break
	_hips_height = max(_rest[_bone_of[0]].origin.y, 0.05)
	_dancer_hips_height = _hips_height
	_straighten(null)
	return true


func set_dancer(dancer_skeleton):
	_dancer_hips_height = max(dancer_skeleton.offsets[0].y, 0.05)
	_straighten(dancer_skeleton)


func show(pose):
	var turns = []
	for bone in range(Adapter.BONES.size()):
		var parent = Adapter.PARENTS[bone]
		turns.append(pose.rotations[bone] if parent < 0 else turns[parent] * pose.rotations[bone])
	var world = []
	world.resize(_order.size())
	for i in _order:
		var parent = skeleton.get_bone_parent(i)
		var above = Quat() if parent < 0 else world[parent]
		var rest = skeleton.get_bone_rest(i)
		var lies = above * rest.basis.get_rotation_quat()
		if not _dancer_bone_of.has(i):
			world[i] = lies
			continue
		var bone = _dancer_bone_of[i]
		world[i] = (turns[_turn_of[bone]] * _t_pose[i]).normalized()
		var local = (lies.inverse() * world[i]).normalized()
		var moved = Vector3()
		if bone == 0:
			# The hips' place in the rest of the bone above it, which is not turned by a dancer.
			var at = Vector3(pose.hips.x, pose.hips.y * _hips_height / _dancer_hips_height, pose.hips.z)
			var base = Transform() if parent < 0 else _rest[parent]
			moved = rest.affine_inverse().xform(base.affine_inverse().xform(at))
		skeleton.set_bone_pose(i, Transform(Basis(local), moved))


# How each bone lies when the rig stands in the dancer's T-pose.
func _straighten(dancer_skeleton):
	_t_pose.resize(_order.size())
	var carries = []
	carries.resize(_order.size())
	for i in _order:
		var parent = skeleton.get_bone_parent(i)
		var bone = _dancer_bone_of.get(i, -1)
		var carry = Quat() if parent < 0 or bone in FEET else carries[parent]
		for limb in LIMBS:
			if limb[0] == bone and _bone_of[limb[1]] >= 0:
				var lies = carry.xform(_rest[_bone_of[limb[1]]].origin - _rest[i].origin)
				carry = _between(lies, _direction(limb, dancer_skeleton)) * carry
		carries[i] = carry
		_t_pose[i] = (carry * _rest[i].basis.get_rotation_quat()).normalized()


static func _direction(limb, dancer_skeleton):
	if dancer_skeleton != null and dancer_skeleton.offsets[limb[1]].length() > 0.01:
		return dancer_skeleton.offsets[limb[1]].normalized()
	if limb[0] >= 14:
		return Vector3.DOWN
	return Vector3.RIGHT if limb[0] < 10 else Vector3.LEFT


static func _between(from, to):
	var a = from.normalized()
	var b = to.normalized()
	var cosine = a.dot(b)
	if cosine < -0.9999 or a == Vector3() or b == Vector3():
		return Quat()
	var axis = a.cross(b)
	return Quat(axis.x, axis.y, axis.z, 1.0 + cosine).normalized()


# A Skeleton's bones may come in any order.
func _parents_first():
	var order = []
	var is_in = {-1: true}
	while order.size() < skeleton.get_bone_count():
		var before = order.size()
		for i in range(skeleton.get_bone_count()):
			if not is_in.has(i) and is_in.has(skeleton.get_bone_parent(i)):
				is_in[i] = true
				order.append(i)
		if order.size() == before:
			break  # a bone is above itself
	return order


func _find(bone, names):
	var name = Adapter.BONES[bone]
	if names.has(name):
		return skeleton.find_bone(names[name])
	for i in range(skeleton.get_bone_count()):
		var one = skeleton.get_bone_name(i)
		one = one.substr(one.find_last(":") + 1).to_lower().replace("mixamorig_", "").replace("_", "")
		if one == name.to_lower() or one == MIXAMO[bone]:
			return i
	return -1
