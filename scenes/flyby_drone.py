"""The hover drone of scenes/flyby: 1.6 m wide, around the origin, nose towards +z."""
import numpy as np

from hard_surface import (ALONG_Z, TURN, Model, chamfer_box, extrude, lathe, loft, monotone, placed, rotation,
                          rounded, sphere, tube)
from demo_geometry import unit

FAN_X, FAN_Z, FAN_Y = 0.530, 0.465, 0.020  # centres of the ducts
DUCT_R = 0.270
TILT = 5.0  # ducts lean outward [degrees]

MATERIALS = {
    "drone_paint": dict(color=(0.70, 0.69, 0.65), roughness=0.34, metallic=0.1),
    "drone_graphite": dict(color=(0.070, 0.075, 0.085), roughness=0.42, metallic=0.4),
    "drone_rubber": dict(color=(0.017, 0.017, 0.019), roughness=0.75),
    "drone_steel": dict(color=(0.42, 0.43, 0.45), roughness=0.33, metallic=0.95),
    "drone_orange": dict(color=(0.78, 0.19, 0.018), roughness=0.38),
    "drone_glass": dict(color=(0.006, 0.008, 0.012), roughness=0.06),
    "glow_eye": dict(color=(0.2, 0.5, 0.6), emission=(0.15, 2.2, 3.4)),
    "glow_front": dict(color=(0.6, 0.7, 0.7), emission=(0.8, 1.6, 1.9)),
    "glow_rear": dict(color=(0.6, 0.1, 0.05), emission=(1.8, 0.05, 0.02)),
}


def blade():
    """One rotor blade along +x: a thin twisted section that narrows and sweeps back."""
    a = np.arange(10) / 10 * TURN
    rings = []
    for t in (0.0, 0.12, 0.35, 0.62, 0.85, 0.96, 1.0):
        chord = np.interp(t, [0, 0.12, 0.35, 0.85, 0.96, 1], [0.030, 0.046, 0.058, 0.042, 0.030, 0.016])
        thick = np.interp(t, [0, 1], [0.0090, 0.0030])
        twist = np.radians(np.interp(t, [0, 1], [34.0, 13.0]))
        z, y = chord / 2 * np.cos(a), thick / 2 * np.sin(a) * (1 - 0.35 * np.cos(a)) + 0.002 * np.cos(a) ** 2
        sweep = 0.016 * np.sin(np.pi * t) - 0.014 * t
        rings.append(np.stack([np.full(10, 0.040 + 0.181 * t), y * np.cos(twist) + z * np.sin(twist),
                               z * np.cos(twist) - y * np.sin(twist) + sweep], axis=1))
    return loft(rings)


def fan():
    """A duct with rotor, stator and motor; axis +y, centre at the origin, its outboard side towards +x."""
    fan = Model()
    wall = [(.2290, -.0700), (.2270, -.0400), (.2262, .0250), (.2300, .0480), (.2380, .0640), (.2480, .0700),
            (.2580, .0680), (.2660, .0600), (.2700, .0460), (.2700, .0250), (.2640, .0210), (.2640, -.0050),
            (.2700, -.0090), (.2700, -.0330), (.2630, -.0640), (.2540, -.0730), (.2420, -.0750)]
    fan.add("drone_paint", lathe(wall, 60, loop=True), crease=40.0)
    fan.add("drone_graphite", lathe([(.2235, -.0420), (.2300, -.0420), (.2300, .0260), (.2235, .0260)], 60, loop=True))
    fan.add("drone_rubber", lathe([(.2580, -.0035), (.2672, -.0035), (.2690, .0010), (.2690, .0150), (.2672, .0195),
                                   (.2580, .0195)], 60, loop=True))
    fan.add("drone_graphite", lathe([(.2400, -.0780), (.2550, -.0765), (.2655, -.0665), (.2690, -.0520),
                                     (.2690, -.0480), (.2600, -.0480), (.2400, -.0700)], 60, loop=True), crease=34.0)
    motor = [(0, -.0820), (.0200, -.0790), (.0400, -.0640), (.0480, -.0460), (.0500, -.0300), (.0500, -.0080),
             (.0470, -.0050), (0, -.0050)]
    fan.add("drone_graphite", lathe(motor, 28), crease=34.0)
    spinner = [(0, .0020), (.0430, .0020), (.0450, .0040), (.0450, .0260), (.0400, .0420), (.0270, .0570),
               (.0100, .0650), (0, .0660)]
    fan.add("drone_steel", lathe([(0, -.0060), (.0300, -.0060), (.0300, .0030), (0, .0030)], 20))
    fan.add("drone_paint", lathe(spinner[:5] + [(.0330, .0500), (0, .0500)], 28), crease=34.0)
    fan.add("drone_orange", lathe([(0, .0490), (.0322, .0490), (.0310, .0520), (.0220, .0605), (.0090, .0660),
                                   (0, .0672)], 28), crease=40.0)
    for k in range(5):
        fan.add("drone_graphite", blade(), rotation("y", 72 * k + 11), (0, .0150, 0), crease=60.0)
    vane = [np.array([[x, -.0440 + .018 * np.sin(a), .0050 * np.cos(a)] for a in np.arange(10) / 10 * TURN])
            for x in (.0440, .2280)]
    for k in range(5):
        fan.add("drone_paint", loft(vane), rotation("y", 72 * k + 36), crease=60.0)
    for k in (-1, 0, 1):  # guards over the bumper, with orange at the middle
        turn = rotation("y", 38 * k)
        fan.add("drone_orange" if k == 0 else "drone_paint",
                chamfer_box((.2560, -.0280, -.0330), (.2760, .0400, .0330), .0060), turn)
    return fan


