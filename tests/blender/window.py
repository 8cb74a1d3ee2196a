"""Run by Blender in a window: blender --factory-startup -P window.py -- ADDON.zip BRUME FOLDER

Draws the panels, renders while Blender goes on, shows the picture, bakes from the file browser, stops a render and a
film by Esc. Leaves window.json and window.png.
"""

import json
import os
import subprocess
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import level_parts  # noqa: E402

IMAGE = "Brume Render"
# [s]: only ends tests that hang.
HANG = 600

bpy.context.preferences.view.show_splash = False


def until(holds):
    """Waits until `holds()`."""
    deadline = time.monotonic() + HANG
    while not holds() and time.monotonic() < deadline:
        yield 0.05


DRAWS = []


def drawn():
    """Waits until the first window has been drawn twice: what the first time changes shows in the second one."""
    for _ in range(2):
        before = len(DRAWS)
        for area in bpy.context.window_manager.windows[0].screen.areas:
            area.tag_redraw()
        yield from until(lambda begin=before: len(DRAWS) > begin)


def areas(kind):
    return [area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == kind]


def region(area, kind="WINDOW"):
    return next(region for region in area.regions if region.type == kind)


def inside(area):
    window = bpy.context.window_manager.windows[0]
    return bpy.context.temp_override(window=window, area=area, region=region(area))


def lay_out():
    """The 3D view beside an Image Editor."""
    view = areas("VIEW_3D")[0]
    with inside(view):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    view, other = sorted(areas("VIEW_3D"), key=lambda area: area.x)
    other.type = "IMAGE_EDITOR"
    space = view.spaces.active
    space.show_region_ui, space.shading.color_type = True, "TEXTURE"
    space.overlay.show_relationship_lines = False
    space.region_3d.view_perspective = "CAMERA"
    return view, other


def invoke_render():
    with inside(areas("VIEW_3D")[0]):
        return sorted(bpy.ops.brume.render("INVOKE_DEFAULT"))


def show(thing):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing


def point_at(x, y):
    """Moves the mouse; the origin is the lower left corner of the window, for X the upper left one."""
    height = bpy.context.window_manager.windows[0].height
    subprocess.run(["xdotool", "mousemove", str(x), str(height - 1 - y)], check=True)


def choose_tab(view):
    """Clicks where the fourth tab of the sidebar is, at Blender's own size: behind Item, Tool and View."""
    sidebar = region(view, "UI")
    yield from until(lambda: sidebar.width > 10)
    point_at(sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - 164)
    yield 0.5
    subprocess.run(["xdotool", "click", "1"], check=True)
    yield 0.5


def says(part):
    """The text in the sidebar that contains a part, or ""."""
    from brume_blender import messages

    return next((message.text for message in messages.last() if part in message.text), "")


def press_escape(view):
    point_at(view.x + 50, view.y + 50)
    subprocess.run(["xdotool", "key", "Escape"], check=True)


def noting_its_process(mark, commands):
    """Commands of a program that first writes its process number."""
    return f"echo $$ > '{mark}.new'; mv '{mark}.new' '{mark}'; {commands}"


def has_ended(mark):
    """Whether a program that noted its process has ended, and its operator has noticed that."""
    with open(mark, encoding="ascii") as file:
        return not os.path.exists(f"/proc/{int(file.read())}")


def write_program(folder, name, commands):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="ascii") as script:
        script.write(f'#!/bin/sh\ncase "$*" in *--help*) exit;; esac\n{commands}\n')
    os.chmod(path, 0o700)
    return path


def set_up(addon, folder):
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.preferences.addon_enable(module="brume_blender")
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    level_parts.build_all(folder)
    bpy.context.scene.render.resolution_percentage = 35


def draw_panels(view):
    show(bpy.data.objects["star"])  # Without a selection there is no tab Item.
    yield 1.0
    yield from choose_tab(view)
    for name in ("entrance", "bushes left", "word", "blast", "door opens", "Grenade at the steps", "word"):
        show(bpy.data.objects[name])
        yield from drawn()


