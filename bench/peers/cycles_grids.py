"""Puts a simulated volume over a ground, exports it with Brume's add-on and renders it with Cycles, inside Blender:

  blender -b --factory-startup --python-exit-code 1 -P cycles_grids.py -- GRID.json

script/compare-cycles writes GRID.json."""
import json
import math
import os
import sys

import bpy
from mathutils import Euler, Vector

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from cycles_shaders import Nodes, brume_world, plain_world  # noqa: E402
from cycles_stage import Surfaces, begin, cycles_settings, light, place, quad, volume  # noqa: E402

GROUND = 0.4  # its albedo
EYE, TARGET, FOV = (1.5, -8.5, 2.2), (0, 0, 1.35), 24
DAY, DUSK = ((0.36, 0.40, 0.48), 2.0), ((0.05, 0.06, 0.09), 0.1)  # sky, irradiance of the sun
# Density, color, anisotropy, kelvin where the temperature is 1 (0: none), light.
LOOKS = {"colored": (8, 0.9, 0, 0, DAY), "plain": (16, 0.9, 0.3, 0, DAY), "fire": (20, 0.6, 0, 700, DUSK),
         "both": (6, 0.8, 0, 700, DUSK), "kelvin": (12, 0.9, 0, 1, DUSK)}


def color_by_grids(material, factor):
    """What Brume does with the grids color_r, color_g and color_b, which are multiplied by the density."""
    nodes = Nodes.of(material)
    density = nodes.math("MAXIMUM", nodes.add("Attribute", attribute_name="density").outputs["Fac"], 1e-6)
    joined = nodes.add("CombineRGB")
    for socket, channel in zip(joined.inputs, "rgb"):
        value = nodes.add("Attribute", attribute_name=f"color_{channel}").outputs["Fac"]
        scaled = nodes.math("MULTIPLY", nodes.math("DIVIDE", value, density), factor)
        nodes.set(socket, nodes.math("MINIMUM", scaled, 1))
    shader = next(node for node in material.node_tree.nodes if node.type == "PRINCIPLED_VOLUME")
    nodes.set(shader.inputs["Color"], joined.outputs[0])


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as stream:
        spec = json.load(stream)
    begin(spec)
    scene, surfaces, stem = bpy.context.scene, Surfaces(), os.path.join(spec["folder"], spec["grid"])
    density, color, anisotropy, kelvin, (sky, sun) = LOOKS[spec["grid"]]
    quad("ground", [(-15, -15, 0), (15, -15, 0), (15, 15, 0), (-15, 15, 0)], surfaces.add("ground", [GROUND] * 3))
    light("SUN", sun, rotation=(math.radians(50), 0, math.radians(-35)))
    glow = {"Blackbody_Intensity": 1, "Temperature": kelvin} if kelvin else {}
    colors = {"Color_Attribute": "color"} if spec["colors"] else {}
    medium = volume(stem + ".vdb", (-1, -1, 0.02), density, color, anisotropy, **glow, **colors)
    medium.data.render.space = "WORLD"
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(FOV)
    turn = (Vector(TARGET) - Vector(EYE)).to_track_quat("-Z", "Y").to_euler()
    scene.camera = place("camera", data, EYE, Euler(turn))
    scene.render.resolution_x, scene.render.resolution_y = spec["size"]
    scene.render.resolution_percentage = 100
    scene.world = plain_world(sky)
    scene.brume.sky, scene.brume.voxel = "WORLD", 0.25
    bpy.context.view_layer.update()
    bpy.ops.brume.export_level(filepath=stem + ".glb", format="GLTF")
    if bpy.app.version < (4, 0):
        # Cycles 3 draws volumes half a voxel beside their place (cycles_cloud.py).
        medium.location = Vector(medium.location) - Vector([spec["voxel"] / 2] * 3)
    if spec["colors"]:
        color_by_grids(medium.data.materials[0], color)
    scene.world = brume_world(sky)
    cycles_settings(spec)
    surfaces.show("diffuse")
    scene.render.filepath = stem + "_cycles.exr"
    bpy.ops.render.render(write_still=True)


main()
