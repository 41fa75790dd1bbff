# The way back from Godot: -s send_dancer.gd NAME SECONDS. A tracker's dancer with the left arm lowered, who walks along +X.
extends SceneTree

const Producer = preload("res://dance_producer.gd")

var producer = Producer.new()
var rotations = []
var sent = 0
var end = 0


func _init():
	Engine.target_fps = 60
	var arguments = OS.get_cmdline_args()
	producer.open(arguments[arguments.size() - 2])
	end = OS.get_ticks_msec() + int(float(arguments[arguments.size() - 1]) * 1000)
	for _bone in range(22):
		rotations.append(Quat())
	rotations[7] = Quat(0, 0, sin(-0.6), cos(-0.6))


func _idle(_delta):
	if producer.send_pose(Vector3(0.001 * (sent % 500), 0.9, 0), rotations) == 0:
		sent += 1
	if OS.get_ticks_msec() < end or end == 0:
		return
	end = 0
	print("sent %d" % sent)
	producer.close()
	quit()
