"""Writes the results of script/compare-cycles as Markdown."""
import grids
from report import table


def _percent(value, signed=True):
    return f"{100 * value:+.2f}" if signed else f"{100 * value:.2f}"


def _scenes(results):
    rows = [{**row, "whole": _percent(row["whole"]), "whole_error": _percent(row["whole_error"], False),
             "largest": _percent(row["largest"]), "largest_error": _percent(row["largest_error"], False),
             "off": f"{row['off']} of {row['parts']}"} for row in results["scenes"]]
    columns = (("scene", "scene"), ("surfaces", "surfaces"), ("whole", "whole picture %"),
               ("whole_error", "its standard error %"), ("largest", "largest part %"),
               ("largest_error", "its standard error %"), ("off", "parts off"), ("brume_cpu", "Brume CPU s"),
               ("cycles_cpu", "Cycles CPU s"))
    return table(rows, columns)


def _parts(row):
    lines = [f"### {row['scene']}, {row['surfaces']}\n"]
    shown = [{"part": f"{part['column']}, {part['row']}", "brume": part["brume"], "cycles": part["cycles"],
              "difference": _percent(part["difference"]) if "difference" in part else "",
              "error": _percent(part["error"], False) if "error" in part else "",
              "remark": "" if part.get("agrees") else "off" if part["judged"] else "dark"} for part in row["regions"]]
    lines.append(table(shown, (("part", "column, row"), ("brume", "Brume"), ("cycles", "Cycles"),
                               ("difference", "difference %"), ("error", "standard error %"), ("remark", "remark"))))
    return "\n".join(lines)


def markdown(results):
    size = "{}x{}".format(*results["size"])
    parts = [f"# Brume's reference and Cycles {results['cycles']}\n", f"{results['machine']}.\n"]
    if results["scenes"]:
        parts.append(f"{size}, Brume {results['brume_samples']} samples, Cycles {results['seeds']} pictures of "
                     f"{results['samples']} samples, with volumes a quarter of that in steps of "
                     f"{results['step_rate']:g} voxels. Mean radiance of the parts of a grid of 4x3; differences of "
                     "Brume from Cycles.\n")
        parts.append(_scenes(results))
    if results["grids"]:
        parts.append(grids.markdown(results["grids"]))
    if results["speed"]:
        speed = results["speed"]
        parts.append("Multiple scattering in a cloud of {}^3 voxels, {}x{}:\n".format(speed["edge"], *speed["size"]))
        parts.append(table(speed["rows"], (("renderer", "renderer"), ("samples", "samples"), ("cpu", "CPU s"),
                                           ("error", "error %"), ("cost", "CPU s for an error of 1 %"),
                                           ("ratio", "times Brume"), ("mean", "mean radiance"))))
    parts += [_parts(row) for row in results["scenes"]]
    return "\n".join(parts)
