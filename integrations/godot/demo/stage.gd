extends Spatial
# What stands around the smoke: two rooms, a door, lights.

# Walls, floor, ceiling and crates as boxes, each with its colour and its pattern: 14 x 4 x 9 m with a doorway.
const BOXES = [
	[Vector3(-7.3, -0.3, -4.8), Vector3(14.6, 0.3, 9.6), Color(0.50, 0.46, 0.42), "tiles"],
	[Vector3(-7.3, 4, -4.8), Vector3(14.6, 0.3, 9.6), Color(0.62, 0.62, 0.60), "plaster"],
	[Vector3(-7.3, 0, -4.5), Vector3(0.3, 4, 9), Color(0.62, 0.52, 0.42), "plaster"],
	[Vector3(7, 0, -4.5), Vector3(0.3, 4, 9), Color(0.62, 0.52, 0.42), "plaster"],
	[Vector3(-7.3, 0, -4.8), Vector3(14.6, 4, 0.3), Color(0.55, 0.58, 0.60), "bricks"],
	[Vector3(-7.3, 0, 4.5), Vector3(14.6, 4, 0.3), Color(0.55, 0.58, 0.60), "bricks"],
	[Vector3(-0.15, 0, -4.5), Vector3(0.3, 4, 3.5), Color(0.60, 0.57, 0.52), "plaster"],
	[Vector3(-0.15, 0, 0.4), Vector3(0.3, 4, 4.1), Color(0.60, 0.57, 0.52), "plaster"],
	[Vector3(-0.15, 2.4, -1.1), Vector3(0.3, 1.6, 1.6), Color(0.60, 0.57, 0.52), "plaster"],
	[Vector3(-2.6, 0, 1.2), Vector3(1.1, 1.1, 1.1), Color(0.52, 0.34, 0.18), "planks"],
	[Vector3(-1.4, 0, 1.7), Vector3(0.8, 0.8, 0.8), Color(0.46, 0.31, 0.18), "planks"],
	[Vector3(-6.9, 0, -4.4), Vector3(1.2, 1.2, 1.2), Color(0.52, 0.34, 0.18), "planks"],
	[Vector3(3.0, 0, -3.6), Vector3(1.0, 1.8, 1.0), Color(0.52, 0.34, 0.18), "planks"]]
# Where the door stands when it is shut.
const DOORWAY = AABB(Vector3(-0.15, 0, -1), Vector3(0.3, 2.4, 1.4))
const BEAM_ENERGY = 9.0
const SKY = Color(0.022, 0.026, 0.036)

var lights = []
var beam  # through the doorway
var flash  # of a blast
var hinge
var patterns = {}

func _ready():
	for box in BOXES:
		add_child(body_of(box[0] + box[1] / 2, box[1], box[2], box[3]))
	hinge = Spatial.new()
	hinge.translation = Vector3(0, 0, -1)
	var leaf = body_of(Vector3(0, 1.2, 0.7), Vector3(0.09, 2.4, 1.4), Color(0.24, 0.29, 0.30), "planks")
	hinge.add_child(leaf)
	add_child(hinge)
	add_omni(Vector3(-2.7, 3.4, -3.1), Color(1.0, 0.80, 0.56), 3.4)
	add_omni(Vector3(-6.4, 3.2, 3.2), Color(0.62, 0.74, 0.86), 0.9)
	beam = add_beam(Vector3(6.4, 2.3, -0.35), Vector3(0, 1.15, -0.3), Color(0.42, 0.66, 1.0))
	flash = light_at(OmniLight.new(), Vector3(-2.4, 1.2, -1.3), Color(1.0, 0.6, 0.28), 0)
	flash.omni_range = 9
	flash.shadow_enabled = false
	add_environment()

func boxes():
	var all = []
	for box in BOXES:
		all.append(AABB(box[0], box[1]))
	return all

func body_of(middle, size, color, pattern):
	var body = MeshInstance.new()
	body.mesh = CubeMesh.new()
	body.mesh.size = size
	body.translation = middle
	body.material_override = SpatialMaterial.new()
	body.material_override.albedo_color = color
	body.material_override.albedo_texture = pattern_of(pattern)
	body.material_override.roughness = 0.85
	body.material_override.metallic_specular = 0.3
	body.material_override.uv1_triplanar = true
	body.material_override.flags_world_triplanar = true
	return body

func light_at(light, at, color, energy):
	light.translation = at
	light.light_color = color
	light.light_energy = energy
	light.shadow_enabled = true
	light.shadow_bias = 0.25
	add_child(light)
	lights.append(light)
	return light

