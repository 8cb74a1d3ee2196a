"""The roadhouse: a low wing (room A, where the smoke goes off) and a gabled tower (room B, loft, washroom).

Metres, y up, the front looks to +z. Wing: x -7..0, z -6.5..0. Tower: x 0..7, z -8..2. Floors lie at y = 0.1.
"""
import numpy as np

from demo_geometry import Solid, rotation_y

FLOOR = 0.1
OUTER, INNER = 0.25, 0.1     # wall thickness
STOREY = 3.25                # top of the lower walls
WING_EAVES, TOWER_EAVES = 3.5, 5.6
WING_RISE, TOWER_RISE = 3.25 * np.tan(np.radians(27)), 3.5 * np.tan(np.radians(28))
HEAD = 2.45                  # top of doors and windows

# Openings in world coordinates: (from, to, bottom, top) along x or z.
FRONT_DOOR = (-3.2, -1.8, FLOOR, HEAD)
FRONT_WINDOW = (-6.0, -4.2, 1.0, HEAD)
SIDE_WINDOW = (-4.15, -2.5, 1.0, HEAD)          # z, west wall of the wing
INNER_DOOR = (-3.2, -1.8, FLOOR, HEAD)         # z, between the rooms
CORNER_WINDOW = (0.35, 1.6, 1.0, HEAD)          # z, west wall of the tower, towards the yard
GARAGE_DOOR = (1.3, 4.5, FLOOR, 2.95)
GABLE_WINDOW = (2.7, 4.3, 3.95, 5.3)
WASHROOM_WINDOW = (-6.9, -5.7, 1.3, HEAD)      # z, east wall
WASHROOM_DOOR = (-6.8, -5.5, FLOOR, HEAD)      # z

OUT_X, OUT_Z = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
RENDER = {"out": "plaster", "in": "plaster_in", "edge": "concrete", "base": (0.55, "brick")}
BRICK = {"out": "brick", "in": "plaster_in", "edge": "concrete"}
SIDING = {"out": "siding", "in": "planks", "edge": "trim"}


def along_x(materials, x, z, outward, y, height, thickness=OUTER, openings=()):
    """A wall along x whose inner face lies at z; `outward` is +1 or -1."""
    solid = Solid()
    holes = [(a - x[0], b - x[0], lo - y, hi - y) for a, b, lo, hi in openings]
    solid.wall(materials, (x[0], y, z), OUT_X, OUT_Z * outward, x[1] - x[0], height, thickness, holes)
    return solid


def along_z(materials, z, x, outward, y, height, thickness=OUTER, openings=()):
    """A wall along z whose inner face lies at x; `outward` is +1 or -1."""
    solid = Solid()
    holes = [(a - z[0], b - z[0], lo - y, hi - y) for a, b, lo, hi in openings]
    solid.wall(materials, (x, y, z[0]), OUT_Z, OUT_X * outward, z[1] - z[0], height, thickness, holes)
    return solid


def prism(material, polygon, sweep, turn=False):
    solid = Solid()
    solid.prism(material, polygon, sweep, turn)
    return solid


def box(material, low, high, turn=False, offset=(0, 0)):
    solid = Solid()
    solid.box(material, low, high, turn, offset)
    return solid


