"""The courtyard of scenes/flyby: floor, pad, dock with steps and ramp, gantry, walls, and things that stand about.

Metres; the yard is x -15 .. 15, z -10 .. 10, its floor y = 0; the pad's top is y = 0.06, the dock's y = 0.9.
"""
import numpy as np

from flyby_textures import REPEAT_M
from hard_surface import ALONG_X, ALONG_Z, Model, chamfer_box, extrude, lathe, placed, rotation, rounded, tube

MATERIALS = {
    "slabs": dict(texture="slabs", roughness=0.85),
    "pad": dict(texture="pad", roughness=0.8),
    "panels": dict(texture="panels", roughness=0.85),
    "plinth": dict(texture="slabs", color=(0.82, 0.82, 0.84), roughness=0.85),
    "sheet": dict(texture="corrugated", color=(0.30, 0.40, 0.45), roughness=0.5, metallic=0.2),
    "box_teal": dict(texture="corrugated", color=(0.10, 0.29, 0.30), roughness=0.55, metallic=0.1),
    "band": dict(color=(0.115, 0.175, 0.20), roughness=0.6),
    "band_line": dict(color=(0.60, 0.20, 0.03), roughness=0.6),
    "coping": dict(color=(0.40, 0.40, 0.39), roughness=0.85),
    "asphalt": dict(color=(0.13, 0.13, 0.13), roughness=0.95),
    "cast": dict(color=(0.40, 0.395, 0.38), roughness=0.85),
    "yellow": dict(color=(0.66, 0.40, 0.035), roughness=0.5),
    "paint": dict(color=(0.52, 0.41, 0.10), roughness=0.75),
    "white": dict(color=(0.56, 0.55, 0.52), roughness=0.75),
    "black": dict(color=(0.030, 0.030, 0.032), roughness=0.6),
    "steel": dict(color=(0.33, 0.34, 0.35), roughness=0.45, metallic=0.7),
    "dark": dict(color=(0.070, 0.075, 0.080), roughness=0.55, metallic=0.2),
    "crate": dict(color=(0.36, 0.37, 0.31), roughness=0.6),
    "crate_lid": dict(color=(0.22, 0.24, 0.21), roughness=0.6),
    "drum_blue": dict(color=(0.045, 0.15, 0.28), roughness=0.42),
    "drum_red": dict(color=(0.40, 0.055, 0.030), roughness=0.42),
    "tank": dict(color=(0.62, 0.62, 0.60), roughness=0.4),
    "timber": dict(color=(0.33, 0.22, 0.12), roughness=0.85),
    "glow_strip": dict(color=(0.7, 0.7, 0.7), emission=(2.6, 2.5, 2.2)),
}

DOCK = (-10.0, -2.0, -9.8, -5.4)  # x, x, z, z
DOCK_Y = 0.9


def textured():
    return Model(REPEAT_M | {"plinth": 2.0, "sheet": 1.6, "box_teal": 0.8})


def slab_marks(model, material, outline, height=0.006):
    """Paint on the floor: a thin slab over (x, z) points, sunk into it."""
    model.add(material, extrude([(z, x) for x, z in outline], -0.02, height))


