# A dancer without an avatar: its own bones as rounded limbs, in a colour of its own.
extends Spatial

const Adapter = preload("dance_adapter.gd")

# Half the thickness of the limb that ends at each bone (from its parent), in metres; 0 = none.
const RADII = [
	0.0, 0.11, 0.115, 0.12, 0.06, 0.05,
	0.07, 0.065, 0.046, 0.036, 0.07, 0.065, 0.046, 0.036,
	0.085, 0.07, 0.048, 0.042, 0.085, 0.07, 0.048, 0.042,
]
const TIP_RADII = [0.095, 0.035, 0.035, 0.035, 0.035]

var _limbs = []
var _tips = []


func setup(dancer_skeleton, colour):
	for child in get_children():
		child.free()
	_limbs.clear()
	_tips.clear()
	var material = SpatialMaterial.new()
	material.albedo_color = colour
	material.roughness = 0.6
	for bone in range(Adapter.BONES.size()):
		_limbs.append(_limb(dancer_skeleton.offsets[bone].length(), RADII[bone], material))
	for tip in range(Adapter.TIP_BONES.size()):
		_tips.append(_limb(dancer_skeleton.tips[tip].length() * (0.55 if tip == 0 else 1.0), TIP_RADII[tip], material))


func show_pose(pose, dancer_skeleton):
	var world = Adapter.world_of(pose, dancer_skeleton)
	for bone in range(1, Adapter.BONES.size()):
		_lay(_limbs[bone], world[Adapter.PARENTS[bone]].origin, world[bone].origin)
	for tip in range(Adapter.TIP_BONES.size()):
		var from = world[Adapter.TIP_BONES[tip]]
		var along = dancer_skeleton.tips[tip]
		var start = 0.35 if tip == 0 else 0.0
		_lay(_tips[tip], from.xform(along * start), from.xform(along))


func _limb(length, radius, material):
	var capsule = CapsuleMesh.new()
	capsule.radius = radius
	capsule.mid_height = max(length - 0.5 * radius, 0.001)
	capsule.radial_segments = 20
	capsule.rings = 6
	var made = MeshInstance.new()
	made.mesh = capsule
	made.material_override = material
	made.visible = radius > 0.0 and length > 0.001
	add_child(made)
	return made


# A capsule lies along its own Z.
static func _lay(limb, from, to):
	var along = to - from
	if along.length() < 0.001:
		return
	var z = along.normalized()
	var x = (Vector3.UP if abs(z.y) < 0.9 else Vector3.RIGHT).cross(z).normalized()
	limb.transform = Transform(Basis(x, z.cross(x), z), 0.5 * (from + to))
