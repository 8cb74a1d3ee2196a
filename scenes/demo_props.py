"""The yard, the furniture, the lights' housings and bulbs, and the grenade."""
import numpy as np

from demo_geometry import Solid, rotation_y

FLOOR = 0.1


def _rng(seed):
    return np.random.Generator(np.random.PCG64(seed))


def yard(scene):
    ground = Solid()
    ground.box("ground", (-14, -0.3, -12), (14, 0, 16))
    scene.add("yard_ground", ground)
    field = Solid()
    for low, high in (((-70, -0.5, -70), (70, -0.04, -12)), ((-70, -0.5, 16), (70, -0.04, 70)),
                      ((-70, -0.5, -12), (-14, -0.04, 16)), ((14, -0.5, -12), (70, -0.04, 16))):
        field.box("grass", low, high)
    scene.add("field", field, ignore=True)
    rng = _rng(101)
    path = Solid()
    for row in range(16):
        z = 0.35 + 0.74 * row
        for col in range(2):
            x = -3.28 + 0.80 * col + 0.09 * np.sin(row * 0.9) - 0.010 * row ** 2
            dx, dz, lift = rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), rng.uniform(0.0, 0.018)
            path.box("concrete", (x + dx, -0.02, z + dz), (x + dx + 0.75, 0.035 + lift, z + dz + 0.69),
                     offset=tuple(rng.random(2)))
    path.box("concrete", (-3.3, -0.02, 0.02), (-1.7, 0.07, 0.34), offset=(0.1, 0.2))
    path.box("concrete", (0.7, -0.02, 2.0), (5.1, 0.06, 4.6), offset=(0.35, 0.1))
    scene.add("paving", path)
    wall = Solid()
    wall.box("brick", (-11.6, 0, -10.2), (-11.35, 0.95, 8.0))
    wall.box("concrete", (-11.68, 0.95, -10.28), (-11.27, 1.04, 8.08))
    wall.box("brick", (-11.35, 0, -10.2), (11.35, 0.95, -9.95))
    wall.box("concrete", (-11.27, 0.95, -10.28), (11.4, 1.04, -9.87))
    for z in (-10.1, 8.05):
        wall.box("brick", (-11.72, 0, z - 0.25), (-11.22, 1.35, z + 0.25))
        wall.box("concrete", (-11.80, 1.35, z - 0.33), (-11.14, 1.45, z + 0.33))
    scene.add("yard_wall", wall)
    fence = Solid()
    for i, z in enumerate(np.arange(-9.6, 10.2, 1.8)):
        fence.box("planks", (11.36, 0, z - 0.06), (11.48, 1.9, z + 0.06), turn=True, offset=(0.13 * i, 0.2))
    for i, z in enumerate(np.arange(-9.8, 8.9, 0.17)):
        top = 1.72 + rng.uniform(-0.07, 0.05)
        if rng.random() < 0.96:
            fence.box("planks", (11.30, 0.06, z), (11.335, top, z + 0.15), turn=True, offset=(0.21 * i, 0.1 * i + 0.02))
    for y in (0.45, 1.4):
        fence.box("planks", (11.335, y, -9.7), (11.375, y + 0.1, 9.0))
    scene.add("fence", fence)


def trees(scene):
    """Dark conifers beyond the wall: only a silhouette against the sky."""
    rng = _rng(211)
    kinds = []
    for height in (7.0, 8.4, 9.8, 11.3):
        profile, tiers = [(0.0, -0.1), (0.16, -0.1), (0.16, 0.9)], 7
        for i in range(tiers):
            low = 0.9 + (height - 0.9) * i / tiers
            radius = height * 0.19 * (1 - i / tiers) * rng.uniform(0.85, 1.1)
            profile += [(radius, low - 0.1), (radius * 0.42, low + (height - 0.9) / tiers * 0.9)]
        kinds.append(Solid())
        kinds[-1].lathe("conifer", profile + [(0.0, height)], 10)
    spots = [(x + rng.uniform(-1.2, 1.2), -15 - 9 * rng.random()) for x in np.arange(-34, 30, 2.7)]
    spots += [(-15.5 - 8 * rng.random(), z) for z in np.arange(-12, 10, 3.4)]
    spots += [(16 + 9 * rng.random(), z) for z in np.arange(-12, 8, 3.6)]
    for i, (x, z) in enumerate(spots):
        scene.add(f"tree_{i}", kinds[rng.integers(len(kinds))], (x, -0.1 * rng.random(), z),
                  rotation_y(360 * rng.random()), ignore=True)


