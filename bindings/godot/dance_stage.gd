# The dancers of a house in this scene: a node for each guest, made when it comes and freed when it
# leaves, posed in each frame for the time at which the frame is seen. Put it on a Spatial: that is
# the middle of the dance floor.
extends Spatial

const Adapter = preload("dance_adapter.gd")
const Rig = preload("dance_rig.gd")
const Bones = preload("dance_bones.gd")

const COLOURS = [Color("e4572e"), Color("2e86ab"), Color("f2a541"), Color("6a994e"), Color("9d4edd"), Color("d6336c")]

# Name of the house's memory; "" is the usual one.
export var house_name = ""
# Scenes with a Skeleton somewhere in them; a guest gets one by its id. None: its bones are drawn.
export(Array, PackedScene) var avatars = []
# {"hips": "name in the Skeleton", …} for rigs whose names are not known.
export var bone_names = {}
# How long after _process a frame is seen. Less than 0: the newest pose, as it came.
export var display_lead_ms = 25.0

signal guest_came(id, node)
signal guest_left(id)

var adapter = Adapter.new()
var figures = {}  # id -> Figure


class Figure:
	var id = ""
	var slot = 0
	var node = null
	var rig = null
	var skeleton = null
	var pose = null


# Also when it is put into the tree again, which _ready() does not hear of.
func _enter_tree():
	# After whatever else moves in this frame.
	process_priority = 1000
	set_process(adapter.open(house_name))


func _exit_tree():
	set_process(false)
	for id in figures.keys():
		_remove(id)
	adapter.close()


func _process(_delta):
	var here = adapter.guests()
	for id in figures.keys():
		var figure = figures[id]
		if not here.has(id) or here[id].slot != figure.slot or not is_instance_valid(figure.node):
			_remove(id)
	var seen_at = 0
	if display_lead_ms >= 0.0:
		seen_at = adapter.now_ns() + int(display_lead_ms * 1000000.0)
	for id in here:
		if not figures.has(id):
			var made = _make(id, here[id].slot)
			if made == null:
				continue
			figures[id] = made
			emit_signal("guest_came", id, made.node)
		_show(figures[id], seen_at)


func _remove(id):
	if is_instance_valid(figures[id].node):
		figures[id].node.queue_free()
	figures.erase(id)
	emit_signal("guest_left", id)


func _make(id, slot):
	var figure = Figure.new()
	figure.id = id
	figure.slot = slot
	if avatars.empty():
		figure.node = Bones.new()
	else:
		figure.node = avatars[_hash(id) % avatars.size()].instance()
		var skeleton = _skeleton_in(figure.node)
		figure.rig = Rig.new()
		if skeleton == null or not figure.rig.setup(skeleton, bone_names):
			push_error("DanceGraph: an avatar has no Skeleton with hips of a known name; set bone_names")
			figure.node.free()
			set_process(false)
			return null
	add_child(figure.node)
	return figure


func _show(figure, seen_at):
	var pose = adapter.pose(figure.slot, seen_at)
	var skeleton = adapter.skeleton(figure.slot)
	if pose == null or skeleton == null:
		return
	if figure.skeleton == null or figure.skeleton.numbers != skeleton.numbers:
		figure.skeleton = skeleton
		if figure.rig != null:
			figure.rig.set_dancer(skeleton)
		else:
			figure.node.setup(skeleton, COLOURS[_hash(figure.id) % COLOURS.size()])
	figure.pose = pose
	if figure.rig != null:
		figure.rig.show(pose)
	else:
		figure.node.show_pose(pose, figure.skeleton)


# The same for an id on every machine.
static func _hash(id):
	var hashed = 5381
	for letter in id.to_ascii():
		hashed = (hashed * 33 + letter) & 0x7fffffff
	return hashed


static func _skeleton_in(node):
	if node is Skeleton:
		return node
	for child in node.get_children():
		var found = _skeleton_in(child)
		if found != null:
			return found
	return null
