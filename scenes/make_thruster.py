#!/usr/bin/python3
"""Makes the scenes of scenes/thruster: volume shapes of an ion thruster's plume and a jet flame, and an engine.

    make_thruster.py           writes thruster.glb, flame.glb and engine.glb to scenes/thruster
    make_thruster.py --check   makes them in memory, checks them, and compares them with the files

The shapes are closed, smooth, centred at the origin, with the exhaust towards +z.
"""
import sys

import numpy as np

sys.dont_write_bytecode = True
import glb_scene
import thruster_engine
from hard_surface import ALONG_Z, Model, lathe, loft, monotone, placed

TURN = 2 * np.pi
MATERIALS = {  # the article's red and green, so that each shape can be told from the other
    "ring": dict(color=(0.80, 0.05, 0.04), roughness=0.9),
    "beam": dict(color=(0.05, 0.70, 0.08), roughness=0.9),
    "sheath": dict(color=(0.80, 0.05, 0.04), roughness=0.9),
    "core": dict(color=(0.05, 0.70, 0.08), roughness=0.9),
}
THRUSTER_BOX, FLAME_BOX = (0.06, 0.06, 0.12), (0.5, 0.5, 1.6)  # [m]


def shape(name, part):
    model = Model()
    model.add(name, part, crease=180.0)
    return model


def thruster_ring(segments=96, around=64):
    """A hollow cone: a wall that leaves the annular slot of the nozzle, widens, and thins until it fades."""
    middle = monotone([0, 0.12, 0.5, 1], [0.0148, 0.0146, 0.0168, 0.0180])
    half = monotone([0, 0.10, 0.28, 0.52, 0.72, 0.88, 1], [0.0034, 0.0037, 0.0024, 0.0009, 0.00022, 0.00003, 0.00001])
    profile = []
    for angle in np.arange(around) / around * TURN:
        c, s = np.cos(angle), np.sin(angle)
        t = 0.5 - 0.5 * np.sign(c) * abs(c) ** 1.35
        # It begins round: a half circle of the wall's thickness, as seen in the plane of the axis.
        z = -0.058 + 0.116 * t
        end = z + 0.058
        thick = float(half(t))
        round_off = np.sqrt(max(0.0, 1 - (1 - min(end / (2.4 * thick), 1.0)) ** 2))
        profile.append((float(middle(t)) + np.sign(round(s, 9)) * thick * round_off, z))
    return placed(lathe(profile, segments, loop=True), ALONG_Z)


def thruster_beam(segments=64, rows=56):
    """A tapered spindle with two slight swellings."""
    taper = monotone([0, 0.05, 0.2, 0.45, 0.75, 1], [0.0030, 0.0056, 0.0074, 0.0060, 0.0036, 0.0])
    profile = [(0.0, -0.058)]
    for k in range(1, rows):
        t = (1 - np.cos(np.pi * k / rows)) / 2
        blunt = np.sqrt(1 - (1 - min(t / 0.05, 1.0)) ** 2)  # a round start
        swell = 1 + 0.10 * np.sin(TURN * (t * 2.6 - 0.35)) * (1 - t) * min(t / 0.15, 1)
        profile.append((float(taper(t)) * blunt * swell, -0.058 + 0.116 * t))
    profile.append((0.0, 0.058))
    return placed(lathe(profile, segments), ALONG_Z)


def flame(radius, z0, z1, segments, rows, lobes):
    """A plume of round cross-sections; `radius(t)`, and `lobes(t)`: how far tongues stand out, as a fraction of it."""
    angle = np.arange(segments) / segments * TURN
    rings = [np.tile([0.0, 0.0, z0], (segments, 1))]
    for k in range(1, rows):
        t = (1 - np.cos(np.pi * k / rows)) / 2
        twist = 1.9 * t
        wave = 0.62 * np.cos(5 * (angle + twist)) + 0.38 * np.cos(3 * angle - 4.1 * t + 0.8)
        r = float(radius(t)) * (1 + float(lobes(t)) * wave)
        rings.append(np.stack([r * np.cos(angle), r * np.sin(angle), np.full(segments, z0 + (z1 - z0) * t)], axis=1))
    rings.append(np.tile([0.0, 0.0, z1], (segments, 1)))
    return loft(rings)


def flame_sheath():
    body = monotone([0, 0.03, 0.15, 0.40, 0.72, 0.93, 1], [0.130, 0.150, 0.212, 0.178, 0.096, 0.036, 0.0])
    blunt = lambda t: np.sqrt(1 - (1 - min(t / 0.02, 1.0)) ** 2)
    return flame(lambda t: body(t) * blunt(t), -0.79, 0.79, 96, 80, monotone([0, 0.1, 0.6, 1], [0.0, 0.03, 0.13, 0.20]))


def flame_core():
    """Shock diamonds: swellings that shrink and draw together downstream."""
    body = monotone([0, 0.08, 0.35, 0.7, 1], [0.088, 0.098, 0.078, 0.044, 0.0])

    def radius(t):
        phase = 5.2 * t ** 0.88
        diamond = 0.5 + 0.5 * np.cos(TURN * (phase - 0.42))
        depth = 0.52 * (1 - 0.55 * t) * min(t / 0.04, 1.0)
        blunt = np.sqrt(1 - (1 - min(t / 0.025, 1.0)) ** 2)
        return body(t) * (1 - depth + depth * diamond ** 1.4) * blunt

    return flame(radius, -0.785, 0.42, 64, 96, lambda t: 0.0)


def build():
    thruster = glb_scene.GlbScene("make_thruster.py", MATERIALS)
    thruster.add("ring", shape("ring", thruster_ring()))
    thruster.add("beam", shape("beam", thruster_beam()))
    jet = glb_scene.GlbScene("make_thruster.py", MATERIALS)
    jet.add("sheath", shape("sheath", flame_sheath()))
    jet.add("core", shape("core", flame_core()))
    return {"thruster/thruster.glb": (thruster.to_bytes(), {"ring": THRUSTER_BOX, "beam": THRUSTER_BOX}),
            "thruster/flame.glb": (jet.to_bytes(), {"sheath": FLAME_BOX, "core": FLAME_BOX}),
            "thruster/engine.glb": (thruster_engine.scene().to_bytes(), {})}


if __name__ == "__main__":
    glb_scene.run(__doc__, build)
