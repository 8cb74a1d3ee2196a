"""Simulated grids beside Cycles: smoke and fire of Mantaflow, and one as EmberGen names and scales its grids."""
import json
import shutil
import sys

import images
import numpy

from report import table

BAKED = ("colored", "plain", "fire", "both")
GRIDS = (*BAKED, "kelvin")
FRAME, VOXEL = 36, 1 / 16  # of the bakes
MOST = 0.1  # relative difference of a part's luminance that is allowed
DARK = 0.02  # of the brightest part: what is less is not judged
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])
GROUND = 0.4  # its albedo, as in cycles_grids.py
# The pictures of Brume: name and options.
MODES = (("path tracer", ["--mode", "reference", "--samples", "256", "--matte"]),
         ("real time, 8 bounces", ["--bounces", "8"]),
         ("real time", []))


def bake(comparison):
    """The files GRID.vdb."""
    for kind in BAKED:
        comparison.blender("cycles_bake.py", kind, comparison.folder / f"bake_{kind}")
        shutil.copy(comparison.folder / f"bake_{kind}/data/fluid_data_{FRAME:04d}.vdb",
                    comparison.folder / f"{kind}.vdb")
    sys.path.insert(0, str(comparison.brume.parent / "python"))
    import brume  # noqa: PLC0415
    both = {grid.name: grid for grid in brume.read_grids(comparison.folder / "both.vdb")}
    named = {"density": both["density"].values, "flames": both["flame"].values,
             "temperature": numpy.where(both["temperature"].values > 0, 293 + 500 * both["temperature"].values, 0)}
    sources = {"density": "density", "flames": "flame", "temperature": "temperature"}
    brume.write_grids(comparison.folder / "kelvin.vdb",
                      [brume.Grid(values=values.astype("f4"), name=name, matrix=both[sources[name]].matrix,
                                  low=both[sources[name]].low) for name, values in named.items()])


def render_cycles(comparison, grid):
    options, folder = comparison.options, comparison.folder
    spec = {"grid": grid, "folder": str(folder), "addon": str(folder / "brume.zip"), "brume": str(comparison.brume),
            "size": options.size, "samples": options.samples, "step_rate": options.step_rate, "voxel": VOXEL,
            "colors": grid in ("colored", "both")}
    (folder / f"{grid}.json").write_text(json.dumps(spec))
    comparison.blender("cycles_grids.py", f"{grid}.json")
    return images.radiance(images.read_exr(folder / f"{grid}_cycles.exr")) @ LUMINANCE


def render_brume(comparison, grid, mode, words):
    """Luminance and the transmittance of the medium."""
    picture = f"{grid}_{mode.replace(', ', '_').replace(' ', '_')}.exr"
    timeline = comparison.folder / f"{grid}.toml"
    text = timeline.read_text()
    if "\nbounce" not in text:
        timeline.write_text(text.replace("[sky]\n", f"[sky]\nbounce = {GROUND}\n"))
    comparison.call([comparison.brume, "render", f"{grid}.toml", "-o", picture, "--time", "0", "--quiet",
                     "--background", "in", "--size", "{}x{}".format(*comparison.options.size), *words])
    layers = images.read_exr(comparison.folder / picture)
    return images.radiance(layers) @ LUMINANCE, layers["transmittance.V"]


def parts_of(picture):
    """The means of a grid of 4x3 parts."""
    height, width = picture.shape
    rows, columns = numpy.arange(4) * height // 3, numpy.arange(5) * width // 4
    return numpy.array([[picture[rows[y]:rows[y + 1], columns[x]:columns[x + 1]].mean() for x in range(4)]
                        for y in range(3)])


def compare(comparison):
    """A row per grid and picture: how much brighter Brume is than Cycles in the whole, in the medium, in the brightest
    fifth of the medium, and in the part of 4x3 that differs most."""
    rows = []
    for grid in GRIDS:
        cycles = render_cycles(comparison, grid)
        judged = parts_of(cycles) > DARK * parts_of(cycles).max()
        medium = None
        for mode, words in MODES:
            luminance, transmittance = render_brume(comparison, grid, mode, words)
            if medium is None:
                medium = transmittance < 0.9
                bright = medium & (cycles >= numpy.percentile(cycles[medium], 80))
            apart = parts_of(luminance) / numpy.maximum(parts_of(cycles), 1e-9) - 1
            row = {"grid": grid, "picture": mode, "whole": luminance.mean() / cycles.mean() - 1,
                   "medium": luminance[medium].mean() / cycles[medium].mean() - 1,
                   "bright": luminance[bright].mean() / cycles[bright].mean() - 1,
                   "largest": apart[judged][abs(apart[judged]).argmax()],
                   "off": int((abs(apart[judged]) > MOST).sum()), "parts": int(judged.sum())}
            rows.append({key: float(value) if isinstance(value, numpy.floating) else value
                         for key, value in row.items()})
            comparison.say(", ".join(f"{key} {value:+.3f}" if isinstance(value, float) else str(value)
                                     for key, value in row.items()))
    return rows


def markdown(rows):
    shown = [{**row, **{key: f"{100 * row[key]:+.1f}" for key in ("whole", "medium", "bright", "largest")},
              "off": f"{row['off']} of {row['parts']}"} for row in rows]
    return table(shown, (("grid", "grid"), ("picture", "Brume"), ("whole", "whole picture %"),
                                       ("medium", "medium %"), ("bright", "its brightest fifth %"),
                                       ("largest", "largest part %"), ("off", "parts off by more than 10 %")))
