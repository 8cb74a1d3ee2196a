extends SceneTree
# godot3-server --path PROJECT -s read_texture.gd: writes the texels of each imported Texture3D NAME to NAME.texels:
# four 32-bit numbers, width, height, depth and flags, and then RGBA as float32, x fastest, then y, then z.
#
# Decodes what the importer wrote instead of calling Texture3D.get_layer_data: the server of Godot 3.2 stores one image
# per texture and returns the last layer for all.

func import_of(name):
	var config = ConfigFile.new()
	return config.get_value("remap", "path", "") if config.load("res://" + name + ".import") == OK else ""

func write_texels(name):
	var from = File.new()
	var to = File.new()
	if from.open(import_of(name), File.READ) != OK or to.open("res://" + name + ".texels", File.WRITE) != OK:
		printerr("no texture " + name)
		return
	if from.get_buffer(4).get_string_from_ascii() != "GD3T":
		printerr("no Texture3D " + name)
		return
	var width = from.get_32()
	var height = from.get_32()
	var depth = from.get_32()
	var flags = from.get_32()
	var format = from.get_32()
	var compression = from.get_32()
	for number in [width, height, depth, flags]:
		to.store_32(number)
	for layer in range(depth):
		var image = Image.new()
		if compression == 0:
			# Lossless: PNG files with their lengths, of each mip level. There is one.
			if from.get_32() != 1:
				printerr("mip levels in " + name)
				return
			var length = from.get_32()
			from.get_buffer(4)
			image.load_png_from_buffer(from.get_buffer(length - 4))
		else:
			image.create(width, height, false, format)
			image.create_from_data(width, height, false, format, from.get_buffer(image.get_data().size()))
		image.lock()
		for y in range(height):
			for x in range(width):
				var color = image.get_pixel(x, y)
				for value in [color.r, color.g, color.b, color.a]:
					to.store_float(value)
		image.unlock()
	if from.get_position() != from.get_len():
		printerr("more than layers in " + name)

func _init():
	var folder = Directory.new()
	folder.open("res://")
	folder.list_dir_begin()
	var name = folder.get_next()
	while name != "":
		if name.ends_with(".import"):
			write_texels(name.get_basename())
		name = folder.get_next()
	quit()
