"""Run by Blender with a display: blender -b --factory-startup -P lights.py -- ADDON.zip BRUME FOLDER

Exports a light of each kind above a white plane, and lets Blender's own renderer say how bright the plane is below it:
lights.json.
"""

import json
import math
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import level_parts  # noqa: E402

# [W]; sun [W/m^2]. All are two metres above a diffuse plane with albedo 0.8.
LIGHTS = {"POINT": 100, "SPOT": 100, "AREA": 100, "SUN": 3}


def diffuse():
    material = bpy.data.materials.new("even")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    surface, end = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    surface.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1)
    material.node_tree.links.new(end.inputs["Surface"], surface.outputs["BSDF"])
    return material


def build_plane():
    plane = bpy.data.meshes.new("plane")
    plane.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    plane.materials.append(diffuse())
    level_parts.add("plane", plane)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", 0.1
    bpy.context.scene.camera = level_parts.add("camera", camera, location=(0, 0, 9))


def add_light(kind):
    """No shadows, no highlights, small lights: only power and distance matter."""
    light = bpy.data.lights.new("light", kind)
    light.energy, light.use_shadow, light.specular_factor = LIGHTS[kind], False, 0
    if kind in {"POINT", "SPOT"}:
        light.shadow_soft_size = 0.01
    if kind == "AREA":
        light.size = 0.05
    if kind == "SPOT":
        light.spot_size, light.spot_blend = math.radians(90), 0
    return level_parts.add("light", light, location=(0, 0, 2))


def radiance(path):
    """Radiance at the centre of the image, rendered by EEVEE."""
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.taa_render_samples, scene.eevee.use_soft_shadows = 16, False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    return image.pixels[4 * (8 * 4 + 4)]


def main():
    addon, _, folder = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    build_plane()
    measured = {}
    for kind in LIGHTS:
        light = add_light(kind)
        bpy.ops.brume.export_level(filepath=os.path.join(folder, f"light_{kind}.glb"), format="GLTF")
        measured[kind] = radiance(os.path.join(folder, f"light_{kind}.exr"))
        bpy.data.objects.remove(light)
    with open(os.path.join(folder, "lights.json"), "w", encoding="utf-8") as file:
        json.dump(measured, file)


main()
