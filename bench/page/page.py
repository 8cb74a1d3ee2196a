"""The page: machines, what the documentation claims beside what was measured, plots, and a table of all results."""
import pathlib
import string

import results
from plots import plot
from text import escaped, number

STYLE = pathlib.Path(__file__).with_name("style.css")
# Of the first part of a case's name; another family has its name as title.
TITLES = {
    "voxelize": "Voxelization", "fill": "Flood fill", "edit": "Doors in a level", "live": "Actions in a running world",
    "volume": "Density field", "sight": "Lines of sight", "sim": "A tick of 16 smokes", "smokes": "Many smokes",
    "wire": "Packets", "march": "March", "frame": "Frames", "indirect_light": "Indirect light",
    "light_cache": "Light that is kept", "holes": "Holes", "holes_around": "Holes from all around",
    "volumes": "Volumes", "particles": "Particles", "decals": "Decals", "tank": "Tanks of spheres",
    "lens": "Points of a lens", "scaling": "Scaling", "peers": "Beside other renderers"}
BETTER = {"ms": "shorter is better", "ns": "shorter is better", "us": "shorter is better", "M/s": "longer is better",
          "times": "shorter is better"}


class Page:
    """`files` are one or more results.Results, the columns and the colours of the page."""

    def __init__(self, files):
        self.files, self.claims = files, results.claims()
        self.letters = string.ascii_uppercase[:len(files)]

    def letter(self, i):
        return f'<span class="letter s{i}">{self.letters[i]}</span> ' if len(self.files) > 1 else ""

    def label(self, i):
        name = self.files[i].device or self.files[i].processor
        return f"{self.letters[i]} {name}" if len(self.files) > 1 else name

    def text(self):
        machines = ", ".join(dict.fromkeys(f.device or f.processor for f in self.files))
        style = STYLE.read_text(encoding="utf-8")
        return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Brume benchmarks: {escaped(machines)}</title>