def ground(scene):
    apron = Model()
    for low, high in (((-60, -0.5, -60), (60, -0.05, -10.6)), ((-60, -0.5, 10), (60, -0.05, 60)),
                      ((-60, -0.5, -10.6), (-15, -0.05, 10)), ((15, -0.5, -10.6), (60, -0.05, 10))):
        apron.box("asphalt", low, high)
    scene.add("apron", apron, ignore=True)
    floor = textured()
    floor.box("slabs", (-15.05, -0.4, -10.65), (15.05, 0, 10.05))
    scene.add("floor", floor)
    top = textured()
    top.add("plinth", extrude([(-1.0, -3.05), (5.0, -3.05), (5.0, 3.05), (-1.0, 3.05)], -0.1, 0.045, 0.04))
    # One image covers the top exactly: its middle, (0, 2), is the image's.
    top.add("pad", extrude([(-.95, -2.98), (4.95, -2.98), (4.95, 2.98), (-.95, 2.98)], -0.05, 0.06, 0.012),
            uv_offset=(0.5, 0.5 - 2.0 / REPEAT_M["pad"]))
    scene.add("pad", top)
    marks = Model()
    for x in (-4.6, 4.6):  # a lane past the pad, and a dashed line along the front
        slab_marks(marks, "paint", [(x - .07, -4.9 if x > 0 else -3.4), (x + .07, -4.9 if x > 0 else -3.4),
                                    (x + .07, 9.6), (x - .07, 9.6)])
    for k in range(12):
        x = -13.4 + 2.4 * k
        slab_marks(marks, "white", [(x, 6.94), (x + 1.3, 6.94), (x + 1.3, 7.06), (x, 7.06)], 0.0075)
    for k in range(7):  # hatching before the roller door
        x = 6.2 + 0.75 * k
        slab_marks(marks, "paint", [(x, -9.35), (x + .18, -9.35), (x + .98, -7.95), (x + .80, -7.95)])
    slab_marks(marks, "paint", [(5.9, -7.90), (12.2, -7.90), (12.2, -7.78), (5.9, -7.78)])
    scene.add("marks", marks, ignore=True)
    drain = Model()
    drain.box("dark", (-13.6, -0.03, 5.55), (13.6, 0.004, 5.85))
    for k in range(68):
        drain.box("steel", (-13.55 + 0.4 * k, -0.02, 5.57), (-13.25 + 0.4 * k, 0.012, 5.83), 0.004)
    scene.add("drain", drain, ignore=True)


def dock(scene):
    """The loading dock with steps towards the yard and a ramp towards +x."""
    x0, x1, z0, z1 = DOCK
    out = textured()
    out.box("panels", (x0, -0.1, z0), (x1, DOCK_Y - .06, z1))
    out.box("coping", (x0 - .05, DOCK_Y - .10, z0 + .01), (x1 + .05, DOCK_Y, z1 + .05), .02)
    for k in range(4):  # four treads below the top
        top = DOCK_Y * (4 - k) / 5
        out.add("cast", step(top, z1 + .36 * k, z1 + .36 * (k + 1), .004 * k))
        out.box("yellow", (-7.86, top - .03, z1 + .36 * (k + 1) - .085),
                (-4.94, top + .007, z1 + .36 * (k + 1) - .035),
                .003)
    for x in (-8.12, -4.72):  # cheeks beside the steps
        outline = [(-.1, z1 - .02), (DOCK_Y + .06, z1 - .02), (DOCK_Y + .06, z1 + .12), (.20, z1 + 1.58),
                   (-.1, z1 + 1.58)]
        out.add("coping", extrude(outline, x - .10, x + .10, .018, axis=0))
    length = 4.2
    wedge = [(-.1, x1 + .04), (DOCK_Y - .012, x1 + .04), (.004, x1 + length), (-.1, x1 + length)]  # (y, x)
    out.add("plinth", placed(extrude([(x, y) for y, x in wedge], -9.2, -6.7, axis=2)))
    for z in (-9.32, -6.58):
        kerb = [(x1 + .04, -.1), (x1 + length, -.1), (x1 + length, .12), (x1 + .04, DOCK_Y + .11)]
        out.add("coping", extrude(kerb, z - .11, z + .11, .018, axis=2))
    for k in range(9):  # grip bars across the ramp
        x = x1 + .35 + .42 * k
        y = DOCK_Y - .012 - (DOCK_Y - .016) * (x - x1 - .04) / (length - .04)
        tilt = -np.degrees(np.arctan2(DOCK_Y - .016, length - .04))
        out.add("dark", chamfer_box((-.025, -.02, -9.0), (.025, .012, -6.9), .005), rotation("z", tilt), (x, y, 0))
    rail = Model()
    posts = [(x0 + .2, z1 - .12), (-8.75, z1 - .12)], [(-4.1, z1 - .12), (x1 - .15, z1 - .12)]
    for (xa, z), (xb, _) in posts:
        for x in np.linspace(xa, xb, 3):
            rail.add("yellow", tube([(x, DOCK_Y - .03, z), (x, DOCK_Y + 1.02, z)], .024, 12))
            rail.add("dark", lathe([(0, -.01), (.06, -.01), (.06, .012), (0, .012)], 16), None, (x, DOCK_Y, z))
        for y in (DOCK_Y + .55, DOCK_Y + 1.02):
            rail.add("yellow", tube([(xa - .02, y, z), (xb + .02, y, z)], .0236 if y < 1.6 else .027, 12))
    scene.add("dock", out)
    scene.add("rails", rail, ignore=True)


