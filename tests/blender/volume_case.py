"""Base of the tests of volumes: files with a ball, volume objects, and pictures of them before a white world."""

import json
import math
import os
import subprocess

import addon_case
import bpy
import level_parts
import numpy as np
from addon_case import AddonCase

RADIUS = 1.2  # Of the ball of every file, in units of the file.
EDGE, VOXEL = 32, 0.1
# Trilinear values reach beyond the voxels inside of the ball, and are less than 1 inside of it, by a cell's diagonal.
SLACK = math.sqrt(3) * VOXEL
CENTRE = np.array([0.3, -0.2, 0.5])  # Of the ball, in the axes of the file.
BRUME = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def write_ball(path, grid="density", centre=CENTRE, value=1.0):
    """Writes a .vdb file with a ball of one value."""
    folder = os.path.dirname(path)
    os.makedirs(folder, exist_ok=True)
    index = np.indices((EDGE, EDGE, EDGE)).reshape(3, -1).T  # z, y, x.
    first = np.round(np.asarray(centre) / VOXEL) - EDGE // 2
    points = (index[:, ::-1] + first) * VOXEL
    values = np.where(np.linalg.norm(points - centre, axis=1) <= RADIUS, value, 0).astype("<f4")
    values.tofile(os.path.join(folder, "ball.raw"))
    about = {"format": "brume raw volume", "version": 1, "raw": "ball.raw", "size": [EDGE] * 3, "name": grid}
    about |= {"origin": [int(axis) for axis in first], "class": "fog volume"}
    about["world_from_index"] = (VOXEL * np.vstack([np.identity(3), np.zeros(3)])).tolist()
    with open(os.path.join(folder, "ball.json"), "w", encoding="ascii") as file:
        json.dump(about, file)
    command = [addon_case.BRUME, "convert", "ball.json", "written.vdb"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    os.replace(os.path.join(folder, "written.vdb"), path)  # Brume takes a "%d" of a name for a number.
    for part in ("ball.raw", "ball.json"):
        os.remove(os.path.join(folder, part))
    return path


def volume_material(name="smoke", **inputs):
    """A Principled Volume with values by the names of its sockets."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    node, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(output.inputs["Volume"], node.outputs["Volume"])
    for key, value in inputs.items():
        socket = node.inputs[key.replace("_", " ")]
        socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    return made


class VolumeCase(AddonCase):
    def setUp(self):
        super().setUp()
        self.ball = write_ball(os.path.join(self.folder, "files", "ball.vdb"))

    def volume(self, path=None, name="cloud", material=None, collection=None, **settings):
        data = bpy.data.volumes.new(name)
        data.filepath = self.ball if path is None else path
        for key, value in settings.items():
            setattr(data, key, value)
        if material:
            data.materials.append(material)
        made = level_parts.add(name, data, collection=collection)
        bpy.context.view_layer.update()
        return made

    def sequence(self, **settings):
        for frame in (5, 6, 7, 8):
            write_ball(os.path.join(self.folder, "files", f"smoke_{frame:03d}.vdb"), centre=(0.8 * (frame - 6), 0, 0))
        path = os.path.join(self.folder, "files", "smoke_006.vdb")
        known = {"is_sequence": True, "frame_start": 10, "frame_duration": 3, "frame_offset": 4}
        return self.volume(path, **(known | settings))

    def tables(self):
        return self.export().get("volume", [])

    def table(self):
        tables = self.tables()
        self.assertEqual(len(tables), 1, self.said())
        return tables[0]

    def assertLoads(self):
        """Brume itself loads what is exported."""
        info = [addon_case.BRUME, "info", "level.toml"]
        subprocess.run(info, cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def assertSkipped(self, part):
        self.assertEqual(self.tables(), [])
        self.assertSaid('the volume "cloud" is not exported: ', "WARNING")
        self.assertSaid(part, "WARNING")

    def assertNear(self, found, expected, relative=1e-6):
        difference = np.abs(np.array(found) - np.array(expected)).max()
        self.assertLess(difference, relative * max(1.0, np.abs(expected).max()), (found, expected))


def stage(scene, location, rotation, size, lens):
    """A camera before a white world, which Brume shows as it is."""
    camera = level_parts.add("camera", bpy.data.cameras.new("camera"), location=location, rotation=rotation)
    camera.data.lens, camera.data.sensor_width = lens, 36
    scene.camera = camera
    scene.world = bpy.data.worlds.new("white")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.8, 0.8, 0.8, 1)
    scene.brume.sky, scene.brume.tone, scene.view_settings.view_transform = "WORLD", "standard", "Standard"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    bpy.context.view_layer.update()
    return camera


def transmittance(path):
    """Of a picture before a background of 0.8; rows from the bottom."""
    image = bpy.data.images.load(path)
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[..., 1]
    bpy.data.images.remove(image)
    linear = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return linear / 0.8


def outline(matrix_world, centre, radius, camera, size):
    """Low and high corner of the image of an ellipsoid [px from the bottom left]: the dual of the conic that a quadric
    is projected to is P Q* P^T (Hartley and Zisserman 2004, section 8.3)."""
    width, height = size
    depsgraph = bpy.context.evaluated_depsgraph_get()
    clip = np.array(camera.calc_matrix_camera(depsgraph, x=width, y=height)) @ np.array(camera.matrix_world.inverted())
    pixels = np.array([[width / 2, 0, 0, width / 2], [0, height / 2, 0, height / 2], [0, 0, 0, 1]])
    move = np.identity(4)
    move[:3, 3] = centre
    place = np.array(matrix_world) @ move
    ball = np.diag([radius**2] * 3 + [-1])
    conic = pixels @ clip @ place @ ball @ (pixels @ clip @ place).T
    edges = []
    for axis in (0, 1):
        root = math.sqrt(conic[axis, 2] ** 2 - conic[axis, axis] * conic[2, 2])
        edges.append(sorted([(conic[axis, 2] - root) / conic[2, 2], (conic[axis, 2] + root) / conic[2, 2]]))
    return np.array(edges).T
