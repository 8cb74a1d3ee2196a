extends MeshInstance
# Draws the smoke of a match in front of everything that is opaque:
#
#   var smoke = preload("res://addons/brume/smoke.gd").new()
#   add_child(smoke)
#   smoke.follow(match_, [$OmniLight], Color(0.05, 0.06, 0.08))
#   ...
#   smoke.update(seconds)  # each frame

# As brume_texture_kind numbers them.
const NAMES = ["density", "displacement", "pages", "cells", "boundary", "corners", "holes", "masks", "noise", "detail",
		"light_volume"]
const FLAT = [4, 5, 6, 7]
const SMOOTH = [0, 1, 7, 8, 9, 10]
const REPEATED = [8, 9]
# Images of the same bytes for each brume_texture_format: Godot has none of integers.
const FORMATS = {1: Image.FORMAT_R8, 2: Image.FORMAT_RG8, 3: Image.FORMAT_RGBA8, 4: Image.FORMAT_RGBAH,
		5: Image.FORMAT_RGBAF, 6: Image.FORMAT_RG8, 7: Image.FORMAT_RF, 8: Image.FORMAT_RGF, 9: Image.FORMAT_RGBAF}

# How much of the light is found again in each update: the rest lags. 0: all of it.
export var light_fraction = 0.125
# Draws the smoke at half the resolution, a quarter of the cost: set it before follow. It takes the last two of the
# 20 layers of the scene.
export var half_resolution = false
# Length of the steps through the smoke; 1: 0.4 voxels.
export var step_scale = 1.0

const ON_SCREEN = 1 << 18
const APART = 1 << 19

var match_
var lights = []
var material
var half
var half_camera
var textures = []
var generations = []

# `sky`: what arrives from above and around. Lights are OmniLights, SpotLights and DirectionalLights.
func follow(new_match, new_lights, sky):
	match_ = new_match
	lights = new_lights
	material = material_of(preload("res://addons/brume/smoke.shader"))
	material.set_shader_param("ambient", Plane(sky.r, sky.g, sky.b, 0))
	if half_resolution:
		draw_apart()
	else:
		cover_screen(self, material)
	match_.make_textures(len(lights), true)
	textures.resize(len(NAMES))
	generations.resize(len(NAMES))

func material_of(shader):
	var made = ShaderMaterial.new()
	made.shader = shader
	return made

func cover_screen(instance, with_material):
	instance.mesh = QuadMesh.new()
	instance.mesh.size = Vector2(2, 2)
	instance.extra_cull_margin = 16384  # its vertices are on the screen, wherever it is
	instance.cast_shadow = GeometryInstance.SHADOW_CASTING_SETTING_OFF
	instance.material_override = with_material

# The smoke alone, in a viewport of its own: the scene is drawn there for its depth, then removed.
func draw_apart():
	half = Viewport.new()
	half.transparent_bg = true
	half.keep_3d_linear = true
	half.msaa = Viewport.MSAA_DISABLED
	half.render_target_update_mode = Viewport.UPDATE_ALWAYS
	half.shadow_atlas_size = 256
	half_camera = Camera.new()
	half_camera.environment = Environment.new()
	half_camera.cull_mask = ~ON_SCREEN & 0xfffff
	half.add_child(half_camera)
	for pass_ in [[material_of(preload("res://addons/brume/clear.shader")), 126], [material, 127]]:
		var quad = MeshInstance.new()
		cover_screen(quad, pass_[0])
		pass_[0].render_priority = pass_[1]
		quad.layers = APART
		half.add_child(quad)
	add_child(half)
	cover_screen(self, material_of(preload("res://addons/brume/enlarge.shader")))
	layers = ON_SCREEN
	material_override.set_shader_param("smoke", half.get_texture())

func update_half():
	var camera = get_viewport().get_camera()
	camera.cull_mask &= ~APART
	half.size = (get_viewport().size / 2).ceil()
	half_camera.global_transform = camera.global_transform
	half_camera.fov = camera.fov
	half_camera.keep_aspect = camera.keep_aspect
	half_camera.near = camera.near
	half_camera.far = camera.far

func update(seconds):
	var places = PoolVector3Array()
	var suns = PoolByteArray()
	for light in lights:
		suns.append(1 if light is DirectionalLight else 0)
		places.append(light.global_transform.basis.z.normalized() if light is DirectionalLight
				else light.global_transform.origin)
	match_.update_textures(seconds, places, suns, light_fraction)
	for kind in range(len(NAMES)):
		update_texture(kind)
	var constants = match_.constants()
	constants[19] *= step_scale
	for i in range(len(constants) / 4):
		# A Color would be converted from sRGB.
		material.set_shader_param("brume_constants_%d" % i, Plane(constants[4 * i], constants[4 * i + 1],
				constants[4 * i + 2], constants[4 * i + 3]))
	update_lights(places)
	if half:
		update_half()

func update_texture(kind):
	var layers = match_.changed_layers(kind)
	if len(layers) == 0:
		return
	var layout = match_.texture_layout(kind)
	var format = FORMATS[layout[0]]
	var flags = (Texture.FLAG_FILTER if kind in SMOOTH else 0) | (Texture.FLAG_REPEAT if kind in REPEATED else 0)
	var made = generations[kind] != layout[4]
	if made:
		generations[kind] = layout[4]
		textures[kind] = ImageTexture.new() if kind in FLAT else Texture3D.new()
		if not kind in FLAT:
			textures[kind].create(layout[1], layout[2], layout[3], format, flags)
	for z in layers:
		var image = Image.new()
		image.create_from_data(layout[1], layout[2], false, format, match_.layer(kind, z))
		if not kind in FLAT:
			textures[kind].set_layer_data(image, z)
		elif made:
			textures[kind].create_from_image(image, flags)
		else:
			textures[kind].set_data(image)
	if made:
		material.set_shader_param("brume_" + NAMES[kind], textures[kind])

# Light of an sRGB colour, as Godot converts those of its lights.
func linear(channel):
	return channel / 12.92 if channel < 0.04045 else pow((channel + 0.055) / 1.055, 2.4)

# The row of a light in the texture "lights".
func numbers_of(light, place):
	var energy = light.light_energy if light.visible else 0.0
	var far = [0.0, 1.0]
	var cone = [0.0, 0.0, 0.0, -2.0, 1.0]
	if light is OmniLight:
		far = [light.omni_range, light.omni_attenuation]
	elif light is SpotLight:
		far = [light.spot_range, light.spot_attenuation]
		var forward = -light.global_transform.basis.z.normalized()
		cone = [forward.x, forward.y, forward.z, cos(deg2rad(light.spot_angle)), light.spot_angle_attenuation]
	return [place.x, place.y, place.z, far[0], linear(light.light_color.r) * energy,
			linear(light.light_color.g) * energy, linear(light.light_color.b) * energy, far[1]] + cone + [0.0, 0.0, 0.0]

func update_lights(places):
	if len(lights) == 0:
		return
	var data = StreamPeerBuffer.new()
	for i in range(len(lights)):
		for number in numbers_of(lights[i], places[i]):
			data.put_float(number)
	var image = Image.new()
	image.create_from_data(4, len(lights), false, Image.FORMAT_RGBAF, data.data_array)
	var texture = ImageTexture.new()
	texture.create_from_image(image, 0)
	material.set_shader_param("lights", texture)
