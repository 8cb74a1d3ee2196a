extends SceneTree
# godot3 --path PROJECT -s film.gd: what the demo shows of itself, picture after picture. The environment has SIZE, as
# 1280x720; FPS; TIMES, the first and the last second, as 0-11.5; and PICTURES, a file or pipe that gets the bytes of
# all pictures, 3 per pixel, or a folder for PNG files.

var main
var times

func _init():
	var size = OS.get_environment("SIZE").split_floats("x")
	times = OS.get_environment("TIMES").split_floats("-")
	OS.window_size = Vector2(size[0], size[1])
	main = load("res://main.tscn").instance()
	root.add_child(main)
	main.set_process(false)
	call_deferred("draw_all")

func draw_all():
	yield(self, "idle_frame")
	main.smoke.light_fraction = 0  # all of it: time does not count
	main.smoke.step_scale = 1.5
	var path = OS.get_environment("PICTURES")
	var folder = Directory.new().dir_exists(path)
	var file = File.new()
	if not folder and file.open(path, File.WRITE) != OK:
		printerr("film.gd: cannot write ", path)
		quit(1)
		return
	var fps = float(OS.get_environment("FPS"))
	for i in range(int((times[1] - times[0]) * fps)):
		main.play_to(times[0] + i / fps)
		yield(VisualServer, "frame_post_draw")
		var picture = root.get_texture().get_data()
		picture.flip_y()
		if folder:
			picture.save_png("%s/%04d.png" % [path, i])
		else:
			picture.convert(Image.FORMAT_RGB8)
			file.store_buffer(picture.get_data())
		yield(self, "idle_frame")
	file.close()
	quit()
