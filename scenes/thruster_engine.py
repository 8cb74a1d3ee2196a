"""The engine of scenes/thruster/engine.glb, and the dark stage it stands on.

Metres; the axis is x = 0, y = 0.12, and the exit plane of the nozzle z = 0, exhaust towards +z.
"""
import numpy as np

import glb_scene
from demo_textures import _rng, grid_px, level, mix, normal_image, smooth, spectral
from hard_surface import ALONG_X, ALONG_Z, Model, chamfer_box, extrude, lathe, loft, placed, rotation, rounded, tube

AXIS_Y = 0.12  # height of the axis above the floor
PANEL_M = 0.48  # what one repeat of the stage's texture covers

MATERIALS = {
    "engine_paint": dict(color=(0.105, 0.112, 0.122), roughness=0.40, metallic=0.25),
    "engine_steel": dict(color=(0.36, 0.36, 0.37), roughness=0.34, metallic=0.95),
    "engine_burnt": dict(color=(0.26, 0.20, 0.17), roughness=0.38, metallic=0.9),
    "engine_brass": dict(color=(0.52, 0.34, 0.13), roughness=0.35, metallic=0.9),
    "engine_rubber": dict(color=(0.018, 0.018, 0.020), roughness=0.7),
    "engine_orange": dict(color=(0.62, 0.17, 0.025), roughness=0.5),
    "engine_glow": dict(color=(0.3, 0.5, 0.7), emission=(0.25, 1.0, 2.2)),
    "stage_floor": dict(texture="panels", color=(0.34, 0.35, 0.37), roughness=0.55),
    "stage_wall": dict(color=(0.105, 0.110, 0.120), roughness=0.65),
    "stage_trim": dict(color=(0.045, 0.047, 0.052), roughness=0.5, metallic=0.4),
    "stage_pipe": dict(color=(0.23, 0.21, 0.19), roughness=0.42, metallic=0.8),
    "stage_mark": dict(color=(0.50, 0.40, 0.10), roughness=0.7),
}


