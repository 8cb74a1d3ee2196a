"""Run by Blender: blender -b --factory-startup -P make_level.py -- ADDON.zip BRUME FOLDER

Installs the add-on, makes a level, exports it, renders and voxelizes it, and writes what Blender itself says of it
(expected.json: triangles in Blender's axes and units) for blender_test.cpp to compare.
"""

import json
import os
import sys

import bmesh
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import level_parts  # noqa: E402


# Characters that TOML must escape or write as UTF-8.
LETTERS = 'a "b" \\ é \U0001f32b'


def install(addon):
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.preferences.addon_enable(module="brume_blender")


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    bpy.context.scene.render.fps = 24


def corners_of(mesh, world, mirrored):
    """Triangles as Blender shows them, counter-clockwise from outside: position, normal, texture coordinate."""
    mesh.calc_normals_split()
    mesh.calc_loop_triangles()
    uvs = mesh.uv_layers.active
    normal_matrix = world.to_3x3().inverted().transposed()
    for triangle in mesh.loop_triangles:
        corners = []
        for loop in triangle.loops:
            point = world @ mesh.vertices[mesh.loops[loop].vertex_index].co
            normal = (normal_matrix @ mesh.loops[loop].normal).normalized()
            uv = tuple(uvs.data[loop].uv) if uvs else None
            corners.append({"point": tuple(point), "normal": tuple(normal), "uv": uv})
        yield corners[::-1] if mirrored else corners


def expected_triangles():
    """The triangles of everything that renders and is exported, with the names of Blender's objects."""
    from brume_blender.properties import BRUME_ROLES  # Installed by now.

    found = []
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for instance in depsgraph.object_instances:
        source = instance.object.original
        if instance.object.type != "MESH" or source.brume.role == "LEFT_OUT":
            continue
        if not instance.is_instance:
            # An object that is instanced on vertices is not rendered at its own position.
            if source.hide_render or source.name in ("Rail", "Bollard"):
                continue
        world = instance.matrix_world.copy()
        role = BRUME_ROLES.get(source.brume.role, "wall")
        for corners in corners_of(instance.object.data, world, world.determinant() < 0):
            found.append({"object": source.name, "role": role, "corners": corners})
    return found


def write_json(path, value):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(value, file)


def export_both(folder, name):
    for kind, extension in (("TXT", ".txt"), ("GLTF", ".glb")):
        path = os.path.join(folder, name, kind.lower(), "level" + extension)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        bpy.ops.brume.export_level(filepath=path, format=kind)


def left_behind():
    """Counts the data blocks that the export must not change."""
    kinds = ("scenes", "objects", "meshes", "lights", "cameras")
    return sorted(block.name for kind in kinds for block in getattr(bpy.data, kind))


def make_courtyard(folder):
    empty_scene()
    scene = bpy.context.scene
    level_parts.build_all(folder)
    camera = scene.camera
    scene.frame_set(49)
    triangles = expected_triangles()
    frame = camera.data.view_frame(scene=scene)
    view = [tuple(camera.matrix_world @ corner) for corner in frame]
    before = left_behind()
    export_both(folder, "courtyard")
    facts = {"triangles": triangles, "metres": 1.0, "frame_49": {"eye": tuple(camera.matrix_world.translation)}}
    facts["frame_49"]["corners"] = view
    facts["left_behind"] = [name for name in left_behind() if name not in before]
    facts["frame_after"] = scene.frame_current
    write_json(os.path.join(folder, "courtyard", "expected.json"), facts)
    # The same with units of 0.25 m.
    scene.unit_settings.scale_length = 0.25
    export_both(folder, "small")
    write_json(os.path.join(folder, "small", "expected.json"), {"triangles": triangles, "metres": 0.25})
    scene.unit_settings.scale_length = 1.0


def empty_with(kind, number, setting):
    """An event whose numbers are all at their minimum, maximum or default."""
    made = level_parts.add(f"{kind} {number}", None, location=(number, 0, 0))
    event = made.brume_event
    event.type = kind
    if setting != "usual":
        set_all(event, setting)
        event.time = 0 if setting == "least" else 3600
    return event


def set_all(group, setting):
    """Sets all numbers that are stored, not computed from others, to the limits of their properties."""
    for name, field in group.bl_rna.properties.items():
        computed = name.startswith("shown_") or name in {"frame", "time", "smoke_radius"}
        if field.type in {"FLOAT", "INT"} and not computed:
            setattr(group, name, field.hard_min if setting == "least" else field.hard_max)


def make_ranges(folder):
    """Timelines whose numbers are all at the minimum, default or maximum of their properties."""
    from brume_blender.kinds import KINDS

    for setting in ("least", "usual", "most"):
        empty_scene()
        level_parts.add("floor", level_parts.box_mesh("floor", (-1, -1, -1), (1, 1, 0)))
        for number, kind in enumerate(KINDS):
            if kind != "DOOR":  # It has no numbers, and needs an object.
                empty_with(kind, number, setting).text = LETTERS
        if setting != "usual":
            set_all(bpy.context.scene.brume, setting)
        bpy.ops.brume.export_level(filepath=os.path.join(folder, setting + ".glb"), format="GLTF")