def step(top, near, far, inward):
    """Its ends are inside of the cheeks, each in a plane of its own."""
    outline = [(-.1 - inward, near - .03), (top, near - .03), (top, far), (-.1 - inward, far)]  # (y, z)
    return extrude(outline, -8.05 + inward, -4.79 - inward, .012, axis=0)


def walls(scene):
    out = textured()
    back = -10.0
    for xa, xb in ((-15, 6.4), (11.6, 15)):
        out.box("panels", (xa, -.1, back - .5), (xb, 4.6, back))
    out.box("panels", (6.4, 3.6, back - .5), (11.6, 4.6, back - .004))
    # A painted band between the pilasters.
    for xa, xb in ((-14.34, -11.56), (-11.04, -1.56), (-1.04, 5.34), (12.66, 14.34)):
        out.box("band", (xa, -.05, back - .05), (xb, 1.30, back + .018), .006)
        out.box("band_line", (xa, 1.33, back - .05), (xb, 1.39, back + .016), .005)
    out.box("coping", (-15.1, 4.56, back - .6), (15.1, 4.78, back + .10), .03)
    for x in (-14.6, -11.3, -1.3, 5.6, 12.4, 14.6):  # pilasters
        out.box("panels", (x - .3, -.1, back - .1), (x + .3, 4.50, back + .28), .045)
    out.box("sheet", (6.5, -.05, back - .34), (11.5, 3.7, back - .26))
    for x in (6.4, 11.6):  # frame of the roller door
        out.box("yellow", (x - .14, -.1, back - .40), (x + .14, 3.72, back + .07), .02)
    out.box("yellow", (6.2, 3.52, back - .42), (11.8, 3.80, back + .08), .02)
    for k in range(9):
        out.box("dark", (6.55, .36 + .37 * k, back - .27), (11.45, .40 + .37 * k, back - .245), .008)
    out.add("dark", chamfer_box((-9.2, .85, back - .1), (-8.0, 3.1, back + .05), .02))  # a door on the dock
    out.box("drum_blue", (-9.12, .87, back), (-8.08, 3.02, back + .075), .015)
    out.box("steel", (-8.28, 1.85, back + .05), (-8.16, 1.95, back + .13), .01)
    for x, way in ((-15, 1), (15, -1)):  # low walls at both sides
        xa, xb = sorted((x, x - .4 * way))
        out.box("panels", (xa, -.1, -9.99), (xb, 1.5, 9.6))
        out.box("coping", (xa - .08, 1.46, -9.7), (xb + .08, 1.62, 9.7), .03)
    for x in (-6.3, 1.9):  # windows with frames and a sill
        out.box("dark", (x - 1.5, 2.1, back - .05), (x + 1.5, 3.5, back + .035), .012)
        for a in (-1.5, -.5, .5, 1.5):
            out.box("steel", (x + a - .05, 2.05, back), (x + a + .05, 3.55, back + .09), .012)
        out.box("coping", (x - 1.68, 1.95, back - .02), (x + 1.68, 2.07, back + .20), .02)
        out.box("coping", (x - 1.68, 3.52, back - .02), (x + 1.68, 3.63, back + .16), .02)
    scene.add("walls", out)
    pipes = Model()
    for y, r, name in ((4.05, .11, "steel"), (3.80, .06, "drum_red")):
        end = [(-1.75, y, back + .16), (-1.75 + (4.05 - y) * .6, y, back + .16), (5.1, y, back + .16)]
        pipes.add(name, tube([end[0], end[-1]], r, 20))
        for x in (-1.0, 1.0, 3.0, 4.8):
            pipes.add("dark", placed(lathe([(r - .02, -.05), (r + .018, -.05), (r + .018, .05), (r - .02, .05)], 20,
                                           True),
                                     ALONG_X), None, (x, y, back + .16))
    pipes.add("steel", tube([(13.4, -.05, back + .13), (13.4, 4.3, back + .13)], .07, 16))
    for y in (.6, 2.0, 3.4):
        pipes.add("dark", lathe([(.05, -.03), (.09, -.03), (.09, .03), (.05, .03)], 16, True), None,
                  (13.4, y, back + .13))
    scene.add("pipes", pipes, ignore=True)


