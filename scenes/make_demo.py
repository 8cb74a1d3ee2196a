#!/usr/bin/python3
"""Makes scenes/demo.glb: a roadhouse at night, textures, lights, camera and grenade included.

    make_demo.py                     writes demo.glb beside this file
    make_demo.py --check             makes it in memory, checks it, and compares it with the file
    make_demo.py --preview OUT.png   also draws a small picture of it (--camera "px,py,pz tx,ty,tz fov")

The same bytes come out of every run with the same numpy and zlib.
"""
import argparse
import os
import sys
import tomllib

import numpy as np

sys.dont_write_bytecode = True
import demo_house
import demo_props
import demo_textures
from demo_geometry import look_rotation, quaternion, unit
from gltf_writer import GlbWriter

# Linear colours. A textured material multiplies its texture by `color`.
MATERIALS = {
    "brick": dict(texture="brick", roughness=0.86),
    "plaster": dict(texture="plaster", roughness=0.82),
    "plaster_in": dict(texture="plaster", color=(0.92, 0.80, 0.66), roughness=0.85),
    "planks": dict(texture="planks", roughness=0.72),
    "siding": dict(texture="planks", color=(0.50, 0.62, 0.66), roughness=0.75),
    "crate": dict(texture="planks", color=(1.0, 0.86, 0.64), roughness=0.8),
    "tiles": dict(texture="tiles", roughness=1.0, rough=True),
    "concrete": dict(texture="concrete", roughness=0.84),
    "shingles": dict(texture="shingles", roughness=0.62),
    "corrugated": dict(texture="corrugated", roughness=0.5, metallic=0.35),
    "ground": dict(texture="ground", roughness=1.0, rough=True),
    "grass": dict(texture="grass", roughness=0.95),
    "trim": dict(color=(0.055, 0.060, 0.065), roughness=0.55),
    "door_paint": dict(color=(0.22, 0.035, 0.028), roughness=0.42),
    "steel": dict(color=(0.28, 0.28, 0.29), roughness=0.42, metallic=0.9),
    "dark_metal": dict(color=(0.045, 0.048, 0.052), roughness=0.5, metallic=0.5),
    "drum_blue": dict(color=(0.030, 0.095, 0.17), roughness=0.45, metallic=0.25),
    "drum_rust": dict(color=(0.20, 0.066, 0.024), roughness=0.7, metallic=0.2),
    "rubber": dict(color=(0.016, 0.016, 0.018), roughness=0.75),
    "sign_board": dict(color=(0.018, 0.022, 0.030), roughness=0.5),
    "conifer": dict(color=(0.008, 0.014, 0.011), roughness=0.95),
    "canister": dict(color=(0.16, 0.20, 0.13), roughness=0.45, metallic=0.3),
    "canister_band": dict(color=(0.55, 0.42, 0.06), roughness=0.5),
    "glow_tungsten": dict(color=(0.8, 0.6, 0.4), emission=(26.0, 14.5, 6.0)),
    "glow_work": dict(color=(0.8, 0.7, 0.5), emission=(34.0, 23.0, 12.5)),
    "glow_teal": dict(color=(0.3, 0.6, 0.6), emission=(0.5, 8.0, 6.8)),
    "glow_red": dict(color=(0.6, 0.1, 0.1), emission=(16.0, 1.1, 0.6)),
    "glow_violet": dict(color=(0.5, 0.4, 0.7), emission=(6.0, 3.8, 11.0)),
    "glow_pink": dict(color=(0.6, 0.2, 0.3), emission=(9.0, 0.7, 2.9)),
    "glow_white": dict(color=(0.7, 0.7, 0.7), emission=(7.0, 8.2, 9.0)),
    "glow_sodium": dict(color=(0.8, 0.5, 0.2), emission=(26.0, 11.5, 2.2)),
}

