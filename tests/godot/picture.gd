extends SceneTree
# godot3 --path PROJECT -s picture.gd: pictures of the demo in the folder PICTURES, without smoke, with it, with
# holes of shots, and after a blast. SIZE is their width and height. Prints for each "smoky F", the fraction
# of pixels that differ from the first.

var main
var clear

func _init():
	var size = OS.get_environment("SIZE").split_floats("x")
	OS.window_size = Vector2(size[0], size[1])
	main = load("res://main.tscn").instance()
	root.add_child(main)
	main.set_process(false)
	call_deferred("draw_all")

func draw(name, time):
	main.show_at(time)
	for i in range(2):
		yield(self, "idle_frame")
	yield(VisualServer, "frame_post_draw")
	var picture = root.get_texture().get_data()
	picture.flip_y()
	picture.save_png(OS.get_environment("PICTURES") + "/" + name)
	picture.lock()
	if clear == null:
		clear = picture
	var smoky = 0
	for y in range(picture.get_height()):
		for x in range(picture.get_width()):
			var a = picture.get_pixel(x, y)
			var b = clear.get_pixel(x, y)
			if max(abs(a.r - b.r), abs(a.b - b.b)) > 0.03:
				smoky += 1
	print("smoky ", float(smoky) / (picture.get_width() * picture.get_height()))

func draw_all():
	yield(self, "idle_frame")
	main.smoke.light_fraction = 0  # times lie apart: all light each time
	yield(draw("godot_clear.png", 0.0), "completed")
	main.throw(null)
	yield(draw("godot_smoke.png", 6.0), "completed")
	for i in range(3):
		main.match_.shoot(main.camera.translation, main.in_front(5.6, 0.8 * i - 0.8, 0.3), 0.3)
	yield(draw("godot_holes.png", 6.4), "completed")
	main.blast(null)
	yield(draw("godot_blast.png", 6.7), "completed")
	quit()