def gantry(scene):
    """Two pillars and a yellow crane beam across the yard."""
    for i, x in enumerate((-6.6, 6.6)):
        out = Model()
        z = -2.6
        out.add("cast", extrude(rounded([(-.55, -.55), (.55, -.55), (.55, .55), (-.55, .55)], .08), -.05, .38, .03),
                None,
                (x, 0, z))
        pillar = [(0, .30), (.36, .30), (.36, .50), (.30, .58), (.30, 4.30), (.36, 4.40), (.36, 4.62), (0, 4.62)]
        out.add("cast", lathe(pillar, 40), None, (x, 0, z), crease=32.0)
        for k in range(4):
            out.add("yellow" if k % 2 == 0 else "black",
                    lathe([(.25, .80 + .16 * k), (.309, .80 + .16 * k), (.309, .955 + .16 * k), (.25, .955 + .16 * k)],
                          40,
                          loop=True), None, (x, 0, z))
        scene.add(f"pillar_{i}", out)
    beam = Model()
    for low, high in (((-7.6, 4.60, -2.82), (7.6, 4.68, -2.38)), ((-7.59, 4.66, -2.64), (7.59, 5.10, -2.56)),
                      ((-7.6, 5.08, -2.82), (7.6, 5.16, -2.38))):
        beam.box("yellow", low, high, .012)
    for k in range(13):
        x = -7.2 + 1.2 * k
        beam.box("yellow", (x - .02, 4.67, -2.79), (x + .02, 5.09, -2.41), .005)
    beam.box("dark", (2.5, 4.34, -2.95), (3.5, 4.61, -2.25), .04)
    beam.add("steel", tube([(3, 4.36, -2.6), (3, 3.55, -2.6)], .018, 8))
    beam.box("yellow", (2.86, 3.30, -2.70), (3.14, 3.58, -2.50), .03)
    hook = [(3, 3.33, -2.6), (3, 3.20, -2.6), (3.08, 3.10, -2.6), (3.06, 2.98, -2.6), (2.96, 2.96, -2.6),
            (2.90, 3.04, -2.6)]
    beam.add("steel", tube(hook, [.03, .03, .035, .035, .028, .012], 10), crease=50.0)
    scene.add("gantry", beam)


def crate(size, tall):
    """A composite transport box: chamfered body, lid, ribs, corner blocks, latches."""
    out, half = Model(), size / 2
    out.box("crate", (-half + .03, .02, -half + .03), (half - .03, tall * .80, half - .03), .02)
    out.box("crate_lid", (-half, tall * .78, -half), (half, tall, half), .03)
    out.box("crate_lid", (-half, -.01, -half), (half, .10, half), .02)
    for a in (-1, 1):
        for b in (-1, 1):
            x, z = a * (half - .055), b * (half - .055)
            out.box("crate_lid", (x - .05, .05, z - .05), (x + .05, tall * .82, z + .05), .018)
        for t in (-.22, .22):
            for turn in (0, 90):
                out.add("yellow", chamfer_box((t * size - .035, tall * .70, -half * a - .018),
                                              (t * size + .035, tall * .86, -half * a + .018), .006),
                        rotation("y", turn))
        for turn in (0, 90):
            out.add("crate", chamfer_box((-size * .30, tall * .22, a * (half - .022) - .012),
                                         (size * .30, tall * .62, a * (half - .022) + .012), .010),
                                         rotation("y", turn))
    return out


