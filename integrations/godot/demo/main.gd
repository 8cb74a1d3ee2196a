extends Spatial
# Two rooms with smoke, which show what it does until you take over: W, A, S, D walk, the middle button turns. A click
# shoots, the right button throws a grenade where you look, space sets off a blast there, E opens and shuts the door,
# F begins from the start.

const SmokeMatch = preload("res://addons/brume/match.gdns")
const Smoke = preload("res://addons/brume/smoke.gd")
const Letters = preload("res://letters.gd")
const Stage = preload("res://stage.gd")
const TICKS = 64
const WORD = "BRUME"

# What happens of itself, by its time in seconds.
const SHOW = [[0.35, "throw"], [3.4, "shot", -1.0, 0.30], [3.52, "shot", -0.68, 0.16], [3.64, "shot", -0.36, 0.28],
		[3.76, "shot", -0.04, 0.10], [3.88, "shot", 0.28, 0.24], [4.0, "shot", 0.60, 0.14], [4.12, "shot", 0.92, 0.26],
		[5.7, "letter", 0], [5.82, "letter", 1], [5.94, "letter", 2], [6.06, "letter", 3], [6.18, "letter", 4],
		[8.1, "blast"], [9.3, "door"]]
const SHOW_ENDS = 13.0
const THROW = [Vector3(-5.0, 1.6, 3.0), Vector3(-2.9, 0.3, -1.2), 80]

var match_
var smoke
var camera
var stage
var masks
var seconds = 0.0
var next = 0
var guided = true
var door_opens = -1.0  # since when, or -1
# These two before the scene is ready: whether smoke has half the resolution, and whether there is a door.
var half = true
var with_door = true

func _ready():
	stage = Stage.new()
	add_child(stage)
	camera = Camera.new()
	camera.fov = 58
	add_child(camera)
	begin()

func begin():
	if smoke:
		smoke.queue_free()
	match_ = SmokeMatch.new()
	masks = Letters.add_to(match_)
	match_.level_from_boxes(stage.boxes(), 0.25)
	if with_door:
		match_.edit(Stage.DOORWAY, true)
	smoke = Smoke.new()
	smoke.half_resolution = half
	add_child(smoke)
	smoke.follow(match_, stage.lights, Stage.SKY)
	seconds = 0.0
	next = 0
	guided = true
	door_opens = -1.0
	place_camera(0)

# Moves the match and its picture to a time.
func show_at(time):
	seconds = time
	var tick = int(time * TICKS)
	match_.advance_to(tick)
	match_.forget_before(tick)
	stage.turn_door(0.0 if door_opens < 0 else min((time - door_opens) / 0.9, 1))
	smoke.update(time)

# The same, with what happens until then.
func play_to(time):
	while next < len(SHOW) and SHOW[next][0] <= time:
		match_.advance_to(max(match_.tick(), int(SHOW[next][0] * TICKS)))
		place_camera(SHOW[next][0])
		call(SHOW[next][1], SHOW[next])
		next += 1
	place_camera(time)
	stage.flash.light_energy = 5 * max(1 - (time - 8.1) / 0.35, 0) if time >= 8.1 else 0.0
	show_at(time)

func place_camera(time):
	var early = smoothstep(-1, 9, time)
	var late = smoothstep(8.4, 12.5, time)
	camera.look_at_from_position(
			Vector3(-5.8, 1.95, 4.1).linear_interpolate(Vector3(-4.8, 1.65, 3.8), early) + late * Vector3(1.2, -0.1, 0.1),
			Vector3(-2.5, 1.5, -2.5).linear_interpolate(Vector3(-1.9, 1.45, -2.2), early) + late * Vector3(1.3, -0.1, 1.2),
			Vector3.UP)

# A point in front of the camera, in metres to its right and above its axis.
func in_front(distance, right, up):
	return camera.transform.xform(Vector3(right, up, -distance))

func throw(_event):
	match_.throw_smoke(THROW[0], THROW[1], THROW[2])

func shot(event):
	match_.shoot(in_front(0.3, 0.2, -0.25), in_front(5.6, event[2], event[3]), 0.12)

func letter(event):
	var right = (event[2] - 0.5 * (len(WORD) - 1)) * 0.64 - 0.2
	# Larger farther away, as a hole is as wide at its end: they look alike from the camera.
	for distance in [3.0, 4.0, 5.0, 6.0]:
		var from = camera.translation.linear_interpolate(in_front(5.0, right, 0.15), distance / 5)
		match_.shoot_mask(from, in_front(10.0, 2 * right, 0.3), 0.1 * (distance + 0.5), masks[WORD[event[2]]], 1.5)

func blast(_event):
	match_.blast(stage.flash.translation, 2.3)

func door(_event):
	door_opens = seconds if door_opens < 0 else -1.0
	match_.edit(Stage.DOORWAY, door_opens < 0)

func _process(delta):
	walk(delta)
	var time = seconds + min(delta, 0.1)
	if guided and time > SHOW_ENDS:
		begin()
	elif guided:
		play_to(time)
	else:
		show_at(time)

func walk(delta):
	var way = Vector3()
	for key in [[KEY_W, Vector3(0, 0, -1)], [KEY_S, Vector3(0, 0, 1)], [KEY_A, Vector3(-1, 0, 0)],
			[KEY_D, Vector3(1, 0, 0)]]:
		if Input.is_key_pressed(key[0]):
			way += key[1]
	if way != Vector3():
		guided = false
	camera.translation += camera.transform.basis.xform(way) * 3 * delta

func _input(event):
	if event is InputEventMouseMotion and Input.is_mouse_button_pressed(BUTTON_MIDDLE):
		guided = false
		camera.rotation.y -= event.relative.x * 0.004
		camera.rotation.x = clamp(camera.rotation.x - event.relative.y * 0.004, -1.5, 1.5)
	elif event is InputEventMouseButton and event.pressed:
		guided = false
		if event.button_index == BUTTON_LEFT:
			match_.shoot(camera.translation, camera.translation + 10 * camera.project_ray_normal(event.position), 0.12)
		elif event.button_index == BUTTON_RIGHT:
			match_.throw_smoke(in_front(0.5, 0, 0), in_front(6, 0, 0), 70)
	elif event is InputEventKey and event.pressed and not event.echo:
		if event.scancode == KEY_SPACE:
			guided = false
			match_.blast(in_front(4, 0, 0), 2.3)
		elif event.scancode == KEY_E:
			door(null)
		elif event.scancode == KEY_F:
			begin()