def wing(scene):
    high = WING_EAVES
    scene.add("wing_front", along_x(RENDER, (-7, 0), -0.25, 1, 0, high, openings=[FRONT_WINDOW, FRONT_DOOR]))
    scene.add("wing_back", along_x(RENDER, (-7, 0), -6.25, -1, 0, high))
    scene.add("wing_west", along_z(RENDER, (-6.25, -0.25), -6.75, -1, 0, high, openings=[SIDE_WINDOW]))
    apex = high + WING_RISE
    scene.add("wing_gable", prism("siding", [(-7, high, 0), (-7, high, -6.5), (-7, apex, -3.25)], (0.25, 0, 0)))
    scene.add("wing_ceiling", box("planks", (-6.75, 3.1, -6.25), (0, 3.25, -0.25)))
    scene.add("wing_floor", box("tiles", (-6.75, -0.05, -6.25), (0.0, FLOOR, -0.25)))
    slope, thick, over = np.tan(np.radians(27)), 0.16, 0.5
    for name, sign in (("front", 1), ("back", -1)):
        ridge, eave = (-7.45, apex, -3.25), (-7.45, high - over * slope, -3.25 + sign * (3.25 + over))
        lift = np.array([0, thick, 0])
        polygon = [np.array(eave), eave + lift, ridge + lift, np.array(ridge)]
        scene.add(f"wing_roof_{name}", prism({"side": "trim", 1: "corrugated", 3: "planks"}, polygon, (7.45, 0, 0)))
    ridge = Solid()
    ridge.tube("steel", [(-7.47, apex + thick - 0.01, -3.25), (0, apex + thick - 0.01, -3.25)], 0.07, 10)
    ridge.tube("dark_metal", [(-7.45, 3.24, 0.57), (-0.02, 3.20, 0.57)], 0.07, 10)
    ridge.tube("dark_metal", [(-7.2, 3.22, 0.57), (-7.1, 3.0, 0.35), (-6.92, 2.85, 0.09), (-6.92, 0.15, 0.09),
                              (-6.92, 0.08, 0.25)], 0.045, 10)
    scene.add("wing_gutter", ridge, ignore=True)
    chimney = Solid()
    chimney.box("brick", (-5.75, 3.25, -5.0), (-5.05, 6.15, -4.3))
    chimney.box("concrete", (-5.85, 6.15, -5.1), (-4.95, 6.28, -4.2))
    chimney.lathe("dark_metal", [(0, 6.28), (0.16, 6.28), (0.16, 6.62), (0.13, 6.62), (0.13, 6.4), (0, 6.4)], 20,
                  (-5.4, 0, -4.65))
    scene.add("chimney", chimney)


def porch(scene):
    canopy = Solid()
    canopy.prism({"side": "trim", 1: "corrugated"}, [(-3.65, 2.72, 1.25), (-3.65, 2.80, 1.25), (-3.65, 3.10, 0.0),
                                                     (-3.65, 3.02, 0.0)], (2.3, 0, 0))
    # Keeps the light's light a voxel away from the smoke above the canopy's edge.
    canopy.box("trim", (-3.65, 2.50, 1.25), (-1.35, 2.82, 1.33))
    scene.add("canopy", canopy)
    struts = Solid()
    for x in (-3.55, -1.45):
        struts.beam("trim", (x, 2.25, 0.0), (x, 2.78, 1.0), 0.07, 0.07)
        struts.beam("trim", (x, 2.15, 0.035), (x, 3.0, 0.035), 0.08, 0.07)
    scene.add("canopy_struts", struts, ignore=True)
    leaf = Solid()  # hinged at the door's east jamb; local x runs from the hinge
    leaf.box("door_paint", (0.0, 0.02, -0.025), (1.34, 2.30, 0.025))
    for z in (-0.034, 0.034):
        for y0, y1 in ((0.16, 0.98), (1.12, 2.16)):
            leaf.box("door_paint", (0.14, y0, z - 0.012), (1.20, y1, z + 0.012))
        leaf.beam("steel", (1.26, 1.02, z), (1.26, 1.02, z * 2.4), 0.03, 0.03)
        leaf.beam("steel", (1.28, 1.02, z * 2.4), (1.14, 1.02, z * 2.4), 0.025, 0.025)
    scene.add("door_leaf", leaf, (-1.79, FLOOR, 0.05), rotation_y(-72))