def drum(material):
    r = .29
    out = Model()
    out.add(material, lathe([(0, -.01), (.27, -.01), (r, .01), (r, .27), (.305, .287), (.305, .305), (r, .322),
                             (r, .56),
                             (.305, .577), (.305, .595), (r, .612), (r, .86), (.296, .868), (.296, .888), (.275, .888),
                             (.270, .862), (0, .862)], 40), crease=26.0)
    out.add("steel", lathe([(0, .85), (.04, .85), (.04, .876), (0, .876)], 12), None, (.15, 0, .06))
    return out


def container():
    """A half-height freight box with ribbed sides, corner castings and door bars; 3.0 x 1.3 x 1.5."""
    out = textured()
    out.box("box_teal", (-1.46, .07, -.71), (1.46, 1.26, .71))
    for a in (-1, 1):
        for b in (-1, 1):
            x, z = a * 1.45, b * .70
            out.box("dark", (x - .06, .0, z - .06), (x + .06, 1.32, z + .06), .012)
        out.box("dark", (-1.40, .02, a * .70 - .045), (1.40, .13, a * .70 + .045), .01)
        out.box("dark", (-1.40, 1.20, a * .70 - .045), (1.40, 1.30, a * .70 + .045), .01)
        out.box("dark", (a * 1.45 - .045, 1.205, -.66), (a * 1.45 + .045, 1.295, .66), .01)
        for z in (-.28, .28):
            out.add("steel", tube([(1.485, .16, z + a * .12), (1.485, 1.20, z + a * .12)], .016, 8))
    out.box("white", (-.55, .46, .69), (.35, .86, .7135), .004)
    out.box("yellow", (.50, .46, .69), (.90, .86, .7140), .004)
    return out


def barrier():
    """A concrete safety barrier, 2 m long, along x."""
    half = [(.30, -.02), (.30, .10), (.17, .28), (.10, .80), (.085, .82)]
    outline = half + [(-z, y) for z, y in reversed(half)]
    out = Model()
    out.add("cast", extrude([(y, z) for z, y in outline], -1.0, 1.0, .02, axis=0), crease=20.0)
    for k in range(2):
        out.box("yellow", (-.62 + .72 * k, .60, -.155), (-.10 + .72 * k, .72, .155), .01)
    return out


