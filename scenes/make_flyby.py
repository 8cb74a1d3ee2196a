#!/usr/bin/python3
"""Makes scenes/flyby: a courtyard with a hover drone (flyby.glb), and the drone alone (drone.glb).

    make_flyby.py           writes both files to scenes/flyby
    make_flyby.py --check   makes them in memory, checks them, and compares them with the files
"""
import sys

sys.dont_write_bytecode = True
import flyby_drone
import flyby_level
import flyby_textures
import glb_scene

HOVER = (0.0, 1.26, 2.0)  # above the middle of the pad, whose top is at 0.06


def build():
    drone = flyby_drone.build()
    alone = glb_scene.GlbScene("make_flyby.py", flyby_drone.MATERIALS)
    alone.add("drone", drone, ignore=True)
    yard = glb_scene.GlbScene("make_flyby.py", flyby_level.MATERIALS | flyby_drone.MATERIALS, flyby_textures.make_all())
    flyby_level.build(yard)
    yard.add("drone", drone, HOVER, ignore=True)
    yard.light("daylight", "directional", (1.0, 0.97, 0.92), 0.55, (6.0, 14.0, 9.0), (0.0, 0.0, 0.0), None)
    yard.camera("camera", (2.9, 1.8, 5.6), (-0.3, 0.82, 1.5), 42.0)
    return {"flyby/flyby.glb": (yard.to_bytes(), {}), "flyby/drone.glb": (alone.to_bytes(), {})}


if __name__ == "__main__":
    glb_scene.run(__doc__, build)