# name: kind, linear colour, intensity [W/sr, or W/m^2 for the moon], position, target, half-angles of the cone
LIGHTS = {
    "lamp_tungsten": ("point", (1.0, 0.60, 0.26), 34.0, (-4.45, 2.42, -4.55), None, None),
    "lamp_work": ("spot", (1.0, 0.70, 0.38), 260.0, (-1.42, 1.62, -5.48), (-2.75, 1.35, 0.0), (0.24, 0.46)),
    "lamp_neon": ("point", (0.08, 0.92, 0.78), 24.0, (2.90, 3.20, -0.95), None, None),
    "lamp_loft": ("point", (0.60, 0.38, 1.0), 9.0, (3.50, 4.85, -5.20), None, None),
    "lamp_door": ("point", (1.0, 0.085, 0.045), 16.0, (-2.50, 2.70, 0.30), None, None),
    "lamp_sign": ("point", (1.0, 0.14, 0.40), 4.5, (5.70, 4.45, 2.75), None, None),
    "lamp_washroom": ("point", (0.80, 0.93, 1.0), 5.0, (5.20, 2.50, -6.35), None, None),
    "lamp_yard": ("spot", (1.0, 0.50, 0.13), 55.0, (5.94, 4.60, 4.40), (5.1, 0.0, 4.9), (0.75, 1.15)),
    "moon": ("directional", (0.42, 0.60, 1.0), 0.75, (-20.0, 24.0, 14.0), (0.0, 0.0, 0.0), None),
}

CAMERA = ((-6.3, 1.5, 13.9), (-0.40, 2.80, -0.6), 45.0)  # eye, target, vertical field of view in degrees


class Scene:
    """Named objects in world space, kept both for the file and for the checks."""

    def __init__(self):
        self.objects = []  # name, Solid, translation, rotation matrix, ignore
        self.grenade = None

    def add(self, name, solid, at=None, rotation=None, ignore=False):
        assert all(name != other[0] for other in self.objects), name
        self.objects.append((name, solid, at, rotation, ignore))


def build_scene():
    scene = Scene()
    demo_house.build(scene)
    demo_props.build(scene)
    scene.grenade = demo_props.grenade()
    return scene


def write_materials(glb, images):
    textures = {(name, kind): glb.texture(f"{name}_{kind}", pixels) for name, kinds in images.items()
                for kind, pixels in kinds.items()}
    index = {}
    for name, spec in MATERIALS.items():
        texture = spec.get("texture")
        index[name] = glb.material(name, spec.get("color", (1, 1, 1)), spec.get("roughness", 0.8),
                                   spec.get("metallic", 0.0), spec.get("emission"), textures.get((texture, "color")),
                                   textures.get((texture, "normal")),
                                   textures[(texture, "rough")] if spec.get("rough") else None)
    return index


def make_glb(scene, images):
    glb = GlbWriter("Brume scenes/make_demo.py")
    materials = write_materials(glb, images)
    meshes = {}

    def mesh_of(name, solid):
        if id(solid) not in meshes:
            meshes[id(solid)] = glb.mesh(name, [(materials[part[0]], *part[1:]) for part in solid.arrays()])
        return meshes[id(solid)]

    for name, solid, at, rotation, ignore in scene.objects:
        glb.node(name, at, None if rotation is None else quaternion(rotation), ignore, mesh=mesh_of(name, solid))
    glb.node("Grenade", (-3.6, 0.5, 10.0), mesh=mesh_of("Grenade", scene.grenade))
    for name, (kind, color, intensity, position, target, cone) in LIGHTS.items():
        turn = None if target is None else quaternion(look_rotation(np.subtract(target, position)))
        glb.light(name, kind, color, intensity, position, turn, cone)
    eye, target, fov = CAMERA
    glb.camera("camera_yard", eye, quaternion(look_rotation(np.subtract(target, eye))), np.radians(fov))
    return glb.to_bytes()


def smoke_of_timeline():
    """Where the timeline's first smoke goes off, and how many voxels it fills."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "demo.toml"), "rb") as file:
        timeline = tomllib.load(file)
    return next(e["at"] for e in timeline["event"] if e["type"] == "smoke"), timeline["smoke"]["voxels"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--preview", metavar="OUT.png")
    parser.add_argument("--camera", help="px,py,pz tx,ty,tz fov")
    parser.add_argument("--smoke", action="store_true", help="put the smoke of demo.toml into the preview")
    args = parser.parse_args()
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "demo.glb")

    images = demo_textures.make_all()
    scene = build_scene()
    data = make_glb(scene, images)
    if args.check:
        import demo_check
        return demo_check.run(scene, data, path)
    with open(path + ".part", "wb") as out:
        out.write(data)
    os.replace(path + ".part", path)
    print(f"{path}: {len(data)} bytes, {len(scene.objects)} objects")
    if args.preview:
        import preview
        camera = CAMERA
        if args.camera:
            eye, target, fov = args.camera.split()
            camera = tuple(map(float, eye.split(","))), tuple(map(float, target.split(","))), float(fov)
        smoke = smoke_of_timeline() if args.smoke else None
        preview.draw(scene, images, MATERIALS, LIGHTS, camera, args.preview, smoke)
    return 0


if __name__ == "__main__":
    sys.exit(main())
