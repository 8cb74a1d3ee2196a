"""Opens a volume file in Blender and writes what Blender found as JSON.

blender -b -P volume.py -- VOLUME.vdb RESULT.json
"""
import json
import sys

import bpy

volume, result = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.object.volume_import(filepath=volume, align="WORLD", location=(0, 0, 0))
opened = bpy.context.object
grids = opened.data.grids
grids.load()
with open(result, "w", encoding="utf-8") as file:
    json.dump({
        "loaded": grids.is_loaded,
        "error": grids.error_message,
        "grids": [{
            "name": grid.name,
            "type": grid.data_type,
            "matrix": [list(row) for row in grid.matrix_object],
        } for grid in grids],
        "corners": [list(corner) for corner in opened.bound_box],
    }, file)
