extends SceneTree
# godot3-server --path PROJECT -s play_match.gd: plays the match that tests/api/long_match.c prints, MATCH, through the
# add-on, and writes its results as the C program does to RESULTS. Both are files named by the environment.

var match_ = preload("res://addons/brume/match.gdns").new()
var points = PoolVector3Array()
var indices = PoolIntArray()
var events = []
var ends = PoolVector3Array()

func point_of(words, at):
	return Vector3(float(words[at]), float(words[at + 1]), float(words[at + 2]))

func read(words):
	match words[0]:
		"point":
			points.append(point_of(words, 1))
		"triangle":
			for i in range(1, 4):
				indices.append(int(words[i]))
		"event":
			var members = PoolIntArray()
			for i in range(3, len(words)):
				members.append(int(words[i]))
			events.append([int(words[1]), int(words[2]), members])
		"line":
			ends.append(point_of(words, 1))
			ends.append(point_of(words, 4))

func write_results(file, tick):
	file.store_line("hash %d %s" % [tick, match_.hash()])
	var text = "depths %d" % tick
	for depth in match_.depths(ends):
		var bits = StreamPeerBuffer.new()
		bits.put_float(depth)
		bits.seek(0)
		text += " %08x" % bits.get_u32()
	file.store_line(text)
	text = "visible %d " % tick
	for i in range(0, len(ends), 2):
		text += "1" if match_.sees(ends[i], ends[i + 1], 3.0) else "0"
	file.store_line(text)

func play(file, ticks, every):
	var next = 0
	for tick in range(ticks + 1):
		while next < len(events) and events[next][1] == tick:
			match_.append(events[next][0], tick, events[next][2])
			next += 1
		match_.advance_to(tick)
		if tick % every == 0:
			write_results(file, tick)
		match_.forget_before(tick)

func _init():
	var input = File.new()
	var output = File.new()
	if input.open(OS.get_environment("MATCH"), File.READ) != OK or \
			output.open(OS.get_environment("RESULTS"), File.WRITE) != OK:
		printerr("no files")
		quit(1)
		return
	var words = input.get_line().split(" ")
	while words[0] != "play":
		read(words)
		words = input.get_line().split(" ")
	match_.level_from_triangles(points, indices, PoolByteArray(), 0.5)
	play(output, int(words[1]), int(words[2]))
	output.close()
	quit()
