extends Spatial
# Two rooms with smoke. W, A, S, D walk, the middle button turns. A click shoots, the right button throws a grenade
# where you look, space sets off a blast there.

const SmokeMatch = preload("res://addons/brume/match.gdns")
const Smoke = preload("res://addons/brume/smoke.gd")
const TICKS = 64

# Walls, floor and ceiling as boxes, each with its colour: 14 x 4 x 9 m with a doorway in the middle.
const BOXES = [
	[Vector3(-7, -0.3, -4.5), Vector3(14, 0.3, 9), Color(0.55, 0.5, 0.45)],
	[Vector3(-7, 4, -4.5), Vector3(14, 0.3, 9), Color(0.8, 0.8, 0.78)],
	[Vector3(-7.3, 0, -4.5), Vector3(0.3, 4, 9), Color(0.75, 0.66, 0.55)],
	[Vector3(7, 0, -4.5), Vector3(0.3, 4, 9), Color(0.75, 0.66, 0.55)],
	[Vector3(-7, 0, -4.8), Vector3(14, 4, 0.3), Color(0.6, 0.66, 0.7)],
	[Vector3(-7, 0, 4.5), Vector3(14, 4, 0.3), Color(0.6, 0.66, 0.7)],
	[Vector3(-0.15, 0, -4.5), Vector3(0.3, 4, 3.5), Color(0.7, 0.7, 0.68)],
	[Vector3(-0.15, 0, 0.4), Vector3(0.3, 4, 4.1), Color(0.7, 0.7, 0.68)],
	[Vector3(-0.15, 2.4, -1), Vector3(0.3, 1.6, 1.4), Color(0.7, 0.7, 0.68)],
	[Vector3(-3.4, 0, 1.6), Vector3(1.2, 1.1, 1.2), Color(0.6, 0.4, 0.22)],
	[Vector3(3.0, 0, -2.6), Vector3(1.0, 1.8, 1.0), Color(0.6, 0.4, 0.22)]]

var match_
var smoke
var camera
var lights = []
var seconds = 0.0

func _ready():
	match_ = SmokeMatch.new()
	var boxes = []
	for box in BOXES:
		boxes.append(AABB(box[0], box[1]))
		add_box(box[0], box[1], box[2])
	match_.level_from_boxes(boxes, 0.25)
	add_light(Vector3(-4.2, 3.0, -0.5), Color(1.0, 0.78, 0.5))
	add_light(Vector3(3.6, 3.0, -0.3), Color(0.55, 0.72, 1.0))
	add_environment()
	camera = Camera.new()
	camera.fov = 65
	add_child(camera)
	camera.look_at_from_position(Vector3(-6.3, 1.9, 3.6), Vector3(1.2, 1.3, -1.6), Vector3.UP)
	smoke = Smoke.new()
	add_child(smoke)
	smoke.follow(match_, lights, Color(0.03, 0.033, 0.036))
	throw_smoke(Vector3(-3.0, 1.5, -0.6), Vector3(-1.0, 0.3, -0.6))

func add_box(low, size, color):
	var body = MeshInstance.new()
	body.mesh = CubeMesh.new()
	body.mesh.size = size
	body.translation = low + size / 2
	body.material_override = SpatialMaterial.new()
	body.material_override.albedo_color = color
	body.material_override.roughness = 0.9
	add_child(body)

func add_light(at, color):
	var light = OmniLight.new()
	light.translation = at
	light.light_color = color
	light.light_energy = 3.2
	light.omni_attenuation = 2
	light.omni_range = 12
	light.shadow_enabled = true
	light.omni_shadow_mode = OmniLight.SHADOW_CUBE
	light.shadow_bias = 0.3
	add_child(light)
	lights.append(light)

func add_environment():
	var environment = WorldEnvironment.new()
	environment.environment = Environment.new()
	environment.environment.background_mode = Environment.BG_COLOR
	environment.environment.background_color = Color(0, 0, 0)
	environment.environment.ambient_light_color = Color(0.85, 0.9, 1.0)
	environment.environment.ambient_light_energy = 0.1
	environment.environment.tonemap_mode = Environment.TONE_MAPPER_FILMIC
	add_child(environment)

func throw_smoke(from, at):
	match_.throw_smoke(from, at, 70)

# Moves the match and its picture to a time.
func show_at(time):
	seconds = time
	var tick = int(time * TICKS)
	match_.advance_to(tick)
	match_.forget_before(tick)
	smoke.update(time)

func _process(delta):
	walk(delta)
	show_at(seconds + min(delta, 0.1))

func walk(delta):
	var way = Vector3()
	for key in [[KEY_W, Vector3(0, 0, -1)], [KEY_S, Vector3(0, 0, 1)], [KEY_A, Vector3(-1, 0, 0)],
			[KEY_D, Vector3(1, 0, 0)]]:
		if Input.is_key_pressed(key[0]):
			way += key[1]
	camera.translation += camera.transform.basis.xform(way) * 3 * delta

func ahead(distance):
	return camera.translation - camera.transform.basis.z * distance

func _input(event):
	if event is InputEventMouseMotion and Input.is_mouse_button_pressed(BUTTON_MIDDLE):
		camera.rotation.y -= event.relative.x * 0.004
		camera.rotation.x = clamp(camera.rotation.x - event.relative.y * 0.004, -1.5, 1.5)
	elif event is InputEventMouseButton and event.pressed:
		if event.button_index == BUTTON_LEFT:
			match_.shoot(camera.translation, camera.translation + 10 * camera.project_ray_normal(event.position), 0.12)
		elif event.button_index == BUTTON_RIGHT:
			throw_smoke(ahead(0.5), ahead(6))
	elif event is InputEventKey and event.pressed and event.scancode == KEY_SPACE:
		match_.blast(ahead(4), 2.5)
