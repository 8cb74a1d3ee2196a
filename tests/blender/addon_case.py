"""Base of the add-on's tests: an empty scene with a floor, and a program that records its arguments."""

import json
import os
import struct
import tempfile
import tomllib
import unittest

import bpy
import level_parts

BRUME = FOLDER = ""  # Set by addon_test.py.

# Writes its arguments to args.json, an image where one is expected, and lists OPTIONS in its help.
_PROGRAM = """#!/usr/bin/env python3
import json, os, shutil, sys
folder = os.path.dirname(os.path.abspath(__file__))
if "--help" in sys.argv:
    print("{options}")
    raise SystemExit
with open(os.path.join(folder, "args.json"), "w") as file:
    json.dump(sys.argv[1:], file)
shutil.copytree(".", os.path.join(folder, "work"), dirs_exist_ok=True)
image = os.path.join(folder, "image.png")
if "--frames" in sys.argv:
    first, last = map(int, sys.argv[sys.argv.index("--frames") + 1].split("-"))
    target = sys.argv[sys.argv.index("-o") + 1]
    for frame in range(first, last + 1):
        shutil.copy(image, target % frame if "%" in target else target)
elif sys.argv[1] == "render":
    shutil.copy(image, "render.png")
"""


def box(name, low, high, **more):
    return level_parts.add(name, level_parts.box_mesh(name, low, high), **more)


class AddonCase(unittest.TestCase):
    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_enable(module="brume_blender")
        self.scene = bpy.context.scene
        self.scene.render.fps = 24
        self.floor = box("floor", (-5, -5, -0.2), (5, 5, 0))
        self.folder = tempfile.mkdtemp(dir=FOLDER)
        self.preferences = bpy.context.preferences.addons["brume_blender"].preferences
        self.preferences.program = BRUME

    def event(self, kind, location=(0, 0, 1), frame=1, **settings):
        made = level_parts.add(kind, None, location=location)
        made.brume_event.type, made.brume_event.frame = kind, frame
        for name, value in settings.items():
            setattr(made.brume_event, name, value)
        bpy.context.view_layer.update()
        return made

    def export(self, name="level.txt"):
        """Exports; returns the timeline."""
        bpy.ops.brume.export_level(filepath=os.path.join(self.folder, name))
        with open(os.path.join(self.folder, os.path.splitext(name)[0] + ".toml"), "rb") as file:
            return tomllib.load(file)

    def names(self):
        """The names in the exported Scene.txt."""
        self.export()
        with open(os.path.join(self.folder, "level.txt"), encoding="utf-8") as file:
            return sorted(line.split("\t")[0] for line in file if not line.startswith("#"))

    def document(self):
        """The JSON of the exported glTF."""
        self.export("level.glb")
        with open(os.path.join(self.folder, "level.glb"), "rb") as file:
            data = file.read()
        return json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])

    def said(self, kind=None):
        """The texts in the sidebar."""
        from brume_blender import messages

        return [message.text for message in messages.last() if kind in (None, message.kind)]

    def assertSaid(self, part, kind=None):
        self.assertTrue(any(part in text for text in self.said(kind)), f"{part!r} not in {self.said(kind)}")

    def error_of(self, operator, **arguments):
        with self.assertRaises(RuntimeError) as caught:
            operator(**arguments)
        return str(caught.exception).strip()

    def stub(self, options="", width=8, height=6):
        """Makes a program the one of the add-on; returns its folder."""
        folder = tempfile.mkdtemp(dir=self.folder)
        path = os.path.join(folder, "brume")
        with open(path, "w", encoding="ascii") as script:
            script.write(_PROGRAM.replace("{options}", options))
        os.chmod(path, 0o700)
        image = bpy.data.images.new("stub", width, height)
        image.filepath_raw, image.file_format = os.path.join(folder, "image.png"), "PNG"
        image.save()
        bpy.data.images.remove(image)
        self.preferences.program = path
        return folder

    def arguments(self, folder):
        with open(os.path.join(folder, "args.json"), encoding="utf-8") as file:
            return json.load(file)

    def option(self, folder, name):
        arguments = self.arguments(folder)
        return arguments[arguments.index(name) + 1]