def make_odd(folder):
    """Unusual contents: meshes in edit mode, flat, empty, with many materials; negative lights."""
    empty_scene()
    cube = level_parts.add("cube", level_parts.box_mesh("cube", (-1, -1, -1), (1, 1, 1)))
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(cube.data)
    edited.verts.ensure_lookup_table()
    edited.verts[7].co = (5, 5, 5)
    bmesh.update_edit_mesh(cube.data)
    export_both(folder, "edited")
    write_json(os.path.join(folder, "edited", "facts.json"), {"mode": bpy.context.mode})
    bpy.ops.object.mode_set(mode="OBJECT")

    image = bpy.data.images.new("gone", 4, 4)
    image.source, image.filepath = "FILE", os.path.join(folder, "no such picture.png")
    cube.data.materials.append(level_parts.material("pictureless", (1, 1, 1), 0.5, image))
    cube.data.materials.append(None)
    cube.data.polygons[0].material_index = 1
    level_parts.add("flat", cube.data, location=(0, 0, -3), scale=(2, 2, 0))
    level_parts.add("a point", cube.data, scale=(0, 0, 0))
    edge = bpy.data.meshes.new("edge")
    edge.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    level_parts.add("an edge", edge)
    level_parts.add("Outdoor stone", level_parts.box_mesh("stone", (4, 0, 0), (4.2, 0.2, 0.2)))
    level_parts.add("Grenade", level_parts.box_mesh("can", (0, 0, 0), (0.1, 0.1, 0.2)), location=(3, 0, 0))
    two = bpy.data.objects["Grenade"].data
    for name in ("olive", "rust"):
        two.materials.append(level_parts.material(name, (0.2, 0.2, 0.1)))
    two.polygons[0].material_index = 1
    light = bpy.data.lights.new("dark", "POINT")
    light.energy = -5
    level_parts.add("dark", light)
    camera = bpy.data.cameras.new("flat view")
    camera.type = "ORTHO"
    bpy.context.scene.camera = level_parts.add("flat view", camera)
    export_both(folder, "odd")


def render_and_voxelize(folder, brume):
    scene = bpy.context.scene
    bpy.context.preferences.addons["brume_blender"].preferences.program = brume
    scene.frame_set(86)
    bpy.ops.brume.render()
    image = bpy.data.images["Brume Render"]
    with open(os.path.join(folder, "render.png"), "wb") as file:
        file.write(image.packed_file.data)
    scene.brume.voxel = 0.2
    bpy.ops.brume.voxels()
    voxels = bpy.data.objects["Brume voxels"]
    facts = {
        "solid": voxels["solid"],
        "points": [tuple(voxels.matrix_world @ vertex.co) for vertex in voxels.data.vertices],
        "outward": sum(
            face.area * face.center.dot(face.normal) for face in voxels.data.polygons
        ),  # Three times the enclosed volume.
        "role": voxels.brume.role,
    }
    write_json(os.path.join(folder, "voxels.json"), facts)


def says(operator, **arguments):
    """Returns the error message of a failing operator."""
    try:
        operator(**arguments)
    except RuntimeError as error:
        return str(error).strip()
    return ""


def make_failures(folder):
    preferences = bpy.context.preferences.addons["brume_blender"].preferences
    lines = {}
    preferences.program = os.path.join(folder, "no brume here")
    lines["no program"] = says(bpy.ops.brume.render)
    preferences.program = "/bin/false"
    lines["program fails"] = says(bpy.ops.brume.render)
    with open(os.path.join(folder, "scene.obj"), "w", encoding="ascii") as file:
        file.write("v 0 0 0\nvn 0 0 1\n")
    lines["no voxels"] = says(bpy.ops.brume.import_voxels, filepath=os.path.join(folder, "scene.obj"))
    target = os.path.join(folder, "missing", "\0", "level.glb") if os.name == "nt" else "/dev/null/level.glb"
    lines["no folder"] = says(bpy.ops.brume.export_level, filepath=target)
    empty_scene()
    lines["empty scene"] = says(bpy.ops.brume.export_level, filepath=os.path.join(folder, "empty.glb"))
    write_json(os.path.join(folder, "failures.json"), lines)


def make_box(folder):
    """One box of 2.0 x 1.5 x 1.0, turned by a quarter: its voxels can be counted by hand."""
    empty_scene()
    mesh = level_parts.box_mesh("box", (0, 0, 0), (2, 1.5, 1))
    level_parts.add("box", mesh, location=(0.1, 0.1, 0.1), rotation=(0, 0, 1.5707963267948966))
    export_both(folder, "box")


def main():
    addon, brume, folder = sys.argv[sys.argv.index("--") + 1 :]
    install(addon)
    make_courtyard(folder)
    render_and_voxelize(folder, brume)
    make_failures(folder)
    make_box(folder)
    make_ranges(folder)
    make_odd(folder)


main()
