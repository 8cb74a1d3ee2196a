"""Run by Blender: blender -b --factory-startup -P addon_test.py -- ADDON.zip BRUME FOLDER

Tests of the add-on that compare with Blender itself or with files it writes. Leaves addon.json: name of each test, and
its failure or "".
"""

import json
import os
import sys
import unittest

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
MODULES = (
    "addon_export_test",
    "addon_look_test",
    "addon_world_test",
    "addon_composite_test",
    "addon_events_test",
    "addon_program_test",
    "addon_bake_test",
    "addon_volume_test",
    "addon_volume_look_test",
    "addon_volume_picture_test",
)


class Results(unittest.TextTestResult):
    """Collects failures by test."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.by_name = {}

    def startTest(self, test):
        super().startTest(test)
        self.by_name[test.id()] = ""

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.by_name[test.id()] = self._exc_info_to_string(err, test)

    def addError(self, test, err):
        super().addError(test, err)
        self.by_name[test.id()] = self._exc_info_to_string(err, test)


def main():
    addon, brume, folder = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    import addon_case

    addon_case.BRUME, addon_case.FOLDER = brume, folder
    suite = unittest.defaultTestLoader.loadTestsFromNames(MODULES)
    results = unittest.TextTestRunner(sys.stdout, resultclass=Results, verbosity=2).run(suite)
    with open(os.path.join(folder, "addon.json"), "w", encoding="utf-8") as file:
        json.dump(results.by_name, file)


main()
