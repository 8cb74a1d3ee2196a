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

var match_
var lights = []
var textures = []
var generations = []

# `sky`: what arrives from above and around. Lights are OmniLights.
func follow(new_match, new_lights, sky):
	match_ = new_match
	lights = new_lights
	mesh = QuadMesh.new()
	mesh.size = Vector2(2, 2)
	extra_cull_margin = 16384  # its vertices are on the screen, wherever it is
	cast_shadow = GeometryInstance.SHADOW_CASTING_SETTING_OFF
	material_override = ShaderMaterial.new()
	material_override.shader = preload("res://addons/brume/smoke.shader")
	material_override.set_shader_param("ambient", Plane(sky.r, sky.g, sky.b, 0))
	match_.make_textures(len(lights), true)
	textures.resize(len(NAMES))
	generations.resize(len(NAMES))

func update(seconds):
	var positions = PoolVector3Array()
	for light in lights:
		positions.append(light.global_transform.origin)
	match_.update_textures(seconds, positions, light_fraction)
	for kind in range(len(NAMES)):
		update_texture(kind)
	var constants = match_.constants()
	for i in range(len(constants) / 4):
		# A Color would be converted from sRGB.
		material_override.set_shader_param("brume_constants_%d" % i, Plane(constants[4 * i], constants[4 * i + 1],
				constants[4 * i + 2], constants[4 * i + 3]))
	update_lights()

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
		material_override.set_shader_param("brume_" + NAMES[kind], textures[kind])

# Light of an sRGB colour, as Godot converts those of its lights.
func linear(channel):
	return channel / 12.92 if channel < 0.04045 else pow((channel + 0.055) / 1.055, 2.4)

func update_lights():
	if len(lights) == 0:
		return
	var data = StreamPeerBuffer.new()
	for light in lights:
		var at = light.global_transform.origin
		for number in [at.x, at.y, at.z, light.omni_range]:
			data.put_float(number)
		for channel in [light.light_color.r, light.light_color.g, light.light_color.b]:
			data.put_float(linear(channel) * light.light_energy)
		data.put_float(light.omni_attenuation)
	var image = Image.new()
	image.create_from_data(2, len(lights), false, Image.FORMAT_RGBAF, data.data_array)
	var texture = ImageTexture.new()
	texture.create_from_image(image, 0)
	material_override.set_shader_param("lights", texture)