def crate(size, tall, seed):
    solid, half = Solid(), size / 2
    offset = tuple(_rng(seed).random(2))
    edge = 0.075 * min(1.0, size)
    solid.box("crate", (-half + .02, .02, -half + .02), (half - .02, tall - .02, half - .02), offset=offset)
    for a in (-1, 1):
        for b in (-1, 1):
            x, z = a * (half - edge / 2), b * (half - edge / 2)
            solid.box("crate", (x - edge / 2, 0, z - edge / 2), (x + edge / 2, tall, z + edge / 2), True, offset)
            y = 0 if b < 0 else tall - edge
            solid.box("crate", (-half + edge, y, a * (half - edge / 2) - edge / 2),
                      (half - edge, y + edge, a * (half - edge / 2) + edge / 2), offset=offset)
            solid.box("crate", (a * (half - edge / 2) - edge / 2, y, -half + edge),
                      (a * (half - edge / 2) + edge / 2, y + edge, half - edge), offset=offset)
    for a in (-1, 1):  # a brace across front and back
        z = a * (half - 0.022)
        solid.beam("crate", (-half + edge, edge, z), (half - edge, tall - edge, z), 0.03, edge * 0.9, offset=offset)
    return solid


def barrel(material):
    solid = Solid()
    solid.lathe(material, [(0, 0), (.275, 0), (.29, .02), (.29, .28), (.303, .295), (.303, .305), (.29, .32),
                           (.29, .57), (.303, .585), (.303, .595), (.29, .61), (.29, .86), (.283, .88), (.265, .88),
                           (.265, .855), (0, .855)], 32)
    solid.lathe("steel", [(0, .85), (.03, .85), (.03, .872), (0, .872)], 12, (.14, 0, .05))
    return solid


def tyre():
    solid, ring = Solid(), []
    for angle in np.linspace(0, 2 * np.pi, 11)[:-1]:
        ring.append((0.25 + 0.085 * np.cos(angle), 0.10 + 0.10 * np.sin(angle)))
    solid.lathe("rubber", ring, 28, closed=True)
    return solid


def stacks(scene):
    big, mid, small = crate(0.95, 0.95, 1), crate(0.7, 0.66, 2), crate(0.5, 0.46, 3)
    place = [("a1", big, (-6.1, FLOOR, -5.6), 4), ("a2", mid, (-6.2, FLOOR + 0.95, -5.6), 18),
             ("a3", mid, (-5.15, FLOOR, -5.8), -9), ("a4", small, (-0.6, FLOOR, -5.7), 12),
             ("b1", big, (1.0, FLOOR, -5.6), 3), ("b2", big, (1.05, FLOOR, -6.7), -4),
             ("b3", mid, (1.0, FLOOR + .95, -5.7), 22), ("y1", big, (-0.78, 0, 0.72), -7),
             ("y2", mid, (-0.72, 0.95, 0.66), 14), ("y3", small, (-1.02, 0, 1.72), 33),
             ("f1", big, (-7.35, 0, 7.25), 24), ("f2", mid, (-7.3, 0.95, 7.2), 40), ("f3", small, (-7.2, 0, 8.35), -12)]
    for name, solid, at, turn in place:
        scene.add(f"crate_{name}", solid, at, rotation_y(turn))
    blue, rust = barrel("drum_blue"), barrel("drum_rust")
    for name, solid, at, turn in [("y1", blue, (5.35, 0.0, 2.55), 20), ("y2", rust, (6.05, 0.0, 2.45), 130),
                                  ("y3", rust, (5.75, 0.0, 3.1), 70), ("f1", rust, (-6.60, 0, 8.62), 0),
                                  ("b1", blue, (6.3, FLOOR, -4.4), 45), ("b2", blue, (0.55, FLOOR, 1.2), 45)]:
        scene.add(f"barrel_{name}", solid, at, rotation_y(turn))
    wheel = tyre()
    for i, (x, z) in enumerate(((8.3, 2.1), (8.34, 2.06), (8.27, 2.13))):
        scene.add(f"tyre_{i}", wheel, (x, 0.2 * i, z), rotation_y(37 * i))