def panels(n=256):
    """Four by four steel plates with rounded seams, a screw in each corner, and scuffs."""
    rng = _rng(911)
    x, y = grid_px(n)
    size = n / 4
    fx, fy = x % size, y % size
    edge = np.minimum(np.minimum(fx, size - fx), np.minimum(fy, size - fy))
    seam = 1 - smooth(0.8, 2.0, edge)
    tone = rng.uniform(0.90, 1.08, (4, 4))[(y // size).astype(int), (x // size).astype(int)]
    screw = np.hypot(np.minimum(fx, size - fx) - 6.5, np.minimum(fy, size - fy) - 6.5)
    head = 1 - smooth(1.4, 2.2, screw)
    scuff = smooth(0.9, 2.4, spectral(rng, n, 1.9, 4, 90, (1.0, 2.0)))
    color = np.full((n, n, 3), 0.72) * (tone * (1 + 0.025 * spectral(rng, n, 2.2, 2, 40)))[..., None]
    color = mix(color, np.array([.82, .81, .80]), 0.35 * scuff)
    color = color * (1 - 0.62 * seam - 0.35 * head * (screw > 0.8))[..., None]
    return {"color": level(color), "normal": normal_image(-0.0012 * seam + 0.0004 * head, PANEL_M)}


def housing(model):
    """Body, nozzle and details, around the axis, exhaust towards +z, exit plane z = 0."""
    def turned(material, profile, segments=72, loop=False, crease=28.0):
        model.add(material, lathe(profile, segments, loop), ALONG_Z, crease=crease)

    # Rear cap, barrel with two waists, front collar.
    turned("engine_paint", [(0, -.190), (.020, -.190), (.024, -.188), (.0365, -.1735), (.0365, -.1715),
                            (.0350, -.1705),
                            (.0350, -.1685), (.0400, -.1680), (.0452, -.1585), (.0465, -.154),
                            (.0465, -.128), (.0455, -.1265), (.0425, -.1265), (.0425, -.1225), (.0455, -.1225),
                            (.0465, -.121), (.0465, -.062), (.0455, -.0605), (.0405, -.0545), (.0395, -.0525),
                            (.0395, -.040), (.030, -.040), (0, -.040)])
    turned("engine_orange", [(.0410, -.1262), (.0446, -.1262), (.0446, -.1228), (.0410, -.1228)], loop=True)
    turned("engine_steel", [(.0440, -.0632), (.0472, -.0632), (.0477, -.0637), (.0477, -.0655), (.0472, -.0660),
                            (.0440, -.0660)], loop=True)
    # Nozzle: an outer shroud with a deep bore, bevelled lips.
    turned("engine_burnt", [(.0225, -.046), (.0375, -.046), (.0385, -.045), (.0375, -.034), (.0335, -.014),
                            (.0318, -.0045), (.0308, -.0012), (.0293, 0), (.0266, 0), (.0252, -.0012), (.0243, -.004),
                            (.0225, -.020)], loop=True, crease=22.0)
    turned("engine_steel", [(.0362, -.0395), (.0408, -.0395), (.0420, -.0383), (.0420, -.0337), (.0408, -.0325),
                            (.0352, -.0325)], loop=True)
    # Discharge chamber: liner, thin glowing ring at its floor, hub with a hollow for the beam.
    turned("engine_steel", [(.0105, -.031), (.0228, -.031), (.0228, -.0285), (.0105, -.0285)], loop=True)
    turned("engine_glow", [(.0150, -.0288), (.0192, -.0288), (.0186, -.0268), (.0156, -.0268)], loop=True)
    turned("engine_brass", [(.0060, -.0300), (.0110, -.0300), (.0106, -.0150), (.0098, -.0080), (.0089, -.0064),
                            (.0072, -.0064), (.0062, -.0074), (.0060, -.0090)], loop=True, crease=22.0)
    turned("engine_glow", [(0, -.0290), (.0061, -.0290), (.0061, -.0262), (0, -.0262)])
    for k in range(12):  # grid vanes between hub and bore
        angle = 360 * k / 12
        model.add("engine_burnt", chamfer_box((.0100, -.00055, -.0245), (.0228, .00055, -.0165), .0002),
                  rotation("z", angle))
    # Cooling fins around the nozzle's neck, bolts on the collar, ribs along the barrel.
    for k in range(24):
        outline = [(-.0545, .0385), (-.0412, .0385), (-.0412, .0436), (-.0475, .0452), (-.0535, .0452)]
        model.add("engine_steel", extrude(outline, -.0007, .0007), rotation("z", 360 * k / 24 + 7.5))
    for k in range(12):
        turn = rotation("z", 30 * k + 15)
        bolt = placed(lathe([(0, -.0012), (.0021, -.0012), (.0021, .0008), (.0016, .0013), (0, .0013)], 6), ALONG_Z)
        model.add("engine_steel", bolt, turn, turn @ (.0386, 0, -.0325))
    for k in range(8):
        turn = rotation("z", 45 * k + 22.5)
        model.add("engine_paint", chamfer_box((.0452, -.0042, -.1165), (.0492, .0042, -.0665), .0012), turn)
        model.add("engine_orange" if k in (1, 2) else "engine_steel",
                  chamfer_box((.0470, -.0021, -.1085), (.0501, .0021, -.0745), .0006), turn)


def fittings(model):
    """Valve block, hoses, cable, sensor, cradle and pylon."""
    model.add("engine_steel", chamfer_box((-.016, .0440, -.1530), (.016, .0600, -.1300), .0022))
    model.add("engine_paint", chamfer_box((-.011, .0585, -.1490), (.011, .0660, -.1340), .0016))
    for x in (-.009, .009):
        model.add("engine_brass", lathe([(0, 0), (.0042, 0), (.0046, .0006), (.0046, .0044), (.0042, .005), (0, .005)],
                                        12), rotation("x", 90), (x, .052, -.1308))
        hose = [(x, .052, -.128), (x, .0525, -.112), (x * 1.5, .0515, -.096), (x * 2.2, .047, -.078),
                (x * 2.6, .041, -.060), (x * 2.5, .038, -.050)]
        model.add("engine_rubber", tube(smooth_path(hose), .0026, 10))
    loops = [(.030, -.020, -.182), (.040, -.030, -.196), (.043, -.052, -.190), (.041, -.072, -.168),
             (.037, -.098, -.146), (.036, -.113, -.138)]
    model.add("engine_rubber", tube(smooth_path(loops), .0035, 10))
    # A sensor pod on the side that the camera sees, with a lens and a stripe.
    model.add("engine_paint", chamfer_box((.0435, -.0085, -.1545), (.0555, .0085, -.1285), .0020))
    model.add("engine_orange", chamfer_box((.0500, -.0062, -.1505), (.0562, .0062, -.1462), .0008))
    lens = lathe([(0, 0), (.0050, 0), (.0056, .0008), (.0056, .0030), (.0042, .0036), (.0040, .0026), (0, .0026)], 20)
    model.add("engine_steel", lens, ALONG_X, (.0550, 0, -.1370))
    # Cradle: two half rings under the barrel, pylon, foot plate.
    for z in (-.118, -.078):
        arc = [np.array([np.cos(a), np.sin(a)]) for a in np.linspace(np.pi * 1.04, np.pi * 1.96, 25)]
        rings = []
        for c in arc:
            section = rounded([(.0445, -.007), (.0555, -.007), (.0555, .007), (.0445, .007)], .002)
            rings.append(np.stack([section[:, 0] * c[0], section[:, 0] * c[1], z + section[:, 1]], axis=1))
        model.add("engine_steel", loft(rings), crease=40.0)
    web = rounded([(-.030, -.052), (.030, -.052), (.019, -.112), (-.019, -.112)], .004)
    model.add("engine_paint", placed(extrude(web, -.122, -.074, .002, axis=2)))
    model.add("engine_steel", chamfer_box((-.048, -.1215, -.148), (.048, -.1100, -.052), .0025))
    for x in (-.038, .038):
        for z in (-.137, -.063):
            head = lathe([(0, 0), (.0050, 0), (.0050, .0035), (.0040, .0045), (0, .0045)], 6)
            model.add("engine_brass", head, None, (x, -.1102, z))


def smooth_path(points, steps=6):
    """A Catmull-Rom curve through points."""
    p = np.asarray(points, float)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    out = []
    for k in range(1, len(p) - 2):
        for t in np.arange(steps) / steps:
            out.append(0.5 * (2 * p[k] + (p[k + 1] - p[k - 1]) * t +
                              (2 * p[k - 1] - 5 * p[k] + 4 * p[k + 1] - p[k + 2]) * t * t +
                              (3 * p[k] - p[k - 1] - 3 * p[k + 1] + p[k + 2]) * t ** 3))
    return np.array(out + [p[-2]])


def stage():
    """A floor of steel plates, a ribbed wall behind the plume and a low one behind the engine; z along the exhaust."""
    floor = Model({"stage_floor": PANEL_M})
    floor.box("stage_floor", (-.36, -.03, -.60), (1.2, 0, 1.08))
    wall = Model()
    wall.box("stage_wall", (-.42, -.03, -.60), (-.36, .66, 1.08))
    for k in range(7):
        z = -.48 + .24 * k
        wall.box("stage_trim", (-.365, -.022, z - .016), (-.330, .655, z + .016), .004)
        if k < 6:  # raised panels with a recess between them
            wall.box("stage_wall", (-.362, .060, z + .030), (-.345, .285, z + .210), .005)
            wall.box("stage_wall", (-.362, .315, z + .030), (-.350, .560, z + .210), .005)
            for y in (.350, .375, .400, .425):
                wall.box("stage_trim", (-.352, y, z + .050), (-.344, y + .012, z + .190), .002)
    wall.box("stage_trim", (-.364, -.016, -.595), (-.318, .034, 1.075), .006)
    wall.box("stage_mark", (-.3192, .010, -.40), (-.3165, .020, 1.00))
    rear = Model()
    rear.box("stage_wall", (-.36, -.03, -.66), (1.2, .66, -.60))
    for k in range(5):
        rear.box("stage_trim", (-.15 + .26 * k, -.02, -.605), (-.12 + .26 * k, .655, -.570), .004)
        rear.box("stage_wall", (-.10 + .26 * k, .060, -.602), (.09 + .26 * k, .520, -.586), .005)
    pipes = Model()
    for y, r in ((.590, .014), (.622, .009)):
        pipes.add("stage_pipe", tube([(-.325, y, -.57), (-.325, y, 1.07)], r, 16))
    for k in range(7):
        pipes.box("stage_trim", (-.332, .570, -.488 + .24 * k + .06), (-.309, .640, -.472 + .24 * k + .06), .002)
    block = Model()  # things that stand in the light of the plume
    block.box("stage_wall", (-.20, -.005, .30), (-.10, .070, .40), .006)
    block.box("stage_trim", (-.185, .068, .315), (-.115, .078, .385), .003)
    block.add("stage_pipe", lathe([(0, -.004), (.028, -.004), (.030, -.002), (.030, .080), (.027, .084), (0, .084)],
                                  40),
              None, (.030, 0, .300))
    block.add("stage_pipe", lathe([(0, -.004), (.020, -.004), (.021, .048), (.018, .051), (0, .051)], 36), None,
              (-.075, 0, .205))
    return floor, wall, rear, pipes, block


def scene():
    out = glb_scene.GlbScene("make_thruster.py", MATERIALS, {"panels": panels()})
    engine = Model()
    housing(engine)
    fittings(engine)
    out.add("engine", engine, (0, AXIS_Y, 0))
    for name, model in zip(("stage_floor", "stage_wall", "stage_rear", "stage_pipes", "stage_blocks"), stage()):
        out.add(name, model)
    out.light("key", "spot", (1.0, 0.93, 0.84), 1.5, (.55, .75, .35), (0, .10, -.06), (0.25, 0.55))
    out.light("rim", "point", (0.55, 0.70, 1.0), 0.10, (-.10, .36, -.36), None, None)
    out.camera("camera", (.37, .165, .20), (0, .112, .030), 38.0)
    return out
