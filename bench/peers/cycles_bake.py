"""Bakes smoke and fire with Mantaflow, inside Blender:

  blender -b --factory-startup --python-exit-code 1 -P cycles_bake.py -- KIND FOLDER

KIND: colored, plain, fire, or both (fire in smoke). FOLDER/data gets the OpenVDB files of FRAMES frames."""
import sys

import bpy

RESOLUTION, FRAMES = 48, 36
INFLOWS = {
    "colored": [((-0.35, 0, 0.35), 0.22, {"flow_type": "SMOKE", "smoke_color": (0.9, 0.3, 0.2)}),
                ((0.35, 0.1, 0.35), 0.22, {"flow_type": "SMOKE", "smoke_color": (0.2, 0.4, 0.9)})],
    "plain": [((0, 0, 0.35), 0.3, {"flow_type": "SMOKE"})],
    "fire": [((0, 0, 0.35), 0.3, {"flow_type": "FIRE", "fuel_amount": 1.0})],
    "both": [((0, 0, 0.35), 0.3, {"flow_type": "BOTH", "fuel_amount": 1.2, "smoke_color": (0.5, 0.5, 0.5)})],
}


def add_inflow(location, radius, settings):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=location)
    modifier = bpy.context.object.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = "FLOW"
    modifier.flow_settings.flow_behavior = "INFLOW"
    for name, value in settings.items():
        setattr(modifier.flow_settings, name, value)


def main():
    kind, folder = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, FRAMES
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.5))
    domain = bpy.context.object
    domain.scale = (2, 2, 3)
    bpy.ops.object.transform_apply(location=False, scale=True)
    for inflow in INFLOWS[kind]:
        add_inflow(*inflow)
    # Last: a domain that is there refuses inflows of another colour.
    modifier = domain.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    settings = modifier.domain_settings
    settings.domain_type, settings.resolution_max, settings.vorticity = "GAS", RESOLUTION, 0.3
    settings.cache_type, settings.cache_data_format, settings.cache_directory = "ALL", "OPENVDB", folder
    settings.cache_frame_start, settings.cache_frame_end = 1, FRAMES
    if kind in ("fire", "both"):
        settings.burning_rate, settings.flame_smoke = 0.6, 1.5
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()


main()