def furniture(scene):
    bench = Solid()
    for i in range(3):
        bench.box("planks", (-6.0, 0.44, 0.22 + 0.14 * i), (-4.3, 0.48, 0.34 + 0.14 * i), offset=(0.2 * i, 0.1 * i))
    for x in (-5.85, -4.45):
        bench.box("concrete", (x - 0.07, 0, 0.24), (x + 0.07, 0.44, 0.58))
    scene.add("bench", bench)
    table = Solid()
    table.box("planks", (-1.00, FLOOR + 0.72, -4.85), (-0.15, FLOOR + 0.78, -3.45), turn=True)
    for x in (-0.92, -0.23):
        for z in (-4.77, -3.53):
            table.box("planks", (x - 0.035, FLOOR, z - 0.035), (x + 0.035, FLOOR + 0.72, z + 0.035), turn=True)
    table.lathe("steel", [(0, .88), (.05, .88), (.055, .98), (.045, .98), (.042, .9), (0, .9)], 16, (-0.6, 0, -4.1))
    scene.add("table", table)
    shelf = Solid()
    for y in (0.15, 0.75, 1.35, 1.95):
        shelf.box("steel", (2.0, FLOOR + y, -4.92), (3.1, FLOOR + y + 0.03, -4.5))
    for x in (2.0, 3.07):
        for z in (-4.92, -4.53):
            shelf.box("steel", (x, FLOOR, z), (x + 0.03, FLOOR + 2.1, z + 0.03))
    rng = _rng(5)
    for y in (0.18, 0.78, 1.38):
        x = 2.06
        while x < 2.85:
            w, h = rng.uniform(0.12, 0.26), rng.uniform(0.16, 0.42)
            name = ("drum_blue", "drum_rust", "crate", "trim")[rng.integers(4)]
            shelf.box(name, (x, FLOOR + y, -4.86), (x + w, FLOOR + y + h, -4.58))
            x += w + rng.uniform(0.02, 0.09)
    scene.add("shelf", shelf)
    work = Solid()
    work.box("planks", (0.35, FLOOR + 0.86, -2.9), (1.0, FLOOR + 0.93, -1.4), turn=True)
    for z in (-2.75, -1.55):
        work.box("planks", (0.45, FLOOR, z - 0.05), (0.9, FLOOR + 0.86, z + 0.05))
    work.box("drum_rust", (0.5, FLOOR + 0.93, -2.6), (0.85, FLOOR + 1.12, -2.2))
    scene.add("workbench", work)
    pipes = Solid()
    for i, y in enumerate((2.30, 2.48, 2.66)):
        x = 6.62 - 0.1 * (i % 2)
        pipes.tube("drum_rust" if i == 1 else "steel", [(x, y, 1.6), (x, y, -4.8)], 0.045)
    pipes.tube("dark_metal", [(-6.65, 2.75, -0.45), (-6.65, 2.75, -5.9), (-6.58, 2.75, -6.08), (-6.40, 2.75, -6.15),
                              (-0.2, 2.75, -6.15)], 0.05)
    scene.add("pipes", pipes, ignore=True)
    vent = Solid()
    vent.box("steel", (-0.78, 1.75, 0.0), (-0.28, 2.35, 0.32))
    vent.box("dark_metal", (-0.73, 1.80, 0.32), (-0.33, 2.30, 0.335))
    scene.add("vent_box", vent)


