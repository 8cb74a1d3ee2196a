"""Builds a scene in Blender, exports it with Brume's add-on and renders it with Cycles:

  blender -b --factory-startup --python-exit-code 1 -P cycles_scenes.py -- SCENE.json

script/compare-cycles writes SCENE.json. Prints a line "CYCLES {...}" per picture."""
import json
import math
import os
import sys
import time

import bpy
from mathutils import Euler, Vector

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from cycles_shaders import brume_world, plain_world  # noqa: E402
from cycles_stage import Surfaces, begin, box, cycles_settings, light, place, quad, volume  # noqa: E402

ROOM = (2.0, 2.0, 3.0)  # half its width, half its depth, its height [m]
EYE, TARGET = (0.3, -5.2, 1.7), (0.0, 0.0, 1.35)
CLOUD_AT = (0.0, 0.2, 1.3)
NEARER = {"fog_sphere": (18, CLOUD_AT), "cloud": (13, CLOUD_AT)}  # vertical field of view, target
SKY = {"panel_and_sky": (0.05, 0.09, 0.16), "metals": (0.05, 0.09, 0.16)}
GREY, RED, GREEN = (0.72, 0.72, 0.72), (0.6, 0.12, 0.1), (0.15, 0.5, 0.12)


def room(surfaces, image=None):
    """Open to the eye."""
    x, y, z = ROOM
    grey = surfaces.add("grey", GREY)
    shown = surfaces.add("image", GREY, image) if image else grey
    quad("floor", [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], shown)
    quad("ceiling", [(-x, y, z), (x, y, z), (x, -y, z), (-x, -y, z)], grey)
    quad("back", [(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)], shown)
    quad("left", [(-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z)], surfaces.add("red", RED))
    quad("right", [(x, y, 0), (x, -y, 0), (x, -y, z), (x, y, z)], surfaces.add("green", GREEN))


SUN = (math.radians(50), 0, math.radians(-35))  # from behind the eye, from the left


def walls(_, surfaces):
    room(surfaces)
    box("block", (-1.2, -0.2, 0), (-0.3, 0.9, 1.5), surfaces.add("block", (0.8, 0.75, 0.6)))
    light("POINT", 250, (0.6, -0.6, 2.3))


def textured_room(spec, surfaces):
    room(surfaces, bpy.data.images.load(spec["image"]))
    box("block", (0.2, -0.3, 0), (1.1, 0.6, 0.9), surfaces.add("block", (0.8, 0.75, 0.6)))
    light("POINT", 150, (-0.7, -0.4, 2.2))
    light("SUN", 2, rotation=SUN)


def fog_sphere(spec, _):
    light("POINT", 400, (1.6, -1.2, 3.1))
    light("SUN", 1, rotation=SUN)
    return volume(spec["ball"], CLOUD_AT, 4, 0.95, 0)


def cloud(spec, _):
    light("POINT", 400, (1.6, -1.2, 3.1))
    light("SUN", 1, rotation=SUN)
    return volume(spec["cloud"], CLOUD_AT, 12, 0.9, 0.5)


def cloud_in_room(spec, surfaces):
    room(surfaces)
    light("POINT", 250, (1.5, -1.4, 2.6))
    return volume(spec["cloud"], CLOUD_AT, 12, 0.9, 0)


def panel_and_sky(_, surfaces, normals=None):
    """Under an emitting panel; `normals`: a normal map at the back."""
    x, y, z = ROOM
    silver, gold = surfaces.add_metal("silver", (0.9, 0.9, 0.9)), surfaces.add_metal("gold", (0.9, 0.6, 0.3))
    quad("floor", [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], silver)
    quad("back", [(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)], surfaces.add_metal("back", GREY, normals))
    quad("left", [(-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z)], gold)
    box("block", (0.2, -0.3, 0), (1.1, 0.6, 0.9), gold)
    panel = [(-1.1, -0.4, 2.0), (-0.3, -0.4, 2.0), (-0.3, 0.4, 2.3), (-1.1, 0.4, 2.3)]
    quad("panel", panel, surfaces.add_emitter("panel", (1, 0.8, 0.5)))
    light("POINT", 0)  # Without any, Brume adds a sun.


def metals(spec, surfaces):
    normals = bpy.data.images.load(spec["normals"])
    normals.colorspace_settings.name = "Non-Color"
    panel_and_sky(spec, surfaces, normals)


SCENES = {"walls": walls, "textured_room": textured_room, "fog_sphere": fog_sphere, "cloud": cloud,
          "cloud_in_room": cloud_in_room, "panel_and_sky": panel_and_sky, "metals": metals}


def camera(spec):
    scene = bpy.context.scene
    data = bpy.data.cameras.new("camera")
    fov, target = NEARER.get(spec["scene"], (42, TARGET))
    data.sensor_fit, data.angle = "VERTICAL", math.radians(fov)
    away = Vector(target) - Vector(EYE)
    turn = away.to_track_quat("-Z", "Y").to_euler()
    scene.camera = place("camera", data, EYE, Euler(turn))
    scene.render.resolution_x, scene.render.resolution_y = spec["size"]
    scene.render.resolution_percentage = 100
    scene.world = plain_world(SKY.get(spec["scene"], (0, 0, 0)))
    scene.brume.sky, scene.brume.voxel = "WORLD", 0.25


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as stream:
        spec = json.load(stream)
    begin(spec)
    surfaces = Surfaces()
    medium = SCENES[spec["scene"]](spec, surfaces)
    camera(spec)
    bpy.context.view_layer.update()
    stem = os.path.join(spec["folder"], spec["scene"])
    bpy.ops.brume.export_level(filepath=stem + ".glb", format="GLTF")
    if medium and bpy.app.version < (4, 0):
        # Cycles 3 draws volumes half a voxel beside their place (cycles_cloud.py).
        medium.location = Vector(medium.location) - Vector([spec["voxel"] / 2] * 3)
    bpy.context.scene.world = brume_world(SKY.get(spec["scene"], (0, 0, 0)))
    cycles_settings(spec)
    for kind in spec["surfaces"]:
        surfaces.show(kind)
        for seed in spec["seeds"]:
            bpy.context.scene.cycles.seed = seed
            bpy.context.scene.render.filepath = f"{stem}_{kind}_{seed}.exr"
            started = time.process_time()
            bpy.ops.render.render(write_still=True)
            taken = {"surfaces": kind, "seed": seed, "cpu": time.process_time() - started}
            print("CYCLES " + json.dumps(taken), flush=True)


main()