def ducts(drone):
    single = fan()
    for sx in (-1, 1):
        for sz in (-1, 1):
            outward = np.degrees(np.arctan2(-sz * FAN_Z, sx * FAN_X))
            lean = rotation("z", -TILT * sx)
            at = np.array([sx * FAN_X, FAN_Y, sz * FAN_Z])
            drone.merge(single, lean @ rotation("y", outward), at)
            drone.add("glow_front" if sz > 0 else "glow_rear",
                      chamfer_box((.2700, -.0020, -.0190), (.2790, .0130, .0190), .0030),
                      lean @ rotation("y", outward), at)


def arms(drone):
    """From the shoulders to the ducts: a tapering beam, a collar at its root, an orange sleeve."""
    for sx in (-1, 1):
        for sz in (-1, 1):
            start = np.array([sx * .100, .034, sz * .170])
            end = np.array([sx * FAN_X, FAN_Y - .006, sz * FAN_Z])
            way = unit(end - start)
            side = unit(np.cross([0, 1, 0], way))
            up = np.cross(way, side)
            reach = np.linalg.norm(end - start) - .243

            def section(t, width, height, lift=0.0):
                p = rounded([(-width, -height), (width, -height), (width * .62, height), (-width * .62, height)], .014)
                return start + way * t + p[:, :1] * side + (p[:, 1:] + lift) * up

            drone.add("drone_graphite", loft([section(0, .066, .040), section(reach * .45, .052, .033),
                                              section(reach + .006, .046, .028)]), crease=40.0)
            drone.add("drone_paint", loft([section(.018, .073, .046), section(.024, .078, .051),
                                           section(.092, .071, .046), section(.098, .066, .041)]), crease=40.0)
            drone.add("drone_orange", loft([section(.112, .0560, .0375), section(.116, .0590, .0400),
                                            section(.140, .0565, .0385), section(.144, .0535, .0360)]), crease=40.0)
            drone.add("drone_paint", loft([section(reach - .040, .050, .031), section(reach - .034, .055, .036),
                                           section(reach - .006, .060, .041), section(reach + .008, .060, .041)]),
                      crease=40.0)
            for t in (.036, .080):
                bolt = lathe([(0, 0), (.0085, 0), (.0085, .0040), (.0065, .0060), (0, .0060)], 8)
                basis = np.stack([side, up, way], axis=1)
                drone.add("drone_steel", bolt, basis, start + way * t + up * (.0455 if t > .05 else .0485))


HALF = monotone([-.50, -.44, -.22, .05, .28, .42, .48], [.085, .128, .182, .176, .142, .104, .080])
TOP = monotone([-.50, -.43, -.20, .02, .22, .38, .48], [.052, .088, .134, .140, .112, .070, .046])
LOW = monotone([-.50, -.36, -.05, .25, .42, .48], [.026, .062, .092, .082, .050, .030])
SHELL = rounded([(1.0, 0.0), (1.0, .30), (.60, .86), (.27, 1.0), (-.27, 1.0), (-.60, .86), (-1.0, .30), (-1.0, 0.0)],
                .10)
BELLY = rounded([(.93, 0.0), (.90, -.30), (.52, -1.0), (-.52, -1.0), (-.90, -.30), (-.93, 0.0)], .12)


def hull_rings(outline, height, base, stations, grow=0.0):
    """Cross-sections of a shell; `grow`: how far outside of it."""
    rings = []
    for z in stations:
        w, h = float(HALF(z)) + grow, float(height(z)) + grow
        y = base + outline[:, 1] * h
        y[abs(outline[:, 1]) < 1e-9] -= np.sign(outline[:,
                                                        1].sum()) * grow * 0.7  # not in the plane of the shell's rim
        rings.append(np.stack([outline[:, 0] * w, y, np.full(len(outline), z)], axis=1))
    return rings


