extends SceneTree
# godot3 --path PROJECT -s smoke_alone.gd: the smoke of the demo at 3 seconds, alone, and the same scene for `brume
# render`. Into the folder FOLDER it writes light.rgb, the smoke's light, and opaque.rgb, the smoke as white as light:
# 3 bytes a pixel, as displayed; timeline.toml and scene.txt. SIZE is the size of the pictures; HALF=1 draws the smoke
# at half the resolution.

const TIME = 3.0
const BRIGHTER = 4.0
# Godot's lights end at their range; those of Brume, and for this picture the add-on's, at that of their power.
const GODOT_LIGHT = "arriving *= pow(max(1.0 - away / place.w, 0.0), colour.w);"
const BRUME_LIGHT = """float reach_square = 100.0 * 3.14159265 * max(colour.r, max(colour.g, colour.b));
      float at_end = away * away / reach_square;
      float window = clamp(1.0 - at_end * at_end, 0.0, 1.0);
      arriving *= window * window / max(away * away, 0.01);"""

var main
var folder = OS.get_environment("FOLDER")

func _init():
	var size = OS.get_environment("SIZE").split_floats("x")
	OS.window_size = Vector2(size[0], size[1])
	main = load("res://main.tscn").instance()
	main.half = OS.get_environment("HALF") == "1"
	main.with_door = false
	root.add_child(main)
	main.set_process(false)
	call_deferred("draw_all")

func write(name, bytes):
	var file = File.new()
	file.open(folder + "/" + name, File.WRITE)
	file.store_buffer(bytes)
	file.close()

func draw(name):
	for i in range(2):
		yield(self, "idle_frame")
	yield(VisualServer, "frame_post_draw")
	var picture = root.get_texture().get_data()
	picture.flip_y()
	picture.convert(Image.FORMAT_RGB8)
	write(name, picture.get_data())

# Surfaces without light, for their depth.
func blacken(node):
	if node is MeshInstance and node.material_override is SpatialMaterial:
		node.material_override = SpatialMaterial.new()
		node.material_override.flags_unshaded = true
		node.material_override.albedo_color = Color(0, 0, 0)
	if node is WorldEnvironment:
		node.environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
		node.environment.tonemap_exposure = 1
	for child in node.get_children():
		blacken(child)

func replaced(code, old, new):
	if not old in code:
		printerr("smoke_alone.gd: the shader has no ", old)
	return code.replace(old, new)

func draw_all():
	yield(self, "idle_frame")
	main.smoke.light_fraction = 0
	# Brighter, for all that 8 bits can show.
	for light in main.stage.lights:
		light.light_energy *= BRIGHTER
	var sky = main.Stage.SKY
	main.smoke.material.set_shader_param("ambient", Plane(BRIGHTER * sky.r, BRIGHTER * sky.g, BRIGHTER * sky.b, 0))
	main.stage.beam.visible = false
	# The room alone: hinges, bulbs and flashes are not in the other picture.
	main.stage.hinge.visible = false
	for child in main.stage.get_children():
		if child is MeshInstance and child.material_override.flags_unshaded:
			child.visible = false
	blacken(main)
	main.throw(null)
	main.show_at(TIME)
	var shader = main.smoke.material.shader.code
	main.smoke.material.shader = Shader.new()
	main.smoke.material.shader.code = replaced(shader, GODOT_LIGHT, BRUME_LIGHT)
	yield(draw("light.rgb"), "completed")
	main.smoke.material.shader.code = replaced(shader, "* brume_light(position, texel, direction)", "* vec3(1.0)")
	yield(draw("opaque.rgb"), "completed")
	write("scene.txt", scene().to_utf8())
	write("timeline.toml", timeline().to_utf8())
	quit()

func numbers(of):
	var text = ""
	for number in of:
		text += (" " if text else "") + "%.9f" % number
	return text

func scene():
	var text = ""
	for box in main.Stage.BOXES:
		var middle = box[0] + box[1] / 2
		text += "Pale %s  0 0 0  %s\n" % [numbers([middle.x, middle.y, middle.z]), numbers([box[1].x, box[1].y, box[1].z])]
	for light in main.stage.lights:
		if light.visible and light.light_energy > 0:
			var at = light.global_transform.origin
			var color = light.light_color
			text += "LIGHT_SOURCE %s  %s  %.9f\n" % [numbers([at.x, at.y, at.z]), numbers([main.smoke.linear(color.r),
					main.smoke.linear(color.g), main.smoke.linear(color.b)]), 4 * PI * PI * light.light_energy]
	return text

func list(name, of):
	return "%s = [%s]\n" % [name, numbers(of).replace(" ", ", ")]

func timeline():
	var layout = main.match_.layout()
	var at = main.camera.translation
	var toward = at - main.camera.transform.basis.z
	var event = main.THROW
	var text = "version = 1\nscene = \"scene.txt\"\n[grid]\nvoxel = %f\n" % layout[6]
	text += "size = [%d, %d, %d]\n" % [layout[3], layout[4], layout[5]]
	text += list("origin", [layout[0], layout[1], layout[2]])
	text += "[smoke]\nvoxels = %d\nextinction = 3.0\n" % int(round(event[2] / pow(layout[6], 3)))
	text += list("albedo", [0.86, 0.86, 0.86]) + "anisotropy = 0.2\n"
	text += "[sky]\nbounce = 0.35\n" + list("ambient", [BRIGHTER * main.Stage.SKY.r,
			BRIGHTER * main.Stage.SKY.g, BRIGHTER * main.Stage.SKY.b])
	text += "[[camera]]\ntime = 0.0\n" + list("position", [at.x, at.y, at.z])
	text += list("target", [toward.x, toward.y, toward.z])
	text += "fov = %f\n[[event]]\ntype = \"smoke\"\ntime = 0.015625\n" % main.camera.fov
	text += list("from", [event[0].x, event[0].y, event[0].z]) + list("at", [event[1].x, event[1].y, event[1].z])
	return text
