"""Writes the results of script/bench-peers as Markdown and as a plot."""
import math

COLUMNS = (("renderer", "renderer"), ("cpu", "CPU s"), ("wall", "wall s"), ("gpu_ms", "GPU ms"), ("memory", "peak MB"),
           ("rmse", "RMSE %"), ("mean", "mean difference %"), ("largest", "largest %"), ("ratio", "brightness"))
COLOURS = {"Brume": "#c8641e", "vdb_render": "#3b6fb6", "Cycles": "#4c8c4a"}
WIDE, HIGH, LEFT, TOP = 620, 380, 70, 30


def number(value):
    """Three digits that count; whole numbers from 100 on."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if value == 0:
        return "0"
    return f"{value:.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"


def table(rows, columns):
    lines = ["| " + " | ".join(title for _, title in columns) + " |", "| " + " | ".join("---" for _ in columns) + " |"]
    lines += ["| " + " | ".join(number(row.get(key)) for key, _ in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def markdown(results):
    scene, parts = results["scene"], [f"# {results['title']}\n"]
    parts.append(f"{scene['voxels']} active voxels of {scene['edge']}^3, extinction {scene['extinction']} per voxel, "
                 f"{scene['size'][0]}x{scene['size'][1]}, one sun, single scattering. {results['machine']}.\n")
    on_gpu = any(row.get("gpu_ms") for row in results["renderers"])
    parts.append(table(results["renderers"], [column for column in COLUMNS if on_gpu or column[0] != "gpu_ms"]))
    parts.append("CPU s, wall s and peak MB: the whole process with those it started. Differences are from the "
                 "reference, in percent of its mean over the pixels of the cloud; RMSE over all pixels.\n")
    parts += [f"Skipped: {line}\n" for line in results["skipped"]]
    if results["parts"]:
        parts.append("Where Brume's time goes:\n")
        parts.append(table(results["parts"], (("part", "part"), ("device", "device"), ("cpu", "CPU s"))))
    parts.append("Convergence of the reference (two points are used), as differences from four Gauss points per cell, "
                 "{}x{}:\n".format(*results["convergence"][0]["size"]))
    parts.append(table(results["convergence"], (("reference", "reference"), ("cpu", "CPU s"), ("rmse", "RMSE %"),
                                                ("mean", "mean difference %"))))
    if results["nanovdb"]:
        parts.append("Fog sphere at 1920x1080 on the GPU:\n\n```\n" + "\n".join(results["nanovdb"]) + "\n```\n")
    parts.append("Settings:\n\n" + "\n".join(f"- {row['renderer']}: {row['settings']}"
                                             for row in results["renderers"]) + "\n")
    return "\n".join(parts)


def ticks(low, high):
    """1, 2 and 5 times the powers of ten in a range."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    return [m * 10.0 ** p for p in range(first, last + 1) for m in (1, 2, 5) if low <= m * 10.0 ** p <= high]


class Axis:
    """A logarithmic axis around some values, from pixel `begin` to pixel `end`."""

    def __init__(self, values, begin, end):
        self.low, self.high = min(values) / 1.6, max(values) * 1.6
        self.begin, self.end = begin, end

    def at(self, value):
        return self.begin + (self.end - self.begin) * math.log(value / self.low) / math.log(self.high / self.low)


def plot(rows, title):
    """Image error by CPU seconds, both logarithmic."""
    rows = [row for row in rows if row.get("rmse") and row.get("cpu")]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {LEFT + WIDE + 30} {TOP + HIGH + 60}" '
           'font-family="sans-serif" font-size="14">',
           f'<rect width="{LEFT + WIDE + 30}" height="{TOP + HIGH + 60}" fill="#fafafa"/>',
           f'<text x="{LEFT}" y="{TOP - 10}">{title}</text>',
           f'<rect x="{LEFT}" y="{TOP}" width="{WIDE}" height="{HIGH}" fill="#fff" stroke="#999"/>']
    if rows:
        across = Axis([row["cpu"] for row in rows], LEFT, LEFT + WIDE)
        upwards = Axis([row["rmse"] for row in rows], TOP + HIGH, TOP)
        for value in ticks(across.low, across.high):
            x = across.at(value)
            out.append(f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{TOP + HIGH}" stroke="#eee"/>'
                       f'<text x="{x:.1f}" y="{TOP + HIGH + 18}" text-anchor="middle">{value:g}</text>')
        for value in ticks(upwards.low, upwards.high):
            y = upwards.at(value)
            out.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{LEFT + WIDE}" y2="{y:.1f}" stroke="#eee"/>'
                       f'<text x="{LEFT - 8}" y="{y + 5:.1f}" text-anchor="end">{value:g}</text>')
        for row in rows:
            x, y = across.at(row["cpu"]), upwards.at(row["rmse"])
            colour = next((c for name, c in COLOURS.items() if row["renderer"].startswith(name)), "#555")
            end = x > LEFT + WIDE * 0.6
            out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{colour}"/>'
                       f'<text x="{x + (-9 if end else 9):.1f}" y="{y + 5:.1f}" fill="{colour}" '
                       f'text-anchor="{"end" if end else "start"}">{row["renderer"]}</text>')
    out.append(f'<text x="{LEFT + WIDE / 2}" y="{TOP + HIGH + 44}" text-anchor="middle">CPU seconds</text>')
    out.append(f'<text transform="translate(20 {TOP + HIGH / 2}) rotate(-90)" text-anchor="middle">'
               "RMSE, % of the cloud's mean radiance</text>")
    out.append("</svg>")
    return "\n".join(out) + "\n"
