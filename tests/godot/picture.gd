extends SceneTree
# godot3 --path PROJECT -s picture.gd: pictures of the demo, PICTURES/smoke_N.png at the N-th time; after the second, shots
# have been fired, after the third there has been a blast.

var main

func _init():
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

func draw_all():
	yield(self, "idle_frame")
	yield(draw("smoke_0.png", 0.0), "completed")
	yield(draw("smoke_1.png", 6.0), "completed")
	for i in range(3):
		main.match_.shoot(main.camera.translation, Vector3(-1, 1.6 - 0.4 * i, 0.2 - 0.6 * i), 0.16)
	yield(draw("smoke_2.png", 6.4), "completed")
	main.match_.blast(Vector3(-2.0, 1.2, -1.4), 1.6)
	yield(draw("smoke_3.png", 6.7), "completed")
	quit()