def band(drone, material, outline, height, base, z0, z1, grow):
    """A raised collar around a shell, with chamfered rims."""
    inner = np.linspace(z0 + .004, z1 - .004, max(2, int((z1 - z0) / .05) + 1))
    drone.add(material, loft(hull_rings(outline, height, base, [z0], -.004) +
                             hull_rings(outline, height, base, inner, grow) +
                             hull_rings(outline, height, base, [z1], -.004)), crease=30.0)


def body(drone):
    stations = np.concatenate([[-.50], np.linspace(-.485, .465, 24), [.48]])
    shrink = lambda rings: [rings[0] * [.90, .90, 1] + [0, .003, 0], *rings[1:-1],
                            rings[-1] * [.88, .88, 1] + [0, .003, 0]]
    drone.add("drone_paint", loft(shrink(hull_rings(SHELL, TOP, .016, stations))), crease=34.0)
    drone.add("drone_graphite", loft(shrink(hull_rings(BELLY, LOW, -.014, stations))), crease=34.0)
    seam = rounded([(.86, -.026), (.86, .026), (-.86, .026), (-.86, -.026)], .01)
    drone.add("drone_rubber", loft([np.stack([seam[:, 0] * float(HALF(z)), seam[:, 1], np.full(len(seam), z)], axis=1)
                                    for z in stations[1:-1]]), crease=40.0)
    band(drone, "drone_graphite", SHELL, TOP, .016, -.120, .105, .0055)
    band(drone, "drone_orange", SHELL, TOP, .016, .130, .168, .0050)
    band(drone, "drone_paint", SHELL, TOP, .016, .205, .345, .0050)
    band(drone, "drone_paint", SHELL, TOP, .016, -.365, -.165, .0060)
    band(drone, "drone_orange", SHELL, TOP, .016, -.430, -.395, .0045)
    band(drone, "drone_paint", BELLY, LOW, -.014, -.30, -.14, .0050)
    band(drone, "drone_paint", BELLY, LOW, -.014, .12, .26, .0050)
    # Spine: a narrow raised cover, and a hatch with a handle on the dark collar.
    spine = []
    for z in np.linspace(-.440, .075, 12):
        w = .034 if -.42 < z < .05 else .022
        p = rounded([(-w, -.03), (w, -.03), (w * .8, .022), (-w * .8, .022)], .008)
        spine.append(np.stack([p[:, 0], .016 + float(TOP(z)) + p[:, 1] * (1 if -.42 < z < .05 else .55),
                               np.full(len(p), z)], axis=1))
    drone.add("drone_graphite", loft(spine), crease=40.0)
    for z in (-.335, -.295, -.255, -.215):
        y = .016 + float(TOP(z))
        drone.add("drone_steel", chamfer_box((-.020, y - .01, z - .012), (.020, y + .0290, z + .012), .0035))
    drone.add("drone_orange", chamfer_box((-.017, .1620, -.105), (.017, .1815, .030), .0040))
    for sx in (-1, 1):
        for k in range(5):  # louvres in the flank
            z = -.335 + .034 * k
            drone.add("drone_rubber", chamfer_box((-.012, -.016, -.0105), (.012, .016, .0105), .003),
                      rotation("z", -12 * sx), (sx * (float(HALF(z)) - .001), .044, z))
        drone.add("glow_front", chamfer_box((-.006, -.006, -.052), (.006, .006, .052), .002), rotation("y", 9 * sx),
                  (sx * (float(HALF(.27)) + .0005), .034, .27))
        drone.add("drone_graphite", chamfer_box((-.022, -.012, -.062), (.022, .014, .062), .005),
                  rotation("z", -38 * sx), (sx * .112, .016 + float(TOP(-.005)) * .84, -.005))


