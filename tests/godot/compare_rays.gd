extends SceneTree
# godot3 --path PROJECT -s compare_rays.gd: draws the smoke of the demo alone, as white as light, and compares each
# pixel with the optical depth of its ray. Prints "mean M worst W smoky S": errors of what smoke lets through, and the
# fraction of pixels with smoke.

const WIDTH = 96
const HEIGHT = 54

var match_ = preload("res://addons/brume/match.gdns").new()
var smoke = preload("res://addons/brume/smoke.gd").new()
var camera = Camera.new()

func _init():
	OS.window_size = Vector2(WIDTH, HEIGHT)
	var boxes = []
	for box in load("res://stage.gd").BOXES:
		boxes.append(AABB(box[0], box[1]))
	match_.level_from_boxes(boxes, 0.25)
	match_.throw_smoke(Vector3(-3.0, 1.5, -0.6), Vector3(-1.4, 0.3, -1.4), 45)
	match_.advance_to(340)
	match_.shoot(Vector3(-6.3, 1.9, 3.6), Vector3(-1, 1.2, -0.4), 0.3)
	match_.advance_to(380)
	call_deferred("compare")

func linear(channel):
	return channel / 12.92 if channel < 0.04045 else pow((channel + 0.055) / 1.055, 2.4)

func compare():
	camera.fov = 65
	camera.far = 60
	root.add_child(camera)
	camera.look_at_from_position(Vector3(-6.3, 1.9, 3.6), Vector3(1.2, 1.3, -1.6), Vector3.UP)
	root.add_child(smoke)
	smoke.follow(match_, [], Color(0, 0, 0))
	var shader = Shader.new()
	# All detail of the noise, in steps of 2 cm.
	shader.code = smoke.material.shader.code.replace("* brume_light(position, texel, direction)", "* vec3(1.0)") \
			.replace("jitter, pixel_width);", "jitter, 0.0);")
	smoke.material.shader = shader
	smoke.update(380 / 64.0)
	var constants = smoke.material.get_shader_param("brume_constants_4")
	constants.d = 0.02
	smoke.material.set_shader_param("brume_constants_4", constants)
	for i in range(2):
		yield(self, "idle_frame")
	yield(VisualServer, "frame_post_draw")
	var picture = root.get_texture().get_data()
	picture.flip_y()
	picture.lock()
	var ends = PoolVector3Array()
	for y in range(HEIGHT):
		for x in range(WIDTH):
			var at = Vector2(x + 0.5, y + 0.5)
			ends.append(camera.project_ray_origin(at))
			ends.append(camera.project_ray_origin(at) + 40 * camera.project_ray_normal(at))
	var depths = match_.drawn_depths(ends)
	var sum = 0.0
	var worst = 0.0
	var smoky = 0
	for i in range(len(depths)):
		var error = abs(linear(picture.get_pixel(i % WIDTH, i / WIDTH).g) - (1 - exp(-depths[i])))
		sum += error
		worst = max(worst, error)
		smoky += 1 if depths[i] > 0.01 else 0
	print("size ", picture.get_size(), " mean ", sum / len(depths), " worst ", worst, " smoky ",
			float(smoky) / len(depths))
	quit()
