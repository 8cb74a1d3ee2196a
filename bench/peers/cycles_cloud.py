"""Renders a volume once with Cycles, inside Blender:

  blender -b --factory-startup --python-exit-code 1 -P cycles_cloud.py -- SCENE.json OUT.exr SAMPLES

The medium, camera and light are those of SCENE.json (script/bench-peers writes it). Prints a line "CYCLES {...}" with
the processor time of Blender's start and of the render."""
import json
import math
import sys
import time

import bpy
from mathutils import Matrix, Vector


def medium(scene):
    """Scatters evenly in all directions; the file's densities times the extinction."""
    material = bpy.data.materials.new("medium")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    density = nodes.new("ShaderNodeAttribute")
    density.attribute_name = "density"

    def scaled(kind, coefficient, colour):
        times = nodes.new("ShaderNodeMath")
        times.operation = "MULTIPLY"
        times.inputs[1].default_value = coefficient
        links.new(density.outputs["Fac"], times.inputs[0])
        shader = nodes.new(kind)
        shader.inputs["Color"].default_value = (colour, colour, colour, 1)
        links.new(times.outputs[0], shader.inputs["Density"])
        return shader

    # Of this shader white scatters all, of that one black absorbs all.
    scatter = scaled("ShaderNodeVolumeScatter", scene["extinction"] * scene["albedo"], 1)
    scatter.inputs["Anisotropy"].default_value = 0
    absorb = scaled("ShaderNodeVolumeAbsorption", scene["extinction"] * (1 - scene["albedo"]), 0)
    both = nodes.new("ShaderNodeAddShader")
    links.new(scatter.outputs[0], both.inputs[0])
    links.new(absorb.outputs[0], both.inputs[1])
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(both.outputs[0], output.inputs["Volume"])
    return material


def place(name, data, matrix):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.matrix_world = matrix
    return thing


def build(scene):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)

    volume = bpy.data.volumes.new("cloud")
    volume.filepath = scene["file"]
    volume.render.precision = "FULL"
    volume.render.clipping = 0
    volume.materials.append(medium(scene))
    # Blender 3 draws samples in the middles of voxels that begin at the integers of index space; they lie at the
    # integers. The results name what is left of such an offset.
    beside = 0.5 * scene["voxel"] if bpy.app.version < (4, 0) else 0
    place("cloud", volume, Matrix.Translation((-beside, -beside, -beside)))

    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = scene["irradiance"]
    sun.angle = 0
    place("sun", sun, Vector(scene["to_sun"]).to_track_quat("Z", "Y").to_matrix().to_4x4())

    eye = Vector(scene["eye"])
    back = (eye - Vector(scene["target"])).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(scene["fov"])
    camera.clip_end = 1e6
    axes = Matrix((right, back.cross(right), back)).transposed().to_4x4()
    bpy.context.scene.camera = place("camera", camera, Matrix.Translation(eye) @ axes)

    world = bpy.data.worlds.new("black")
    world.color = (0, 0, 0)
    bpy.context.scene.world = world


def settings(scene, out, samples):
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = scene["size"]
    render.resolution_percentage = 100
    render.filepath = out
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.seed = scene.get("seed", 0)
    cycles.pixel_filter_type = "BOX"
    if "bounces" in scene:
        cycles.volume_bounces = cycles.max_bounces = scene["bounces"]
        cycles.filter_width = 1
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.volume_step_rate = scene["step_rate"]
    else:
        # No second scattering, and rays through the middles of pixels.
        cycles.volume_bounces = 0
        cycles.filter_width = 0.01
    cycles.light_sampling_threshold = 0
    # It draws a volume inside a mesh around its voxels, and each time that a ray to the sun enters or leaves counts;
    # rays with more would be blocked.
    cycles.transparent_max_bounces = 1024


def main():
    file, out, samples = sys.argv[sys.argv.index("--") + 1:]
    with open(file) as stream:
        scene = json.load(stream)
    build(scene)
    settings(scene, out, int(samples))
    started = time.process_time()
    bpy.ops.render.render(write_still=True)
    print("CYCLES " + json.dumps({"start": started, "render": time.process_time() - started}))


main()