def frame(scene, name, axis, plane, opening, bars=True, sill=True, depth=0.09):
    """A trim around an opening, proud of the outer face at `plane`, and glazing bars. Smoke ignores it."""
    lo, hi, bottom, top = opening
    solid = Solid()
    at = (lambda s, y: (s, y, plane)) if axis == "x" else (lambda s, y: (plane, y, s))
    width = 0.09
    for s in (lo - width / 2, hi + width / 2):
        solid.beam("trim", at(s, bottom), at(s, top + width), depth if axis == "z" else width,
                   width if axis == "z" else depth)
    solid.beam("trim", at(lo, top + width / 2), at(hi, top + width / 2), depth, width)
    if sill:
        out = np.array(at(0, 0)) * 0
        out[2 if axis == "x" else 0] = 0.05 if axis == "x" or plane > 3 else -0.05
        solid.beam("concrete", at(lo - 0.14, bottom - 0.04) + out, at(hi + 0.14, bottom - 0.04) + out, 0.24, 0.08)
    if bars:
        middle = (lo + hi) / 2
        inset = np.zeros(3)
        inset[2 if axis == "x" else 0] = -0.14 if axis == "x" or plane > 3 else 0.14
        solid.beam("trim", at(middle, bottom) + inset, at(middle, top) + inset, 0.045, 0.045)
        third = bottom + (top - bottom) * 0.64
        solid.beam("trim", at(lo, third) + inset, at(hi, third) + inset, 0.04, 0.04)
    scene.add(name, solid, ignore=True)


def tower(scene):
    up, rise = TOWER_EAVES - STOREY, TOWER_RISE
    scene.add("tower_front", along_x(BRICK, (0, 7), 1.75, 1, 0, STOREY, openings=[GARAGE_DOOR]))
    scene.add("tower_front_upper", along_x(SIDING, (0, 7), 1.75, 1, STOREY, up, openings=[GABLE_WINDOW]))
    scene.add("tower_back", along_x(BRICK, (0, 7), -7.75, -1, 0, STOREY))
    scene.add("tower_back_upper", along_x(SIDING, (0, 7), -7.75, -1, STOREY, up))
    scene.add("tower_east", along_z(BRICK, (-7.75, 1.75), 6.75, 1, 0, STOREY, openings=[WASHROOM_WINDOW]))
    scene.add("tower_east_upper", along_z(SIDING, (-7.75, 1.75), 6.75, 1, STOREY, up))
    scene.add("tower_west_front", along_z(BRICK, (-0.25, 1.75), 0.25, -1, 0, STOREY, openings=[CORNER_WINDOW]))
    scene.add("tower_west_back", along_z(BRICK, (-7.75, -6.25), 0.25, -1, 0, STOREY))
    scene.add("tower_west_upper", along_z(SIDING, (-7.75, 1.75), 0.25, -1, STOREY, up))
    party = {"out": "plaster_in", "in": "plaster_in", "edge": "trim"}
    scene.add("partition_rooms", along_z(party, (-6.25, -0.25), 0.1, -1, 0, STOREY, INNER, [INNER_DOOR]))
    for name, z in (("front", 1.75), ("back", -8.0)):
        polygon = [(0, TOWER_EAVES, z), (7, TOWER_EAVES, z), (3.5, TOWER_EAVES + rise, z)]
        scene.add(f"tower_gable_{name}", prism("siding", polygon, (0, 0, 0.25)))
    slope, thick, over = np.tan(np.radians(28)), 0.18, 0.5
    for name, sign in (("west", -1), ("east", 1)):
        ridge = np.array([3.5, TOWER_EAVES + rise, -8.45])
        eave = np.array([3.5 + sign * (3.5 + over), TOWER_EAVES - over * slope, -8.45])
        lift = np.array([0, thick, 0])
        scene.add(f"tower_roof_{name}", prism({"side": "trim", 1: "shingles", 3: "planks"},
                                              [eave, eave + lift, ridge + lift, ridge], (0, 0, 10.9)))
    band = Solid()
    band.box("concrete", (-0.06, STOREY - 0.10, 2.0), (7.06, STOREY + 0.14, 2.09))
    band.box("concrete", (-0.06, STOREY - 0.10, 0.0), (0.0, STOREY + 0.14, 2.0))
    band.tube("steel", [(3.5, TOWER_EAVES + rise + thick, -8.5), (3.5, TOWER_EAVES + rise + thick, 2.5)], 0.07, 10)
    band.tube("dark_metal", [(7.08, TOWER_EAVES - 0.3, 1.9), (7.08, 0.15, 1.9), (7.2, 0.08, 1.95)], 0.045, 10)
    scene.add("tower_trim", band, ignore=True)