def let_after_ticks(mark, image, facts, key):
    """Lets a program go on that waits for the file `mark` after ten timers; counts those until an image is there."""
    ticks, deadline = 0, time.monotonic() + HANG
    while image not in bpy.data.images and time.monotonic() < deadline:
        ticks += 1
        if ticks == 10:
            with open(mark, "w", encoding="ascii"):
                pass
        yield 0.05
    facts[key] = ticks


def render(preferences, brume, folder, editor, facts):
    """A render that starts only after Blender's timers have run in the meantime."""
    mark = os.path.join(folder, "ticked")
    commands = f"while [ ! -e '{mark}' ]; do sleep 0.1; done; exec '{brume}' \"$@\""
    preferences.program = write_program(folder, "waiting", commands)
    facts["started"] = invoke_render()
    yield from let_after_ticks(mark, IMAGE, facts, "ticks")
    yield from until(lambda: editor.spaces.active.image)
    facts["shown"] = editor.spaces.active.image.name


def bake(preferences, brume, folder, view, editor, facts):
    """A bake that the file browser starts, and that waits for Blender's timers; its image is shown."""
    mark, name = os.path.join(folder, "bake_ticked"), "Ramp_slices.png"
    commands = f"while [ ! -e '{mark}' ]; do sleep 0.1; done; exec '{brume}' \"$@\""
    preferences.program = write_program(folder, "waiting_bake", commands)
    show(bpy.data.objects["Ramp"])
    with inside(view):
        bpy.ops.brume.bake_slices("INVOKE_DEFAULT", filepath=os.path.join(folder, "any.png"), tile=(8, 8), tiles=4)

    def browsers():
        windows = bpy.context.window_manager.windows
        found = [(window, area) for window in windows for area in window.screen.areas if area.type == "FILE_BROWSER"]
        return [pair for pair in found if pair[1].spaces.active.params]

    yield from until(browsers)
    yield from drawn()
    window, area = browsers()[0]
    facts["proposed"] = area.spaces.active.params.filename
    with bpy.context.temp_override(window=window, area=area, region=region(area)):
        bpy.ops.file.execute()
    yield from let_after_ticks(mark, name, facts, "bake_ticks")
    yield from until(lambda: editor.spaces.active.image.name == name)
    facts["baked"] = editor.spaces.active.image.name


def take_picture(view, editor, path):
    yield from drawn()
    with inside(editor):
        bpy.ops.image.view_all(fit_view=True)
    with inside(view):
        bpy.ops.view3d.view_center_camera()
    yield from drawn()
    with inside(view):
        bpy.ops.screen.screenshot(filepath=path)


def render_without_editor(preferences, folder, editor, facts):
    """The image opens a window of its own; uses a program that ends quickly."""
    with open(os.path.join(folder, "first.png"), "wb") as file:
        file.write(bpy.data.images[IMAGE].packed_file.data)
    preferences.program = write_program(folder, "quick", f"cp '{folder}/first.png' render.png")
    editor.type = "CONSOLE"
    invoke_render()
    windows = bpy.context.window_manager.windows

    def shown_in_new():
        areas_of_new = windows[-1].screen.areas if len(windows) == 2 else []
        return [area.spaces.active.image.name for area in areas_of_new
                if area.type == "IMAGE_EDITOR" and area.spaces.active.image]

    yield from until(shown_in_new)
    facts["own_window"] = shown_in_new()
    facts["images"] = [block.name for block in bpy.data.images if block.name.startswith("Brume")]
    with bpy.context.temp_override(window=windows[-1]):
        bpy.ops.wm.window_close()
    yield from until(lambda: len(windows) == 1)
    # Where the preferences place renders in the window, none opens.
    bpy.context.preferences.view.render_display_type = "AREA"
    invoke_render()
    yield from until(lambda: areas("IMAGE_EDITOR"))
    facts["windows_of_area"] = len(windows)
    areas("IMAGE_EDITOR")[0].type = "PROPERTIES"