<link rel="icon" href="data:,">
<style>
{style}</style>
</head>
<body>
<header>
<h1>Brume benchmarks</h1>
<p class="soft">Results of <code>brume bench</code>. Bars are medians; the thin line spans all repetitions, and ends
in an arrow where it leaves the plot.</p>
</header>
<main>
{self.machines()}
{self.claimed()}
{self.plots()}
{self.everything()}
</main>
<footer class="soft">Written by script/bench-page.</footer>
</body>
</html>
"""

    def machines(self):
        cards = []
        for i, file in enumerate(self.files):
            device = file.device or "none: only cases of the processor ran"
            rows = {"Device": device, "Driver": file.driver or "-", "Processor": file.processor,
                    "Threads": file.threads, "Version": file.commit, "File": file.file}
            inner = "".join(f"<dt>{key}</dt><dd>{escaped(value)}</dd>" for key, value in rows.items())
            software = ('<p class="soft">A device in software: several cases draw smaller pictures there, so their '
                        'times are not comparable with those of a GPU.</p>' if file.is_software else "")
            title = f"{self.letter(i)}{escaped(file.device or file.processor)}"
            cards.append(f'<section class="card machine"><h3>{title}</h3><dl>{inner}</dl>{software}</section>')
        heading = "Machines" if len(self.files) > 1 else "Machine"
        return f'<h2>{heading}</h2>\n<div class="grid-of">{"".join(cards)}</div>'

    def missing(self, i):
        """The claims that this file lacks."""
        return [claim for claim in self.claims if self.value_of(claim, i) is None]

    def value_of(self, claim, i):
        m = self.files[i].measurements.get(claim["case"])
        return m and (m.details.get(claim["detail"]) if "detail" in claim else m.median)

    def notes(self):
        out = []
        for i in range(len(self.files)):
            lacking = self.missing(i)
            if lacking:
                cases = ", ".join(f'<code>{escaped(claim["case"])}</code>' for claim in lacking)
                out.append(f'<div class="note" role="note"><p>{self.letter(i)}{len(lacking)} of the '
                           f'{len(self.claims)} claimed figures are missing: {cases}. '
                           f'<code>script/bench-claims</code> measures all.</p></div>')
        return "".join(out)

    def cell(self, claim, i):
        begin = f'<td role="cell" data-label="{escaped(self.label(i))}"'
        value, file = self.value_of(claim, i), self.files[i]
        if value is None:
            case = claim.get("run", claim["case"])
            reason = file.reason_without(case) or f"run {claim.get('by', 'brume bench ' + case)}"
            return f'{begin} class="missing">not measured here<small>{escaped(reason)}</small></td>'
        m = file.measurements[claim["case"]]
        unit = claim["unit"] if "detail" in claim else m.unit
        small = [] if "detail" in claim else [f"{number(m.min)} to {number(m.max)}, {m.repetitions} repetitions"]
        if "value" in claim and claim["unit"] == unit:
            small.append(f"{number(value / claim['value'])} times the claimed figure")
        return f"{begin}>{escaped(f'{number(value)} {unit}')}<small>{escaped('; '.join(small))}</small></td>"

    def claimed(self):
        heads = "".join(f'<th scope="col" role="columnheader">{self.letter(i)}'
                        f'{escaped(f.device or f.processor)}</th>'
                        for i, f in enumerate(self.files))
        rows = []
        for claim in self.claims:
            on = f'<small>{escaped(claim["on"])}</small>' if claim["on"] else ""
            cells = "".join(self.cell(claim, i) for i in range(len(self.files)))
            case = f'<small><code>{escaped(claim["case"])}</code></small>'
            rows.append(f'<tr role="row"><th scope="row" role="rowheader">{escaped(claim["what"])}{case}</th>'
                        f'<td role="cell" data-label="Claimed">{escaped(claim["figure"])}{on}</td>{cells}</tr>')
        return f"""<h2 id="claims">What the documentation claims</h2>
{self.notes()}
<div class="scroll" role="region" aria-labelledby="claims" tabindex="0">
<table id="claims-table" role="table" aria-labelledby="claims">
<caption>The claimed figures, with the machine that they are of, beside those of this page. Other machines give other
figures.</caption>
<thead role="rowgroup"><tr role="row"><th scope="col" role="columnheader">Figure</th>
<th scope="col" role="columnheader">Claimed</th>{heads}</tr></thead>
<tbody role="rowgroup">
{chr(10).join(rows)}
</tbody>
</table>
</div>"""

    def families(self):
        """{(family, unit): {case: [(file, measurement)]}}, in the order of the files."""
        found = {}
        for i, file in enumerate(self.files):
            for m in file.measurements.values():
                cases = found.setdefault((m.name.split("/")[0], m.unit), {})
                cases.setdefault(m.name, []).append((i, m))
        return found

    def plots(self):
        families, figures = self.families(), []
        for n, ((family, unit), cases) in enumerate(families.items()):
            title = TITLES.get(family, family)
            drawing, is_logarithmic = plot(title, unit, list(cases.items()), self.letters, f"plot{n}")
            told = [unit, BETTER.get(unit, ""), "logarithmic scale" if is_logarithmic else ""]
            figures.append(f'<figure><figcaption><h3>{escaped(title)}</h3>{escaped(", ".join(filter(None, told)))}'
                           f"</figcaption>{drawing}</figure>")
        legend = " ".join(f"{self.letter(i)}{escaped(f.device or f.processor)}" for i, f in enumerate(self.files))
        legend = f'<p class="legend">{legend}</p>' if len(self.files) > 1 else ""
        body = f'<div class="plots">{"".join(figures)}</div>' if figures else "<p>No case was measured.</p>"
        return f"<h2>Plots</h2>\n{legend}{body}"

    def row(self, i, m):
        details = ", ".join(f"{key}: {'none' if value is None else number(value)}" for key, value in m.details.items())
        machine = f"<td>{self.letter(i)}</td>" if len(self.files) > 1 else ""
        numbers = "".join(f'<td class="number">{number(value)}</td>' for value in (m.median, m.min, m.max))
        return (f'<tr><th scope="row">{escaped(m.name)}</th>{machine}{numbers}<td>{escaped(m.unit)}</td>'
                f'<td>{escaped(m.clock)}</td><td class="number">{m.repetitions}</td>'
                f"<td><small>{escaped(details)}</small></td></tr>")

    def everything(self):
        bars = [bar for cases in self.families().values() for case in cases.values() for bar in case]
        rows = "\n".join(self.row(i, m) for i, m in bars)
        machine = '<th scope="col">Machine</th>' if len(self.files) > 1 else ""
        heads = "".join(f'<th scope="col" class="number">{name}</th>' for name in ("Median", "Least", "Largest"))
        skipped = "".join(f"<li>{self.letter(i)}{escaped(line)}</li>" for i, f in enumerate(self.files)
                          for line in f.skipped)
        skipped = f'<h2>Skipped</h2>\n<ul id="skipped">{skipped}</ul>' if skipped else ""
        return f"""<h2 id="all">All results</h2>
<details>
<summary>{len(bars)} results as a table</summary>
<div class="scroll" role="region" aria-labelledby="all" tabindex="0">
<table id="all-table">
<thead><tr><th scope="col">Case</th>{machine}{heads}<th scope="col">Unit</th><th scope="col">Clock</th>
<th scope="col" class="number">Repetitions</th><th scope="col">Details</th></tr></thead>
<tbody>
{rows}
</tbody>
</table>
</div>
</details>
{skipped}"""