def rooms(scene):
    floors = Solid()
    floors.box("concrete", (0.0, -0.05, -6.25), (6.75, FLOOR, 1.75), offset=(0.5, 0.3))
    floors.box("concrete", (0.25, -0.05, -7.75), (6.75, FLOOR, -6.25), offset=(0.5, 0.3))
    scene.add("tower_floor", floors)
    scene.add("loft", box({"side": "planks", "top": "planks"}, (0.1, 2.92, -7.75), (6.75, 3.1, -3.4), turn=True))
    wash = {"out": "plaster_in", "in": "tiles", "edge": "trim"}
    scene.add("partition_washroom_side", along_z(wash, (-7.75, -5.0), 3.7, -1, FLOOR, 2.82, INNER, [WASHROOM_DOOR]))
    scene.add("partition_washroom_front", along_x(wash, (3.6, 6.75), -5.0, 1, FLOOR, 2.82, INNER))
    stair = Solid()
    for i in range(14):
        top, front = FLOOR + 0.2 * (i + 1), 0.38 - 0.27 * i
        stair.box("planks", (5.60, max(FLOOR, top - 0.3), front - 0.27), (6.75, top, front), offset=(0.37 * i, 0.1 * i))
    scene.add("stair", stair)
    rail = Solid()
    for i in range(0, 15, 2):
        x, y, z = 5.64, FLOOR + 0.2 * (i + 1), 0.245 - 0.27 * i
        rail.beam("dark_metal", (x, y - 0.05, z), (x, y + 0.9, z), 0.035, 0.035)
    rail.beam("planks", (5.64, FLOOR + 1.08, 0.30), (5.64, FLOOR + 4.02, -3.67), 0.06, 0.05)
    for x in np.arange(0.35, 5.6, 0.87):
        rail.beam("dark_metal", (x, 3.1, -3.46), (x, 4.05, -3.46), 0.035, 0.035)
    for y in (3.55, 4.05):
        rail.beam("planks" if y > 4 else "dark_metal", (0.12, y, -3.46), (5.6, y, -3.46), 0.05, 0.04)
    scene.add("railings", rail, ignore=True)
    for name, x, z, top in (("column_a", -4.40, -2.35, 3.1), ("column_b", 3.2, -3.85, 2.92)):
        column = Solid()
        radius = 0.42
        column.lathe("concrete", [(0, FLOOR), (radius + .06, FLOOR), (radius + .06, FLOOR + .12), (radius, FLOOR + .18),
                                  (radius, top - 0.16), (radius + .06, top - .1), (radius + .06, top), (0, top)], 40)
        scene.add(name, column, (x, 0, z))
    beams = Solid()
    for z in (-5.2, -3.2, -1.2):
        beams.box("planks", (-6.75, 2.94, z - 0.08), (0.0, 3.1, z + 0.08))
    for z in (-5.4, -2.6, 0.2):
        beams.beam("planks", (0.25, TOWER_EAVES - 0.1, z), (6.75, TOWER_EAVES - 0.1, z), 0.16, 0.2)
        beams.beam("planks", (3.5, TOWER_EAVES, z), (3.5, TOWER_EAVES + TOWER_RISE - 0.05, z), 0.14, 0.14)
    scene.add("ceiling_beams", beams, ignore=True)


def build(scene):
    wing(scene)
    porch(scene)
    tower(scene)
    rooms(scene)
    frame(scene, "frame_front_door", "x", 0.0, FRONT_DOOR, bars=False, sill=False)
    frame(scene, "frame_front_window", "x", 0.0, FRONT_WINDOW)
    frame(scene, "frame_side_window", "z", -7.0, SIDE_WINDOW)
    frame(scene, "frame_corner_window", "z", 0.0, CORNER_WINDOW)
    frame(scene, "frame_garage_door", "x", 2.0, GARAGE_DOOR, bars=False, sill=False)
    frame(scene, "frame_gable_window", "x", 2.0, GABLE_WINDOW)
    frame(scene, "frame_washroom_window", "z", 7.0, WASHROOM_WINDOW)