def eye(drone):
    """Camera eye in the nose with a glowing iris, two lesser sensors, and a ball below the chin."""
    at = (0, .018, .0)
    drone.add("drone_graphite", lathe([(0, .400), (.0700, .400), (.0780, .408), (.0780, .470), (.0745, .4780),
                                       (.0740, .4860), (.0780, .4880), (.0780, .5060), (.0720, .5150), (.0660, .5150),
                                       (.0610, .5040), (.0600, .4960), (0, .4960)], 44), ALONG_Z, at, crease=34.0)
    drone.add("drone_orange", lathe([(.0700, .4788), (.0768, .4788), (.0768, .4872), (.0700, .4872)], 44, loop=True),
              ALONG_Z, at)
    drone.add("glow_eye", lathe([(.0480, .4950), (.0565, .4950), (.0555, .5020), (.0500, .5020)], 44, loop=True),
              ALONG_Z,
              at)
    dome = [(.0490 * np.cos(t), .4900 + .0330 * np.sin(t)) for t in np.linspace(0, np.pi / 2, 9)]
    drone.add("drone_glass", lathe([(0, .4880), *dome[:-1], (0, .5230)], 36), ALONG_Z, at, crease=60.0)
    for sx in (-1, 1):
        small = [(0, 0), (.0155, 0), (.0175, .002), (.0175, .020), (.0150, .0235), (.0115, .0235), (.0105, .0190),
                 (0, .0190)]
        drone.add("drone_graphite", lathe(small, 20), rotation("y", 14 * sx) @ ALONG_Z, (sx * .108, .022, .425))
        drone.add("drone_glass", placed(sphere(.0100, 14, 8), None, (0, .018, 0)), rotation("y", 14 * sx) @ ALONG_Z,
                  (sx * .108, .022, .425), crease=60.0)
    drone.add("drone_graphite", lathe([(0, -.150), (.030, -.138), (.036, -.120), (.044, -.100), (.047, -.060),
                                       (0, -.060)],
                                      28), None, (0, 0, .30), crease=30.0)
    drone.add("drone_steel", lathe([(.0400, -.1120), (.0455, -.1120), (.0455, -.1060), (.0400, -.1060)], 28,
                                   loop=True),
              None, (0, 0, .30))
    drone.add("drone_glass", sphere(.0300, 24, 14), None, (0, -.1380, .3120), crease=60.0)


def rear(drone):
    """Two exhausts, canted fins, antennas."""
    for sx in (-1, 1):
        nozzle = [(0, 0), (.0360, 0), (.0390, .003), (.0370, .045), (.0320, .068), (.0265, .068), (.0250, .045),
                  (0, .045)]
        drone.add("drone_graphite", lathe(nozzle, 28), rotation("x", -90), (sx * .046, .030, -.470), crease=34.0)
        drone.add("glow_rear", lathe([(0, .040), (.0200, .040), (.0200, .049), (0, .049)], 24), rotation("x", -90),
                  (sx * .046, .030, -.470))
        fin = [(-.330, .060), (-.180, .060), (-.300, .215), (-.372, .225), (-.392, .205)]
        lean = rotation("z", -24 * sx)
        drone.add("drone_paint", extrude([(y, z) for z, y in fin], -.0075, .0075, .0035, axis=0), lean,
                  (sx * .070, .04, 0))
        tip = [(-.376, .170), (-.262, .170), (-.300, .219), (-.374, .2295), (-.398, .205)]
        drone.add("drone_orange", extrude([(y, z) for z, y in tip], -.0095, .0095, .0035, axis=0), lean,
                  (sx * .070, .04, 0))
        mast = [(sx * .045, .115, -.405), (sx * .056, .19, -.440), (sx * .075, .30, -.485), (sx * .098, .39, -.525)]
        drone.add("drone_rubber", tube(mast, [.0075, .0055, .0042, .0030], 8))
        drone.add("drone_orange", sphere(.0085, 12, 8), None, mast[-1], crease=60.0)
        drone.add("drone_steel", lathe([(0, 0), (.0150, 0), (.0150, .012), (.0110, .022), (0, .022)], 14), None,
                  (sx * .045, .100, -.403))


def skids(drone):
    for sx in (-1, 1):
        x = sx * .205
        path = [(x, -.195, -.365), (x, -.216, -.330), (x, -.224, -.290), (x, -.225, -.10), (x, -.225, .12),
                (x, -.224, .28), (x, -.214, .335), (x, -.188, .378)]
        drone.add("drone_graphite", tube(path, .0130, 12), crease=50.0)
        for z0, z1 in ((-.285, -.130), (.115, .270)):
            drone.add("drone_rubber", tube([(x, -.226, z0), (x, -.226, z0 + .01), (x, -.226, z1 - .01),
                                            (x, -.226, z1)],
                                           [.0150, .0180, .0180, .0150], 12), crease=50.0)
        for z in (-.20, .20):
            leg = []
            for t, w, d in ((0, .034, .015), (.6, .024, .012), (1, .017, .010)):
                p = rounded([(-w, -d), (w, -d), (w, d), (-w, d)], .005)
                a = np.array([sx * .095, -.070, z * .82]) * (1 - t) + np.array([x, -.222, z]) * t
                leg.append(np.stack([a[0] + p[:, 1], np.full(len(p), a[1]), a[2] + p[:, 0]], axis=1))
            drone.add("drone_paint", loft(leg), crease=40.0)


def build():
    drone = Model()
    body(drone)
    arms(drone)
    ducts(drone)
    eye(drone)
    rear(drone)
    skids(drone)
    return drone