def shade(solid, at, radius, drop):
    """A hanging light's rod and conical shade around a bulb at `at`."""
    x, y, z = at
    solid.lathe("dark_metal", [(0, .05), (.03, .05), (radius, -.065), (radius, -.05), (.035, .075), (0, .085)], 24,
                (x, y + 0.06, z))
    solid.tube("dark_metal", [(x, y + 0.13, z), (x, y + drop, z)], 0.012, 8)


def bulb(solid, glow, at, radius):
    profile = [(radius * np.sin(a), -radius * np.cos(a)) for a in np.linspace(0, np.pi, 9)]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    solid.lathe(glow, profile, 16, at)


def lights(scene):
    housings, glow = Solid(), Solid()
    for name, at, radius, drop in (("glow_tungsten", (-4.45, 2.42, -4.55), 0.22, 0.55),
                                   ("glow_violet", (3.50, 4.85, -5.20), 0.24, 0.60),
                                   ("glow_white", (5.20, 2.50, -6.35), 0.16, 0.38)):
        shade(housings, at, radius, drop)
        bulb(glow, name, at, 0.055)
    # Work light in room A: a tripod whose head looks at the front door.
    head = np.array([-1.42, 1.62, -5.55])
    for dx, dz in ((0.36, 0.18), (-0.36, 0.18), (0.0, -0.34)):
        housings.tube("dark_metal", [head - (0, 0.1, 0), (head[0] + dx, FLOOR, head[2] + dz)], 0.014, 8)
    housings.box("canister_band", head - (0.19, 0.13, 0.06), head + (0.19, 0.13, 0.03))
    glow.box("glow_work", head + (-0.165, -0.105, 0.025), head + (0.165, 0.105, 0.036))
    # Neon tubes over the workshop.
    for x in (2.3, 3.5):
        glow.tube("glow_teal", [(x, 3.20, -1.75), (x, 3.20, -0.15)], 0.022, 10)
        housings.box("trim", (x - 0.07, 3.23, -1.85), (x + 0.07, 3.29, -0.05))
        for z in (-1.6, -0.3):
            housings.tube("dark_metal", [(x, 3.29, z), (x, 5.45, z)], 0.006, 6)
    # Red bulkhead light over the front door.
    housings.lathe("dark_metal", [(0, 0), (.10, 0), (.10, .03), (.03, .05), (0, .05)], 20, (-2.5, 2.78, 0.16))
    housings.beam("dark_metal", (-2.5, 2.80, 0.0), (-2.5, 2.80, 0.2), 0.05, 0.04)
    bulb(glow, "glow_red", (-2.5, 2.70, 0.16), 0.075)
    # Sodium light on a pole at the right of the yard.
    housings.lathe("concrete", [(0, 0), (.2, 0), (.17, .3), (0, .3)], 16, (6.7, 0, 4.4))
    housings.tube("dark_metal", [(6.7, 0.25, 4.4), (6.7, 4.5, 4.4), (6.65, 4.72, 4.4), (6.5, 4.82, 4.4),
                                 (5.9, 4.84, 4.4)], 0.055, 12)
    housings.box("dark_metal", (5.68, 4.72, 4.27), (6.20, 4.82, 4.53))
    glow.box("glow_sodium", (5.74, 4.685, 4.31), (6.14, 4.72, 4.49))
    scene.add("lamp_housings", housings, ignore=True)
    scene.add("lamp_bulbs", glow, ignore=True)


