"""What scenes for Cycles are built of, inside Blender."""
import os
import sys

import bpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from cycles_shaders import Material, hammon, schlick  # noqa: E402

ROUGHNESS = 0.15  # of metals


def begin(spec):
    """An empty scene, and Brume's add-on to export it."""
    bpy.ops.preferences.addon_install(filepath=spec["addon"])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    bpy.context.preferences.addons["brume_blender"].preferences.program = spec["brume"]


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


def light(kind, energy, location=(0, 0, 0), rotation=(0, 0, 0)):
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy = energy
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    data.cycles.max_bounces = 1024
    place(kind.lower(), data, location, rotation)


def volume(file, location, density, color, anisotropy, **inputs):
    """A Principled Volume that absorbs what it does not scatter, `inputs` of whose sockets have other values; _ stands
    for blanks."""
    material = bpy.data.materials.new("medium")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    node, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(output.inputs["Volume"], node.outputs["Volume"])
    values = {"Density": density, "Color": (color, color, color, 1), "Anisotropy": anisotropy,
              "Absorption_Color": (0, 0, 0, 1), **inputs}
    for name, value in values.items():
        node.inputs[name.replace("_", " ")].default_value = value
    data = bpy.data.volumes.new("cloud")
    data.filepath, data.render.precision, data.render.clipping = file, "FULL", 0
    data.materials.append(material)
    return place("cloud", data, location)


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