def props(scene):
    big, mid, small = crate(1.1, 1.0), crate(.8, .7), crate(.56, .48)
    for name, model, at, turn in (("a1", big, (5.9, 0, 1.1), 8), ("a2", mid, (5.95, .99, 1.05), 27),
                                  ("a3", mid, (5.55, 0, 2.35), -14), ("a4", small, (6.55, 0, 2.30), 35),
                                  ("b1", big, (-8.9, .9, -8.9), -5), ("b2", small, (-7.9, .9, -9.1), 18),
                                  ("c1", mid, (-6.2, 0, 3.9), -22), ("c2", small, (-5.45, 0, 4.6), 12),
                                  ("c3", small, (-6.15, .69, 3.85), 6), ("d1", big, (-12.9, 0, -3.0), 4),
                                  ("d2", big, (-12.8, 0, -1.7), -6), ("d3", mid, (-12.9, .99, -2.5), 15)):
        scene.add(f"crate_{name}", model, at, rotation("y", turn))
    blue, red = drum("drum_blue"), drum("drum_red")
    for name, model, at, turn in (("a", blue, (4.0, 0, -4.6), 0), ("b", red, (4.66, 0, -4.9), 70),
                                  ("c", blue, (4.55, 0, -4.22), 140), ("d", red, (-3.0, .9, -9.0), 30),
                                  ("e", blue, (-3.65, .9, -9.2), 200), ("g", red, (-12.2, 0, 4.3), 0),
                                  ("h", blue, (-12.9, 0, 4.6), 90)):
        scene.add(f"drum_{name}", model, at, rotation("y", turn))
    scene.add("drum_f", red, (-3.75, .296, 5.2), rotation("y", 35) @ rotation("x", 90))
    scene.add("container_0", container(), (11.3, 0, -3.2), rotation("y", 84))
    scene.add("container_1", container(), (11.35, 1.31, -3.25), rotation("y", 80))
    for k, (x, z, turn) in enumerate(((-12.2, 8.6, 0), (-9.9, 8.65, 2), (9.9, 8.6, -1), (12.2, 8.6, 1))):
        scene.add(f"barrier_{k}", barrier(), (x, 0, z), rotation("y", turn))
    pipe = Model()
    shell = [(.58, -1.5), (.72, -1.5), (.72, 1.32), (.80, 1.36), (.80, 1.60), (.64, 1.60), (.64, 1.44), (.58, 1.40)]
    pipe.add("cast", placed(lathe(shell, 56, loop=True), ALONG_X), crease=26.0)
    for x in (-1.0, 1.0):
        for z in (-1, 1):
            wedge = [(z * .28, -.735), (z * .80, -.735), (z * .80, -.50)]
            pipe.add("timber", extrude([(y, z) for z, y in wedge], x - .08, x + .08, .01, axis=0))
    scene.add("pipe_big", pipe, (10.0, .722, 3.2), rotation("y", 62))
    tank(scene)


def tank(scene):
    """A lying tank with domed ends on two saddles, at the left wall."""
    out = Model()
    r, length = 1.0, 1.55
    dome = [(r * np.cos(t), length + .55 * np.sin(t)) for t in np.linspace(0, np.pi / 2, 11)]
    profile = [(0, -length - .55)] + [(a, -b) for a, b in dome[:-1]][::-1] + dome[:-1] + [(0, length + .55)]
    out.add("tank", placed(lathe(profile, 56), ALONG_Z), crease=45.0)
    for z in (-1.0, 1.0):
        out.add("yellow", placed(lathe([(.97, z - .06), (1.02, z - .06), (1.02, z + .06), (.97, z + .06)], 56, True),
                                 ALONG_Z))
        saddle = [(-.78, -1.25), (.78, -1.25), (.92, -.40), (-.92, -.40)]
        out.add("cast", extrude(saddle, z - .15, z + .15, .02, axis=2))
    out.add("steel", lathe([(0, .95), (.16, .95), (.16, 1.10), (.20, 1.10), (.20, 1.14), (0, 1.14)], 24))
    scene.add("tank", out, (-12.6, 1.24, .9))


def fixtures(scene):
    """Flood heads on the gantry and strips above door and dock: drawn, but too dim to cast shadows."""
    out, glow = Model(), Model()
    for x in (-4.4, 4.4):
        out.box("dark", (x - .22, 4.38, -2.74), (x + .22, 4.59, -2.46), .02)
        glow.box("glow_strip", (x - .18, 4.368, -2.70), (x + .18, 4.385, -2.50), .003)
    for x in (-8.6, 9.0):
        out.box("dark", (x - .50, 3.98, -10.05), (x + .50, 4.08, -9.80), .015)
        glow.box("glow_strip", (x - .45, 3.965, -9.95), (x + .45, 3.985, -9.85), .003)
    scene.add("fixtures", out, ignore=True)
    scene.add("fixture_glow", glow, ignore=True)


def build(scene):
    ground(scene)
    dock(scene)
    walls(scene)
    gantry(scene)
    props(scene)
    fixtures(scene)