func add_omni(at, color, energy):
	var light = light_at(OmniLight.new(), at, color, energy)
	light.omni_attenuation = 1.6
	light.omni_range = 11
	light.omni_shadow_mode = OmniLight.SHADOW_CUBE
	add_bulb(at + Vector3(0, 0.2, 0), Vector3(0.5, 0.1, 0.5), color)

# Shines through the doorway.
func add_beam(at, toward, color):
	var light = SpotLight.new()
	light.look_at_from_position(at, toward, Vector3.UP)
	var transform = light.transform
	light_at(light, at, color, BEAM_ENERGY)
	light.transform = transform
	light.spot_range = 20
	light.spot_attenuation = 1
	light.spot_angle = 24
	light.spot_angle_attenuation = 1.5
	add_bulb(at + 0.25 * (at - toward).normalized(), Vector3(0.3, 0.3, 0.3), color)
	var fill = OmniLight.new()
	fill.translation = Vector3(4.5, 2.8, 2.4)
	fill.light_color = color
	fill.light_energy = 0.35
	fill.omni_range = 8
	fill.shadow_enabled = true
	add_child(fill)
	return light

func add_bulb(at, size, color):
	var bulb = MeshInstance.new()
	bulb.mesh = CubeMesh.new()
	bulb.mesh.size = size
	bulb.translation = at
	bulb.cast_shadow = GeometryInstance.SHADOW_CASTING_SETTING_OFF
	bulb.material_override = SpatialMaterial.new()
	bulb.material_override.flags_unshaded = true
	bulb.material_override.albedo_color = color.lightened(0.5)
	add_child(bulb)

func add_environment():
	var around = WorldEnvironment.new()
	around.environment = Environment.new()
	around.environment.background_mode = Environment.BG_COLOR
	around.environment.background_color = Color(0, 0, 0)
	around.environment.ambient_light_color = Color(0.80, 0.87, 1.0)
	around.environment.ambient_light_energy = 0.045
	around.environment.tonemap_mode = Environment.TONE_MAPPER_FILMIC
	around.environment.tonemap_white = 3
	around.environment.tonemap_exposure = 1.1
	add_child(around)

# 0: shut, 1: open. Behind a door that is shut the beam is off, as light finds ways around its voxels.
func turn_door(part):
	hinge.rotation.y = deg2rad(105) * smoothstep(0, 1, part)
	beam.light_energy = BEAM_ENERGY * min(3 * part, 1)

# ---- Patterns, of one metre ----

func pattern_of(name):
	if not name in patterns:
		var image = Image.new()
		image.create(128, 128, false, Image.FORMAT_RGB8)
		var noise = OpenSimplexNoise.new()
		noise.seed = 7
		noise.octaves = 4
		noise.period = 40
		image.lock()
		for y in range(128):
			for x in range(128):
				var at = Vector2(x, y) / 128
				# The same at both ends.
				var ring = Vector3(cos(TAU * at.x), sin(TAU * at.x), cos(TAU * at.y)) * 60
				ring.y += 50 * sin(TAU * at.y)
				var grain = 0.93 + (0.12 if name == "planks" else 0.06) * noise.get_noise_3dv(ring)
				var shade = clamp(grain * joints(name, at), 0, 1)
				image.set_pixel(x, y, Color(shade, shade, shade))
		image.unlock()
		patterns[name] = ImageTexture.new()
		patterns[name].create_from_image(image, Texture.FLAGS_DEFAULT | Texture.FLAG_ANISOTROPIC_FILTER)
	return patterns[name]

# Dark lines between tiles, bricks and planks; neighbours differ a little.
func joints(name, at):
	var count = {"tiles": Vector2(2, 2), "bricks": Vector2(3, 8), "planks": Vector2(1, 6), "plaster": Vector2()}[name]
	if count == Vector2():
		return 1.0
	var scaled = at * count
	var row = floor(scaled.y)
	if name == "bricks":
		scaled.x = fposmod(scaled.x + 0.5 * fmod(row, 2), count.x)
	var cell = Vector2(floor(scaled.x), row)
	var within = scaled - cell
	var edge = min(min(within.x, 1 - within.x) / count.x, min(within.y, 1 - within.y) / count.y)
	var tone = 0.93 + 0.07 * sin(12.9 * cell.x + 78.2 * cell.y)
	return tone * lerp(0.62, 1.0, smoothstep(0.004, 0.012, edge))
