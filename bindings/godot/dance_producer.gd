# The way back: poses of a tracker in this project become captures of the guest whose house runs
# `dance receive --from engine --guest <guest>`. Each call returns a status of dance_adapter.gd;
# without a house a pose is dropped.
extends Reference

var _native = null
var _handle = -1


func open(receiver_name = ""):
	close()
	_native = GDNative.new()
	_native.library = load(get_script().resource_path.get_base_dir().plus_file("dance_adapter.gdnlib"))
	if not _native.initialize():
		_native = null
		push_error("DanceGraph: libdance_godot.so and libdance_adapter.so.1 must be in the folder of this script")
		return false
	_handle = _call("dance_send_open", [receiver_name])
	return _handle >= 0


func close():
	if _native == null:
		return
	if _handle >= 0:
		_call("dance_send_close", [_handle])
	_handle = -1
	# Godot keeps what is not terminated, and fails over it at exit.
	_native.terminate()
	_native = null


func _notification(what):
	# As close(): what is being deleted cannot call functions of its own.
	if what == NOTIFICATION_PREDELETE and _native != null:
		_native.call_native("standard_varcall", "dance_send_close", [_handle])
		_native.terminate()


# hips: Vector3; rotations: a Quat for each of dance_adapter.gd's BONES; presence: bit b for bone b.
func send_pose(hips, rotations, presence = 0x3fffff, confidence = 1.0):
	var numbers = PoolRealArray([hips.x, hips.y, hips.z])
	numbers.append_array(_numbers_of(rotations))
	return _call("dance_send_pose", [_handle, numbers, presence, int(round(confidence * 1000.0))])


func send_hands(rotations, presence):
	return _call("dance_send_hands", [_handle, _numbers_of(rotations), presence])


# offsets: 22 Vector3 from each bone's parent in T-pose; tips: 5.
func send_skeleton(offsets, tips, version = 1):
	var numbers = PoolRealArray()
	for vector in offsets + tips:
		numbers.append_array(PoolRealArray([vector.x, vector.y, vector.z]))
	return _call("dance_send_skeleton", [_handle, numbers, version])


static func _numbers_of(rotations):
	var numbers = PoolRealArray()
	for q in rotations:
		numbers.append_array(PoolRealArray([q.x, q.y, q.z, q.w]))
	return numbers


func _call(function, arguments):
	return _native.call_native("standard_varcall", function, arguments)
