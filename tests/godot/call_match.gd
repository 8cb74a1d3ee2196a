extends SceneTree
# godot3-server --path PROJECT -s call_match.gd: calls the methods of the add-on, and what must fail. Prints "expected: "
# and what does not hold, and "done" in the end.

const Match = preload("res://addons/brume/match.gdns")
const SECOND = 64

func expect(holds, what):
	if not holds:
		printerr("expected: ", what)

# A room of 20 x 6 x 20 m with a wall through its middle, in which is a doorway of 2 x 3 m.
func room():
	var m = Match.new()
	var boxes = [AABB(Vector3(-10, -0.5, -10), Vector3(20, 0.5, 20)), AABB(Vector3(-10, 6, -10), Vector3(20, 0.5, 20)),
			AABB(Vector3(-10.5, 0, -10), Vector3(0.5, 6, 20)), AABB(Vector3(10, 0, -10), Vector3(0.5, 6, 20)),
			AABB(Vector3(-10, 0, -10.5), Vector3(20, 6, 0.5)), AABB(Vector3(-10, 0, 10), Vector3(20, 6, 0.5)),
			AABB(Vector3(-0.25, 0, -10), Vector3(0.5, 6, 9)), AABB(Vector3(-0.25, 0, 1), Vector3(0.5, 6, 9))]
	expect(m.level_from_boxes(boxes, 0.5) == true, "a level of boxes")
	return m

func advance(m, ticks):
	for i in range(ticks):
		m.step()

func call_all():
	var m = room()
	var eye = Vector3(-6, 1.6, 0)
	var target = Vector3(6, 1.6, 0)
	expect(m.tick() == 0 and len(m.hash()) == 16, "tick 0")
	expect(m.sees(eye, target, 3.0), "through the doorway")
	expect(not m.sees(Vector3(-6, 1.6, 6), Vector3(6, 1.6, 6), 3.0), "not through the wall")
	m.throw_smoke(Vector3(-6, 1.5, 0), Vector3(-1, 0.5, 0), 120)
	advance(m, 2 * SECOND)
	expect(m.tick() == 2 * SECOND, "the tick after two seconds")
	expect(not m.sees(eye, target, 3.0), "not through smoke")
	var thick = m.depths(PoolVector3Array([eye, target]))[0]
	expect(thick > 3, "an optical depth above 3")
	m.shoot(eye, target, 0.3)
	advance(m, SECOND)
	expect(m.sees(eye, target, 3.0), "through the hole of a shot")
	advance(m, 2 * SECOND)
	expect(not m.sees(eye, target, 3.0), "a closed hole")
	m.blast(Vector3(-3, 1.5, 0), 4)
	advance(m, SECOND / 2)
	expect(m.depths(PoolVector3Array([eye, target]))[0] < 0.7 * thick, "less smoke after a blast")
	expect(m.edit(AABB(Vector3(-0.25, 0, -1), Vector3(0.5, 6, 2)), true), "a door that shuts")
	m.move(7, Vector3(1, 0, 1))
	advance(m, 1)
	expect(not m.sees(Vector3(-1, 5, 0), Vector3(1, 5, 0), 1e9), "not through a door")
	m.edit(AABB(Vector3(-0.25, 0, -1), Vector3(0.5, 6, 2)), false)
	advance(m, 1)
	expect(m.sees(Vector3(-1, 5, 0), Vector3(1, 5, 0), 1e9), "through an open door")

# What metres give is what the integers of events give.
func compare_events():
	var a = room()
	var b = room()
	a.throw_smoke(Vector3(-6, 1.5, 0), Vector3(-1, 0.5, 0), 120)
	b.append(1, 1, PoolIntArray([-6144, 1536, 0, -1024, 512, 0, 960, 64, 1152, 192]))
	a.advance_to(100)
	b.advance_to(100)
	expect(a.hash() == b.hash() and a.hash() != room().hash(), "equal hashes")

# Each of these is one error of Godot.
func fail():
	var m = Match.new()
	expect(m.step() == null, "no step without a level")
	m = room()
	expect(m.throw_smoke(Vector3(), 3, 1) == null, "no number as a point")
	expect(m.throw_smoke(Vector3(1e9, 0, 0), Vector3(), 1) == null, "no point beyond 16384 m")
	expect(m.level_from_boxes([AABB(), 3], 0.5) == null, "no number as a box")
	expect(m.depths(PoolVector3Array([Vector3()])) == null, "pairs of points")
	expect(m.sees(Vector3(), Vector3()) == null, "three arguments")
	expect(m.append(1, 0, PoolIntArray([0, 0, 0, 0, 0, 0, 0])) == null, "no smoke without voxels")
	expect(m.tick() == 0, "the level after errors")

func _init():
	call_all()
	compare_events()
	print("fails:")
	fail()
	print("done")
	quit()