def sign(scene):
    """A ring and a bolt in neon on a board beside the gable window: a shape, not a word."""
    board = Solid()
    board.box("sign_board", (4.95, 3.68, 2.0), (6.45, 5.18, 2.08))
    board.box("trim", (4.90, 3.63, 2.0), (6.50, 3.68, 2.11))
    board.box("trim", (4.90, 5.18, 2.0), (6.50, 5.23, 2.11))
    scene.add("sign_board", board)
    neon = Solid()
    ring = [(5.70 + 0.60 * np.cos(a), 4.43 + 0.60 * np.sin(a), 2.13) for a in np.linspace(0, 2 * np.pi, 41)[:-1]]
    neon.tube("glow_teal", ring, 0.020, 8, loop=True)
    bolt = [(5.88, 4.88, 2.14), (5.50, 4.38, 2.14), (5.73, 4.42, 2.14), (5.54, 3.98, 2.14), (5.95, 4.53, 2.14),
            (5.71, 4.50, 2.14)]
    for start, end in zip(bolt, bolt[1:] + bolt[:1]):
        neon.tube("glow_pink", [start, end], 0.020, 8)
    scene.add("sign_neon", neon, ignore=True)
    cables = Solid()
    for start, end, sag in (((6.7, 4.45, 4.4), (7.05, 5.0, 2.05), 0.16), ((6.7, 4.3, 4.4), (7.05, 4.8, 2.05), 0.22),
                            ((-0.03, 4.6, 1.4), (-5.05, 5.6, -4.6), 0.7)):
        t = np.linspace(0, 1, 15)[:, None]
        path = np.array(start) * (1 - t) + np.array(end) * t
        path[:, 1] -= (4 * t * (1 - t))[:, 0] * sag
        cables.tube("rubber", path, 0.012, 6)
    mast = [(0.9, 6.2, -6.5), (0.9, 8.6, -6.5)]
    cables.tube("steel", mast, 0.018, 8)
    for y, w in ((8.5, 0.25), (8.25, 0.38), (8.0, 0.5)):
        cables.tube("steel", [(0.9 - w, y, -6.5), (0.9 + w, y, -6.5)], 0.009, 6)
    scene.add("cables_and_aerial", cables, ignore=True)


def grenade():
    """A smoke canister 12 cm tall, centred on its origin: ribbed body, band, fuze, lever, pull ring."""
    solid, y = Solid(), -0.060
    body = [(0, y), (.026, y), (.029, y + .004), (.029, y + .010), (.0275, y + .012), (.0275, y + .030)]
    solid.lathe("canister", body + [(0, y + .030)], 32)
    solid.lathe("canister_band", [(0, y + .030), (.0282, y + .030), (.0282, y + .040), (0, y + .040)], 32)
    rest = [(0, y + .040), (.0275, y + .040), (.0275, y + .080), (.029, y + .082), (.029, y + .087), (.025, y + .092),
            (.012, y + .094), (0, y + .094)]
    solid.lathe("canister", rest, 32)
    solid.lathe("steel", [(0, y + .094), (.012, y + .094), (.012, y + .101), (.0095, y + .103), (.0095, y + .116),
                          (.006, y + .120), (0, y + .120)], 20)
    solid.box("steel", (-.006, y + .106, -.012), (.016, y + .117, .012))
    lever = [(.014, y + .1165), (.027, y + .110), (.0335, y + .096), (.0335, y + .034), (.0315, y + .028)]
    for (x0, y0), (x1, y1) in zip(lever, lever[1:]):
        solid.beam("steel", (x0, y0, 0), (x1, y1, 0), .012, .0018)
    ring = [(-.020 + .011 * np.cos(a), y + .104 + .011 * np.sin(a), .004) for a in np.linspace(0, 2 * np.pi, 25)[:-1]]
    solid.tube("steel", ring, .0011, 6, loop=True)
    solid.tube("steel", [(-.0095, y + .110, .004), (.012, y + .110, .004)], .0014, 8)
    return solid


def build(scene):
    yard(scene)
    trees(scene)
    stacks(scene)
    furniture(scene)
    lights(scene)
    sign(scene)