def compare_gizmos(view, folder, facts):
    """The 3D view with the sizes and paths of events, and without."""
    pictures = []
    for shown in (True, False):
        bpy.context.scene.brume.gizmos = shown
        path = os.path.join(folder, f"gizmos_{shown}.png")
        yield from drawn()
        with inside(view):
            bpy.ops.screen.screenshot_area(filepath=path)
        image = bpy.data.images.load(path)
        pictures.append(image.pixels[:])
        bpy.data.images.remove(image)
    bpy.context.scene.brume.gizmos = True
    # Red of RGBA. Smoothing of edges differs a little from picture to picture.
    facts["gizmo_pixels"] = sum(abs(a - b) > 0.1 for a, b in zip(pictures[0][::4], pictures[1][::4]))


def stop_by_escape(preferences, folder, view, facts):
    """A program that never ends, and ignores SIGTERM."""
    mark = os.path.join(folder, "pid")
    commands = "trap '' TERM; exec sleep infinity"
    preferences.program = write_program(folder, "endless", noting_its_process(mark, commands))
    invoke_render()
    yield from until(lambda: os.path.exists(mark))
    press_escape(view)
    yield from until(lambda: has_ended(mark))
    facts["ended"] = has_ended(mark)
    yield from until(lambda: says("stopped"))
    facts["stopped"] = says("stopped")


def stop_film(preferences, folder, view, facts):
    """A program that writes one image of a film and never ends: the image remains after Esc."""
    preferences.program = write_program(
        folder, "slow", f"cp '{folder}/first.png' image_000000.png; exec sleep infinity"
    )
    first = os.path.join(folder, "film", "0001.png")
    bpy.context.scene.render.filepath = os.path.join(folder, "film", "####")
    with inside(view):
        bpy.ops.brume.film("INVOKE_DEFAULT")
    yield from until(lambda: os.path.exists(first))
    press_escape(view)
    yield from until(lambda: says("stopped"))
    facts["film_stopped"] = says("stopped")


def walk_in(preferences, brume, folder, facts):
    """The viewer beside Blender's window, with the events of the scene; closes by itself in the test."""
    picture, mark = os.path.join(folder, "view.png"), os.path.join(folder, "viewer_pid")
    options = f"--exit-after 1.5 --screenshot '{picture}' --size 320x180 --bare"
    preferences.program = write_program(
        folder, "viewer", noting_its_process(mark, f"exec '{brume}' \"$@\" {options}")
    )
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.brume.view("INVOKE_DEFAULT", play=True)
    yield from until(lambda: os.path.exists(picture))
    # What follows has the last word.
    yield from until(lambda: has_ended(mark))
    facts["viewed"] = os.path.exists(picture)


def steps(addon, brume, folder):
    """Simulates user input; yields the time to wait [s]."""
    set_up(addon, folder)
    view, editor = lay_out()
    bpy.types.SpaceView3D.draw_handler_add(lambda: DRAWS.append(0), (), "WINDOW", "POST_PIXEL")
    preferences = bpy.context.preferences.addons["brume_blender"].preferences
    facts = {}
    yield from draw_panels(view)
    yield from render(preferences, brume, folder, editor, facts)
    yield from take_picture(view, editor, os.path.join(folder, "window.png"))
    yield from bake(preferences, brume, folder, view, editor, facts)
    yield from render_without_editor(preferences, folder, editor, facts)
    yield from compare_gizmos(view, folder, facts)
    yield from stop_by_escape(preferences, folder, view, facts)
    yield from stop_film(preferences, folder, view, facts)
    yield from walk_in(preferences, brume, folder, facts)
    # A failing program keeps the previous image.
    preferences.program = "/bin/false"
    invoke_render()
    yield from until(lambda: says("ended with code 1"))
    facts["image_after"] = IMAGE in bpy.data.images
    with open(os.path.join(folder, "window.json"), "w", encoding="utf-8") as file:
        json.dump(facts, file)


RUN = steps(*sys.argv[sys.argv.index("--") + 1 :])


def step():
    try:
        return next(RUN)
    except StopIteration:
        bpy.ops.wm.quit_blender()
    except BaseException:
        traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(1)
    return None


bpy.app.timers.register(step, first_interval=1.0)
