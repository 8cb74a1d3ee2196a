"""Writes glTF 2.0 binary files with PNG images inside. Python standard library and numpy only."""
import json
import struct
import zlib

import numpy as np

FLOAT, UINT32, UINT16 = 5126, 5125, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def png_bytes(pixels):
    """An RGB8 image, shape (height, width, 3), as a PNG file. Each row takes the filter that leaves the least."""
    height, width, channels = pixels.shape
    assert channels == 3 and pixels.dtype == np.uint8
    raw = pixels.reshape(height, width * 3).astype(np.int16)
    left = np.zeros_like(raw)
    left[:, 3:] = raw[:, :-3]
    above = np.zeros_like(raw)
    above[1:] = raw[:-1]
    corner = np.zeros_like(raw)
    corner[1:, 3:] = raw[:-1, :-3]
    guess = left + above - corner
    to_left, to_above, to_corner = abs(guess - left), abs(guess - above), abs(guess - corner)
    paeth = np.where((to_left <= to_above) & (to_left <= to_corner), left,
                     np.where(to_above <= to_corner, above, corner))
    filtered = np.stack([raw, raw - left, raw - above, raw - (left + above) // 2, raw - paeth]).astype(np.uint8)
    cost = abs(filtered.view(np.int8).astype(np.int32)).sum(axis=2)
    best = cost.argmin(axis=0)
    rows = filtered[best, np.arange(height)]
    data = np.concatenate([best[:, None].astype(np.uint8), rows], axis=1).tobytes()

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) +
            chunk(b"IEND", b""))


LUMENS_PER_WATT = 683.0


class GlbWriter:
    """Collects one scene and writes it as a .glb. The order of the calls is the order in the file."""

    def __init__(self, generator):
        self.blob = bytearray()
        self.doc = {"asset": {"version": "2.0", "generator": generator}, "scene": 0, "scenes": [{"nodes": []}],
                    "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "images": [],
                    "textures": [], "cameras": [],
                    "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
                    "extensionsUsed": []}
        self.lights = []

    def _use(self, extension):
        if extension not in self.doc["extensionsUsed"]:
            self.doc["extensionsUsed"].append(extension)

    def _view(self, data, target=None):
        self.blob += b"\0" * (-len(self.blob) % 4)
        view = {"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.blob += data
        self.doc["bufferViews"].append(view)
        return len(self.doc["bufferViews"]) - 1

    def _accessor(self, array, component, kind, target, bounds=False):
        accessor = {"bufferView": self._view(array.tobytes(), target), "componentType": component,
                    "count": len(array), "type": kind}
        if bounds:
            accessor["min"] = [float(v) for v in array.min(axis=0)]
            accessor["max"] = [float(v) for v in array.max(axis=0)]
        self.doc["accessors"].append(accessor)
        return len(self.doc["accessors"]) - 1

    def texture(self, name, pixels):
        """Adds an RGB8 image and a repeating texture of it; returns the texture's index."""
        view = self._view(png_bytes(pixels))
        self.doc["images"].append({"name": name, "bufferView": view, "mimeType": "image/png"})
        self.doc["textures"].append({"sampler": 0, "source": len(self.doc["images"]) - 1})
        return len(self.doc["textures"]) - 1

    def material(self, name, color=(1, 1, 1), roughness=0.8, metallic=0.0, emission=None, base=None, normal=None,
                 rough=None):
        """`color` is linear; `emission` is linear radiance and may exceed 1; `base`, `normal`, `rough` are textures."""
        pbr = {"baseColorFactor": [*map(float, color), 1.0], "metallicFactor": float(metallic),
               "roughnessFactor": float(roughness)}
        out = {"name": name, "pbrMetallicRoughness": pbr}
        if base is not None:
            pbr["baseColorTexture"] = {"index": base}
        if rough is not None:
            pbr["metallicRoughnessTexture"] = {"index": rough}
        if normal is not None:
            out["normalTexture"] = {"index": normal}
        if emission is not None:
            strength = max(emission)
            out["emissiveFactor"] = [round(e / strength, 4) for e in emission]
            out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": float(strength)}}
            self._use("KHR_materials_emissive_strength")
        self.doc["materials"].append(out)
        return len(self.doc["materials"]) - 1

    def mesh(self, name, primitives):
        """`primitives`: (material index, positions, normals, tangents, uvs, indices); tangents and uvs may be None."""
        out = []
        for material, pos, nrm, tan, uv, idx in primitives:
            small = len(pos) < 65535
            attributes = {"POSITION": self._accessor(pos.astype("<f4"), FLOAT, "VEC3", ARRAY_BUFFER, True),
                          "NORMAL": self._accessor(nrm.astype("<f4"), FLOAT, "VEC3", ARRAY_BUFFER)}
            if tan is not None:
                attributes["TANGENT"] = self._accessor(tan.astype("<f4"), FLOAT, "VEC4", ARRAY_BUFFER)
            if uv is not None:
                attributes["TEXCOORD_0"] = self._accessor(uv.astype("<f4"), FLOAT, "VEC2", ARRAY_BUFFER)
            indices = self._accessor(idx.astype("<u2" if small else "<u4"), UINT16 if small else UINT32, "SCALAR",
                                     ELEMENT_ARRAY_BUFFER)
            out.append({"attributes": attributes, "indices": indices, "material": material})
        self.doc["meshes"].append({"name": name, "primitives": out})
        return len(self.doc["meshes"]) - 1

    def node(self, name, translation=None, rotation=None, ignore=False, **fields):
        """Adds a root node. `rotation` is a quaternion x, y, z, w; `ignore`: drawn, but smoke passes through it."""
        node = {"name": name, **fields}
        if translation is not None:
            node["translation"] = [round(float(v), 6) for v in translation]
        if rotation is not None:
            node["rotation"] = [float(v) for v in rotation]
        if ignore:
            node["extras"] = {"brume_ignore": True}
        self.doc["nodes"].append(node)
        self.doc["scenes"][0]["nodes"].append(len(self.doc["nodes"]) - 1)

    def light(self, name, kind, color, intensity, position=(0, 0, 0), rotation=None, cone=None):
        """W/sr for points and spots, W/m^2 for directional light, which the file has in candela and lux; `cone`: inner
        and outer half-angle, radians."""
        light = {"name": name, "type": kind, "color": [*map(float, color)],
                 "intensity": LUMENS_PER_WATT * float(intensity)}
        if cone:
            light["spot"] = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
        self.lights.append(light)
        self._use("KHR_lights_punctual")
        self.node(name, position, rotation,
                  extensions={"KHR_lights_punctual": {"light": len(self.lights) - 1}})

    def camera(self, name, position, rotation, vertical_fov):
        self.doc["cameras"].append({"name": name, "type": "perspective",
                                    "perspective": {"yfov": float(vertical_fov), "aspectRatio": 16 / 9, "znear": 0.05,
                                                    "zfar": 200.0}})
        self.node(name, position, rotation, camera=len(self.doc["cameras"]) - 1)

    def to_bytes(self):
        doc = {key: value for key, value in self.doc.items() if value != []}
        if self.lights:
            doc["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        self.blob += b"\0" * (-len(self.blob) % 4)
        doc["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(doc, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.blob)
        return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text +
                struct.pack("<I4s", len(self.blob), b"BIN\0") + bytes(self.blob))
