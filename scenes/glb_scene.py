"""Named models, lights and a camera as a .glb file, and the command line of the scripts that make such files."""
import argparse
import os
import sys

import numpy as np

from demo_geometry import look_rotation, quaternion
from gltf_writer import GlbWriter


class GlbScene:
    """`materials`: name -> colour and so on, as `GlbWriter.material` takes it; `images`: texture -> kind -> pixels."""

    def __init__(self, script, materials=None, images=None):
        self.script, self.materials, self.images = script, materials or {}, images or {}
        self.objects, self.lights, self.cameras = [], [], []

    def add(self, name, model, at=None, rotation=None, ignore=False):
        assert all(name != other[0] for other in self.objects), name
        self.objects.append((name, model, at, rotation, ignore))

    def light(self, *fields):
        """Name, kind, linear colour, intensity [cd, lux], position, target or None, half-angles of the cone or None."""
        self.lights.append(fields)

    def camera(self, name, eye, target, fov_degrees):
        self.cameras.append((name, eye, target, fov_degrees))

    def _materials(self, glb, used):
        textures, index = {}, {}
        for name in used:
            spec = dict(self.materials[name])
            texture = spec.pop("texture", None)
            for kind, pixels in self.images.get(texture, {}).items():
                if (texture, kind) not in textures:
                    textures[(texture, kind)] = glb.texture(f"{texture}_{kind}", pixels)
                spec[{"color": "base", "normal": "normal", "rough": "rough"}[kind]] = textures[(texture, kind)]
            index[name] = glb.material(name, **spec)
        return index

    def to_bytes(self):
        glb = GlbWriter(f"Brume scenes/{self.script}")
        arrays = {id(model): model.arrays() for _, model, *_ in self.objects}
        index = self._materials(glb, list(dict.fromkeys(p[0] for parts in arrays.values() for p in parts)))
        meshes = {}
        for name, model, at, rotation, ignore in self.objects:
            if id(model) not in meshes:
                meshes[id(model)] = glb.mesh(name, [(index[part[0]], *part[1:]) for part in arrays[id(model)]])
            glb.node(name, at, None if rotation is None else quaternion(rotation), ignore, mesh=meshes[id(model)])
        for name, kind, color, intensity, position, target, cone in self.lights:
            turn = None if target is None else quaternion(look_rotation(np.subtract(target, position)))
            glb.light(name, kind, color, intensity, position, turn, cone)
        for name, eye, target, fov in self.cameras:
            glb.camera(name, eye, quaternion(look_rotation(np.subtract(target, eye))), np.radians(fov))
        return glb.to_bytes()


def run(description, build):
    """`build()`: path below this folder -> (bytes, names of volume shapes and the boxes they fit in)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    here = os.path.dirname(os.path.abspath(__file__))
    findings = 0
    for name, (data, shapes) in build().items():
        path = os.path.join(here, name)
        if args.check:
            import scene_check
            findings += scene_check.run(data, path, shapes)
            continue
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path + ".part", "wb") as out:
            out.write(data)
        os.replace(path + ".part", path)
        print(f"{path}: {len(data)} bytes")
    sys.exit(1 if findings else 0)
