"""A courtyard behind a wall, with everything that is hard to export: rotated, scaled, mirrored, parented,
sheared, instanced and modified objects, curves and letters, names that clash. Units are Blender's."""

import math
import os
import types

import bmesh
import bpy
from mathutils import Matrix


def material(name, color, roughness=0.8, image=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    node = made.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1)
    node.inputs["Roughness"].default_value = roughness
    if image:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        made.node_tree.links.new(node.inputs["Base Color"], texture.outputs["Color"])
    return made


def brick_image(name, joint, brick, contrast, length):
    """A generated brick image without a file."""
    width, height = 128, 128
    image = bpy.data.images.new(name, width, height)
    pixels = []
    for y in range(height):
        course = y // 16
        for x in range(width):
            along = x + length // 2 * (course % 2)
            shade = 1 + contrast * math.sin(12.9898 * (course + 17 * (along // length % (width // length))))
            color = joint if y % 16 < 2 or along % length < 2 else [value * shade for value in brick]
            pixels += (*color, 1)
    image.pixels = pixels
    return image


def save(image, path, kind):
    """Saves an image to a file."""
    image.filepath_raw, image.file_format = path, kind
    image.save()
    return bpy.data.images.load(path)


def add(name, data, parent=None, collection=None, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler, made.scale = location, rotation, scale
    made.parent = parent
    (collection or bpy.context.scene.collection).objects.link(made)
    return made


def box_mesh(name, low, high, *materials):
    """A box with texture coordinates in scene units."""
    corners = [[(high if i >> axis & 1 else low)[axis] for axis in range(3)] for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    uvs = mesh.uv_layers.new()
    for face in mesh.polygons:
        across = [axis for axis in range(3) if abs(face.normal[axis]) < 0.5]
        for loop in face.loop_indices:
            point = mesh.vertices[mesh.loops[loop].vertex_index].co
            uvs.data[loop].uv = (point[across[0]] / 2, point[across[1]] / 2)
    for entry in materials:
        mesh.materials.append(entry)
    return mesh


def wedge_mesh(name, entry):
    """A ramp: has no mirror symmetry."""
    mesh = bpy.data.meshes.new(name)
    points = [(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0), (0, 0, 1), (0, 0.6, 1)]
    mesh.from_pydata(points, [], [(0, 2, 3, 1), (0, 1, 4), (2, 5, 3), (0, 4, 5, 2), (1, 3, 5, 4)])
    mesh.materials.append(entry)
    return mesh


def ball_mesh(name, entry):
    """A sphere with smooth normals."""
    mesh = bpy.data.meshes.new(name)
    ball = bmesh.new()
    bmesh.ops.create_uvsphere(ball, u_segments=12, v_segments=8, radius=1)
    ball.to_mesh(mesh)
    ball.free()
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.materials.append(entry)
    return mesh


def instancing_nodes(thing):
    """A geometry node group (Blender 3.4) that instances an object on every point, with its own scale."""
    group = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    place, info = group.nodes.new("GeometryNodeInstanceOnPoints"), group.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = thing
    info.inputs["As Instance"].default_value = True
    place.inputs["Scale"].default_value = (0.3, 0.2, 0.25)
    place.inputs["Rotation"].default_value = (0.2, 0.4, 1.0)
    group.links.new(place.inputs["Points"], start.outputs["Geometry"])
    group.links.new(place.inputs["Instance"], info.outputs["Geometry"])
    group.links.new(end.inputs["Geometry"], place.outputs["Instances"])
    return group


def looks(folder):
    """The materials, two with images: one from a file, one generated."""
    wall = brick_image("bricks", (0.5, 0.47, 0.43), (0.46, 0.24, 0.17), 0.22, 32)
    bricks = material("Old bricks", (1, 1, 1), 0.9, wall)
    paving = brick_image("paving", (0.17, 0.16, 0.15), (0.36, 0.34, 0.32), 0.15, 16)
    ground = material("ground", (1, 1, 1), 0.95, save(paving, os.path.join(folder, "paving stones.jpg"), "JPEG"))
    wood = material("Wood / oak", (0.36, 0.2, 0.09), 0.6)
    metal = material("metal", (0.45, 0.47, 0.5), 0.35)
    leaf = material("leaf", (0.08, 0.22, 0.05), 0.9)
    paint = material("paint", (0.65, 0.12, 0.06), 0.5)
    return types.SimpleNamespace(bricks=bricks, ground=ground, wood=wood, metal=metal, leaf=leaf, paint=paint)


def add_walls(look):
    add("Ground", box_mesh("ground", (-6.13, -4.07, -0.21), (6.11, 5.09, 0), look.ground))
    # Names that collide on some file systems.
    add("Wall", box_mesh("left", (-6.13, 2, 0), (-0.61, 2.33, 4.17), look.bricks))
    add("wall", box_mesh("right", (0.61, 2, 0), (6.11, 2.33, 4.17), look.bricks))
    add("Wall.lintel", box_mesh("lintel", (-0.61, 2, 2.23), (0.61, 2.33, 4.17), look.bricks))

    # A door: its handle is parented to it and has another material.
    door = add("entrance", box_mesh("leaf of the door", (0, -0.04, 0.02), (1.18, 0.04, 2.19), look.wood))
    door.location, door.rotation_euler = (-0.59, 2.16, 0), (0, 0, 0.05)
    door.brume.role = "DOOR"
    handle = box_mesh("handle", (-0.02, -0.11, -0.02), (0.14, -0.04, 0.02), look.metal)
    add("handle", handle, door, location=(1, 0, 1.05))


def add_blocks(look, crate):
    """Objects rotated about all axes and scaled non-uniformly; mirrored; mirrored by a rotated parent."""
    add("Crate", crate, location=(2.6, -0.4, 0.43), rotation=(0, 0, 0.4), scale=(0.85, 0.85, 0.85))
    add("Crate.001", crate, location=(2.75, -0.35, 1.16), rotation=(0, 0, -0.3), scale=(0.6, 0.6, 0.6))
    add("Crate tipped", crate, location=(3.55, -1.13, 0.55), rotation=(0.5, 0.3, 1.1), scale=(0.9, 0.6, 0.7))
    ramp = wedge_mesh("ramp", look.metal)
    add("Ramp", ramp, location=(-3.7, -1.2, 0.01), rotation=(0, 0, 0.3), scale=(0.5, 1.3, 0.5))
    mirrored = add("Ramp mirrored", ramp, location=(-3.7, -1.2, 0.01), rotation=(0, 0, 0.3), scale=(-0.5, 1.3, 0.5))
    mirrored.brume.role = "GLASS"
    turned = add("turned", None, location=(4.63, 1.02, 0.3), rotation=(0.2, 0.1, 0.7), scale=(1.2, -0.5, 0.8))
    inner = add("inner", None, turned, rotation=(0.3, 0.6, 0.2))
    add("Ramp sheared", ramp, inner, location=(-0.4, 0.2, 0), rotation=(0.1, 0.4, 0.9), scale=(0.7, 0.6, 1))
    add("Ball sheared", ball_mesh("ball", look.metal), inner, location=(0.9, 1.2, 0.3), scale=(0.5, 0.3, 0.4))
    turned = add("Ramp upside down", ramp, location=(-0.83, 1.99, 2.73), rotation=(math.pi, 0, 0))
    turned.scale, turned.brume.role = (0.82, 0.7, 0.2), "WALL"


def add_shapes(look):
    """Modifiers, a curve, a text object."""
    step = box_mesh("step", (-0.61, -0.3, -0.02), (0.61, 0, 0.17), look.ground)
    steps = add("Steps", step, location=(0.003, 1.98, 0), scale=(1, 1, 0.9))
    repeat = steps.modifiers.new("array", "ARRAY")
    repeat.count, repeat.use_relative_offset, repeat.use_constant_offset = 3, False, True
    repeat.constant_offset_displace = (0, -0.27, -0.05)
    pipe = bpy.data.curves.new("pipe", "CURVE")
    pipe.dimensions, pipe.bevel_depth, pipe.bevel_resolution, pipe.resolution_u = "3D", 0.06, 1, 3
    spline = pipe.splines.new("BEZIER")
    spline.bezier_points.add(2)
    for point, place in zip(spline.bezier_points, ((-4.5, 1.85, 0.05), (-4.4, 1.8, 2.6), (-2.2, 1.85, 2.9))):
        point.co, point.handle_left_type, point.handle_right_type = place, "AUTO", "AUTO"
    pipe.materials.append(look.metal)
    add("Pipe", pipe).brume.role = "GRILLE"
    sign = bpy.data.curves.new("sign", "FONT")
    sign.body, sign.size, sign.extrude, sign.resolution_u = "BRUME", 0.7, 0.05, 2
    sign.materials.append(look.paint)
    add("Sign", sign, location=(1.13, 1.94, 2.62), rotation=(math.pi / 2, 0, 0))


def add_bushes(look):
    """A collection of bushes, instanced twice: rotated, and mirrored. Smoke passes through them."""
    bushes = bpy.data.collections.new("bushes")
    bush = bpy.data.meshes.new("bush")
    blades = 14
    points, faces = [(0, 0, 0.9)], []
    for i in range(blades):
        angle = 2 * math.pi * i / blades
        reach = 0.45 + 0.12 * math.sin(3 * i)
        points.append((reach * math.cos(angle), reach * math.sin(angle), 0.25 + 0.2 * (i % 2)))
        faces.append((0, 1 + i, 1 + (i + 1) % blades))
    bush.from_pydata(points, [], faces)
    bush.materials.append(look.leaf)
    made = add("Bush", bush, collection=bushes, location=(0.4, 0, 0))
    made.brume.role = "PASSABLE"
    add("Pot", box_mesh("pot", (-0.2, -0.2, 0), (0.2, 0.2, 0.3), look.paint), collection=bushes, location=(0.4, 0, 0))
    for name, location, turn, scale in (
        ("bushes left", (-1.93, 1.34, 0.01), 0.8, (1, 1, 1)),
        ("bushes right", (2.31, 1.41, 0.01), 2.0, (-1.2, 1.2, 1.1)),
    ):
        instance = add(name, None, location=location, rotation=(0, 0, turn), scale=scale)
        instance.instance_type, instance.instance_collection = "COLLECTION", bushes


def add_instances(look):
    """Instances on the vertices of a mesh, which replace the instanced child; and by geometry nodes."""
    rail = bpy.data.meshes.new("rail")
    rail.from_pydata([(-5.6, -2.2, 0), (-5.6, -1.4, 0), (-5.5, -0.6, 0)], [(0, 1), (1, 2)], [])
    posts = add("Rail", rail)
    posts.instance_type, posts.show_instancer_for_render = "VERTS", False
    add("Bollard", ball_mesh("bollard", look.metal), posts, scale=(0.15, 0.15, 0.5))
    stone = add("Stone", ball_mesh("stone", look.ground), location=(0, 0, -9), scale=(1, 0.7, 0.5))
    stone.hide_render = True
    ground_points = bpy.data.meshes.new("points")
    ground_points.from_pydata([(4.2, -2.2, 0.05), (4.9, -1.9, 0.07), (4.6, -2.7, 0.1)], [], [])
    add("Stones", ground_points).modifiers.new("scatter", "NODES").node_group = instancing_nodes(stone)


def add_names(look):
    """Names that are invalid in some file systems or in Scene.txt."""
    for number, name in enumerate(("Käfig (grün)", "con", "\u6728\u7bb1", "# one", "LIGHT_SOURCE")):
        size = 0.2 + 0.01 * number
        add(name, box_mesh(name, (0, 0, 0), (size, size, size), look.wood), location=(5.2, 1.6 - 0.3 * number, 0.01))


def add_exceptions(look, crate):
    """One mesh in two materials, the second by its object; and objects that must not be exported."""
    post = box_mesh("post", (-0.1, -0.1, 0), (0.1, 0.1, 1.1), look.metal, look.metal)
    post.polygons[1].material_index = 1
    cap = add("Post", post, location=(-2.33, -2.11, 0.01))
    cap.material_slots[1].link, cap.material_slots[1].material = "OBJECT", look.paint
    add("measure", crate, location=(0, 0, 15)).brume.role = "LEFT_OUT"
    add("not rendered", crate, location=(0, 0, 16)).hide_render = True
    hidden = add("hidden", crate, location=(0, 0, 17))
    hidden.hide_viewport = hidden.hide_render = True


def build_courtyard(folder):
    look = looks(folder)
    crate = box_mesh("crate", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), look.wood)
    add_walls(look)
    add_blocks(look, crate)
    add_shapes(look)
    add_bushes(look)
    add_instances(look)
    add_names(look)
    add_exceptions(look, crate)


def build_lights():
    scene = bpy.context.scene

    def light(name, kind, energy, color, location, target=None):
        data = bpy.data.lights.new(name, kind)
        data.energy, data.color = energy, color
        made = add(name, data, location=location)
        if target:
            direction = Matrix.Translation(target).translation - made.location
            made.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
        return data

    light("lantern", "POINT", 300, (1, 0.6, 0.28), (2.3, 0.9, 3.3))
    spot = light("floodlight", "SPOT", 2600, (0.62, 0.78, 1), (-5.6, -1.4, 3.9), (0.2, 0.9, 0.6))
    spot.spot_size, spot.spot_blend = math.radians(40), 0.4
    area = light("window", "AREA", 300, (1, 0.75, 0.45), (0, 3.9, 2.6), (0, 2, 0.5))
    area.size = 1
    light("moon", "SUN", 0.3, (0.55, 0.7, 1), (0, 0, 9), (-2, 3, 0))
    world = bpy.data.worlds.new("night")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.02, 0.03, 0.055, 1)
    scene.world = world


def build_camera():
    """A dolly: the camera rides on an empty that moves."""
    scene = bpy.context.scene
    dolly = add("dolly", None, location=(-0.6, -6.4, 1.85), rotation=(0, 0, -0.06))
    dolly.keyframe_insert("location", frame=1)
    dolly.location = (0.5, -5.6, 1.7)
    dolly.keyframe_insert("location", frame=97)
    data = bpy.data.cameras.new("camera")
    data.lens = 24
    scene.camera = add("camera", data, dolly, rotation=(math.radians(88), 0, 0))


def star_image():
    """A white five-pointed star."""
    size = 64
    image = bpy.data.images.new("star", size, size)
    pixels = []
    for i in range(size * size):
        x, y = 2 * (i % size) / size - 1, 2 * (i // size) / size - 1
        turn = math.atan2(x, y) * 5
        pixels += [1.0 if math.hypot(x, y) < 0.62 + 0.36 * math.cos(turn) else 0.0] * 3 + [1.0]
    image.pixels = pixels
    return image


def build_events(folder):
    """A grenade before the door, a word, a star and a shot through its smoke, a blast, the door that opens."""

    def event(name, kind, time, location, rotation=(0, 0, 0)):
        made = add(name, None, location=location, rotation=rotation)
        made.brume_event.type, made.brume_event.time = kind, time
        return made.brume_event

    grenade = event("Grenade at the steps", "SMOKE", 0.25, (0.2, 0.7, 0.2))
    grenade.thrown_from = bpy.data.objects["camera"]
    word = event("word", "WORD", 3.1, (0.33, -5.5, 1.7))
    word.text, word.size, word.stay = "HI", 0.7, 2.0
    word.aim = event("aim", "NONE", 0, (-0.3, 0.6, 1.15)).id_data
    shot = event("shot", "SHOT", 3.2, (2.5, -3.5, 1.2), (math.radians(90), 0, math.radians(200)))
    shot.shape, shot.roll, shot.radius, shot.stay = "BOX", math.radians(45), 0.3, 1.5
    star = event("star", "SHOT", 3.2, (0.33, -5.5, 1.7))
    star.shape, star.radius, star.stay = "MASK", 0.4, 1.5
    star.aim = event("star's aim", "NONE", 0, (1.0, 0.6, 1.2)).id_data
    star.mask = os.path.join(folder, "a star.png")
    save(star_image(), star.mask, "PNG")
    event("blast", "BLAST", 3.75, (-4.7, 0.6, 0.8)).blast_radius = 1.5
    opens = event("door opens", "DOOR", 1.5, (0, 2, 2.5))
    opens.door = bpy.data.objects["entrance"]


def build_all(folder):
    """The courtyard with its lights, camera and events, at a busy frame. Files are written to `folder`."""
    build_courtyard(folder)
    build_lights()
    build_camera()
    build_events(folder)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 96
    scene.brume.sky, scene.brume.smoke_voxels = "WORLD", 1500
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 1920, 1080, 50
    scene.brume.march = "half"
    scene.frame_set(86)
