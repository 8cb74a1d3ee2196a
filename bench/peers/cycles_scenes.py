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
from cycles_shaders import Material, hammon, schlick, world  # noqa: E402

ROOM = (2.0, 2.0, 3.0)  # half its width, half its depth, its height [m]
EYE, TARGET = (0.3, -5.2, 1.7), (0.0, 0.0, 1.35)
CLOUD_AT = (0.0, 0.2, 1.3)
NEARER = {"fog_sphere": (18, CLOUD_AT), "cloud": (13, CLOUD_AT)}  # vertical field of view, target
ROUGHNESS = 0.15  # of metals
SKY = {"panel_and_sky": (0.05, 0.09, 0.16), "metals": (0.05, 0.09, 0.16)}
GREY, RED, GREEN = (0.72, 0.72, 0.72), (0.6, 0.12, 0.1), (0.15, 0.5, 0.12)


def place(name, data, location=(0, 0, 0), rotation=(0, 0, 0)):
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(thing)
    return thing


class Surfaces:
    """Materials of which each may be rendered as exported ("principled"), or by other shaders of Cycles: "diffuse",
    Lambert's law; "metal", Brume's model of metals; "glossy", that with Cycles' own shadowing."""

    def __init__(self):
        self._made = []

    def add(self, name, color, image=None):
        """No metal, rough."""
        made = Material(name)
        value = made.nodes.add("TexImage", image=image).outputs["Color"] if image else (*color, 1)
        made.exported(value, 1)
        made.add("diffuse", "BsdfDiffuse", Color=value)
        return self._keep(made)

    def add_metal(self, name, color, normals=None):
        """With an image of a normal map."""
        made = Material(name)
        nodes, geometry = made.nodes, made.nodes.add("NewGeometry")
        normal = nodes.mapped_normal(normals) if normals else geometry.outputs["Normal"]
        facing = nodes.dot(normal, geometry.outputs["Incoming"])
        reflected = schlick(nodes, color, facing)
        made.exported((*color, 1), ROUGHNESS, Metallic=1, **({"Normal": normal} if normals else {}))
        made.add("diffuse", "BsdfDiffuse", Color=(*color, 1), Normal=normal)
        for kind, value in (("metal", nodes.scaled(reflected, hammon(nodes, ROUGHNESS, facing))),
                            ("glossy", reflected)):
            made.add(kind, "BsdfGlossy", Color=value, Roughness=ROUGHNESS, Normal=normal).distribution = "GGX"
        return self._keep(made)

    def add_emitter(self, name, radiance):
        """Black, and as bright from both sides."""
        made = Material(name)
        made.exported((0, 0, 0, 1), 1, Metallic=1, Emission=(*radiance, 1))
        for kind in ("diffuse", "metal", "glossy"):
            made.add(kind, "Emission", Color=(*radiance, 1))
        return self._keep(made)

    def show(self, kind):
        for material in self._made:
            material.show(kind)

    def _keep(self, made):
        made.show("principled")
        self._made.append(made)
        return made.material


def quad(name, corners, material):
    """A square with texture coordinates from 0 to 1."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new()
    for loop, at in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        layer.data[loop].uv = at
    mesh.materials.append(material)
    return place(name, mesh)


def box(name, low, high, material):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2),
                                   (1, 3, 7, 5)])
    mesh.materials.append(material)
    return place(name, mesh)


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


def light(kind, energy, location=(0, 0, 0), rotation=(0, 0, 0)):
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy = energy
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    data.cycles.max_bounces = 1024
    place(kind.lower(), data, location, rotation)


def volume(file, density, color, anisotropy):
    material = bpy.data.materials.new("medium")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    node, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(output.inputs["Volume"], node.outputs["Volume"])
    for name, value in (("Density", density), ("Color", (color, color, color, 1)), ("Anisotropy", anisotropy),
                        ("Absorption Color", (0, 0, 0, 1))):
        node.inputs[name].default_value = value
    data = bpy.data.volumes.new("cloud")
    data.filepath, data.render.precision, data.render.clipping = file, "FULL", 0
    data.materials.append(material)
    return place("cloud", data, CLOUD_AT)


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
    return volume(spec["ball"], 4, 0.95, 0)


def cloud(spec, _):
    light("POINT", 400, (1.6, -1.2, 3.1))
    light("SUN", 1, rotation=SUN)
    return volume(spec["cloud"], 12, 0.9, 0.5)


def cloud_in_room(spec, surfaces):
    room(surfaces)
    light("POINT", 250, (1.5, -1.4, 2.6))
    return volume(spec["cloud"], 12, 0.9, 0)


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
    scene.world = world(SKY.get(spec["scene"], (0, 0, 0)))
    scene.brume.sky, scene.brume.voxel = "WORLD", 0.25


def cycles_settings(spec):
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.exr_codec = "ZIP"
    cycles.samples = spec["samples"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    if bpy.app.version < (4, 0):
        cycles.sampling_pattern = "SOBOL"  # whose pixels are independent
    # Everything that would trade truth for less noise.
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", 1024)
    cycles.volume_step_rate, cycles.volume_max_steps = spec["step_rate"], 65536


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as stream:
        spec = json.load(stream)
    bpy.ops.preferences.addon_install(filepath=spec["addon"])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    bpy.context.preferences.addons["brume_blender"].preferences.program = spec["brume"]
    surfaces = Surfaces()
    medium = SCENES[spec["scene"]](spec, surfaces)
    camera(spec)
    bpy.context.view_layer.update()
    stem = os.path.join(spec["folder"], spec["scene"])
    bpy.ops.brume.export_level(filepath=stem + ".glb", format="GLTF")
    if medium and bpy.app.version < (4, 0):
        # Cycles 3 draws volumes half a voxel beside their place (cycles_cloud.py).
        medium.location = Vector(medium.location) - Vector([spec["voxel"] / 2] * 3)
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
