"""script/bench-page: the page in a browser, hostile and damaged results, and the table of the claimed figures.

BRUME_PROGRAM names the program, BRUME_SOURCE_DIR the source tree. With GTEST_OUTPUT=xml:FOLDER/ script/test counts the
cases. Arguments are names of cases; default: all."""
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest
import xml.sax.saxutils

import browser
from documents import Document, hostile, measured, sound

ROOT = pathlib.Path(os.environ["BRUME_SOURCE_DIR"])
PROGRAM = os.environ["BRUME_PROGRAM"]
sys.path.insert(0, str(ROOT / "bench/page"))
import peers  # noqa: E402

CLAIMS = json.loads((ROOT / "bench/page/claims.json").read_text(encoding="utf-8"))
WITHOUT_CHROMIUM = "chromium is not installed; script/bootstrap test installs it"


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.page = self.folder / "page.html"

    def save(self, values, name="bench.json"):
        path = self.folder / name
        path.write_bytes(values if isinstance(values, bytes) else json.dumps(values).encode())
        return path

    def call(self, *arguments):
        return subprocess.run([ROOT / "script/bench-page", *map(str, arguments)], capture_output=True, text=True,
                              check=False)

    def make(self, *files):
        done = self.call(*files, "-o", self.page)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return self.page.read_text(encoding="utf-8")


@unittest.skipUnless(browser.CHROMIUM, WITHOUT_CHROMIUM)
class BrowserTest(Case):
    def shown(self):
        text, console = browser.dom(self.page)
        self.assertEqual(console, [])
        return Document(text)

    def test_shows_what_the_program_measured(self):
        found = self.folder / "bench.json"
        names = ["fill/1800", "smokes/idle", "tank/pack/65535", "wire/keyframe"]
        done = subprocess.run([PROGRAM, "bench", *names, "--repetitions", "3", "--json", found, "--quiet"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        measurements = json.loads(found.read_text())["results"]
        self.assertGreaterEqual(len(measurements), len(names))
        self.make(found)
        page = self.shown()
        self.assertEqual(len(page.all("svg", role="img")), 4)  # a family each
        self.assertEqual(len(page.all("rect")), len(measurements))
        rows = [e for e in page.all("th", scope="row") if "role" not in e[1]]
        self.assertEqual([e[2] for e in rows], [m["name"] for m in measurements])
        self.assertEqual(len(page.all("th", role="rowheader")), len(CLAIMS))
        for m in measurements:
            claimed = [c for c in CLAIMS if c["case"] == m["name"]]
            for claim in claimed:
                value = m["details"][claim["detail"]] if "detail" in claim else m["median"]
                cell = self.cell_of(page, claim)
                number = float(re.match(r"[\d.,]+", cell)[0].replace(",", ""))
                self.assertLessEqual(abs(number - value), 0.005 * value, cell)
        self.assertEqual(sum("not measured here" in text for text in page.texts("td")), len(CLAIMS) - 3)
        note = " ".join(page.texts("div", role="note"))
        self.assertIn(f"{len(CLAIMS) - 3} of the {len(CLAIMS)} claimed figures", note)
        self.assertIn("march/1080p", note)
        self.assertNotIn("wire/keyframe", note)

    def cell_of(self, page, claim):
        """The last cell of a claim's row."""
        cells = page.texts("td", role="cell")
        columns = len(cells) // len(CLAIMS)
        return cells[columns * CLAIMS.index(claim) + columns - 1]

    def test_nothing_of_hostile_results_runs_or_is_fetched(self):
        with browser.Listener() as listener:
            text = self.make(self.save(hostile(listener.address("stolen"))))
            page = self.shown()
            self.assertEqual(listener.paths, [])
            self.assertEqual(page.loaded(), [])
            self.assertEqual(Document(text).loaded(), [])
            self.assertEqual(Document(text).unbalanced, [])
            self.assertEqual(len(page.all("rect")), 1)
            for invisible in "\u202e\u200b\x00":
                self.assertNotIn(invisible, text)
            shown = page.texts("dd")[0]
            for part in ("<script src=", "&lt;&#60;", "\u65e5\u672c \U0001f32b"):
                self.assertIn(part, shown)

    def test_the_listener_and_the_console_would_tell(self):
        with browser.Listener() as listener:
            self.page.write_text(f"<!doctype html><img src={listener.address('seen')}><script>missing()</script>")
            _, console = browser.dom(self.page)
            self.assertEqual(listener.paths, ["/seen"])
            self.assertTrue(any("missing is not defined" in line for line in console), console)
            self.assertEqual(len(Document(self.page.read_text()).loaded()), 3)  # the address, the image, the script

    def test_is_drawn_light_and_dark_wide_and_narrow(self):
        self.make(self.save(sound()), self.save(sound(device="other"), "b.json"))
        style = (ROOT / "bench/page/style.css").read_text()
        light, dark = style.split("@media (prefers-color-scheme: dark)")
        for width, height, is_dark in ((1200, 2400, False), (390, 1200, True)):
            path = self.folder / f"{width}.png"
            self.assertEqual(browser.screenshot(self.page, path, width, height, is_dark), [])
            found = browser.colours(path)
            for name in ("back", "card", "s0", "s1"):
                wanted = [re.search(rf"--{name}: #(\w+);", part)[1] for part in (light, dark)]
                wanted = [bytes.fromhex(c if len(c) == 6 else "".join(2 * d for d in c)) for c in wanted]
                self.assertIn(wanted[is_dark], found, (name, width))
            self.assertNotIn(bytes.fromhex("14171b" if not is_dark else "f6f7f9"), found, width)


class PageTest(Case):
    def test_compares_files(self):
        faster = [measured("march/1080p", 0.5), measured("lens/remap/6", 0.1)]
        files = [self.save(sound()), self.save(sound(device="<b>", results=faster), "b.json")]
        page = Document(self.make(*files))
        self.assertEqual(page.unbalanced, [])
        self.assertEqual(len(page.all("section")), 2)
        self.assertEqual(page.texts("th", role="columnheader"), ["Figure", "Claimed", "A NVIDIA H100", "B <b>"])
        self.assertEqual(len(page.all("rect")), 4)
        widths = {e[1]["class"]: float(e[1]["width"]) for e in page.all("rect")[:2]}
        self.assertAlmostEqual(widths["s0"], 0.5 * widths["s1"], delta=0.1)
        march = [c for c in CLAIMS if c["case"] == "march/1080p"][0]
        cells = page.texts("td", role="cell")[3 * CLAIMS.index(march):][:3]
        for cell, milliseconds in ((cells[1], 0.25), (cells[2], 0.5)):
            self.assertIn(f"; {milliseconds / march['value']:.3g} times the claimed figure", cell)
        text = self.page.read_bytes()
        self.make(*files)
        self.assertEqual(self.page.read_bytes(), text)

    def test_is_accessible(self):
        page = Document(self.make(self.save(sound())))
        self.assertEqual(page.all("html")[0][1]["lang"], "en")
        self.assertIn("NVIDIA H100", page.texts("title")[0])
        ids = [e[1]["id"] for e in page.elements if "id" in e[1]]
        self.assertEqual(len(ids), len(set(ids)))
        named = [name for e in page.elements for name in e[1].get("aria-labelledby", "").split()]
        self.assertGreater(len(named), 4)
        self.assertLessEqual(set(named), set(ids))
        self.assertIn("fill/1800 0.11 ms", page.texts("desc"))
        for table in page.all("table"):
            self.assertIn("Repetitions" if "all" in table[1]["id"] else "claimed", table[2])
        self.assertEqual(len(page.all("th", scope="row")), len(CLAIMS) + 2)

    def test_gives_the_reason_of_what_was_skipped(self):
        page = Document(self.make(self.save(sound(skipped=["voxelize/demo@512: no demo"], results=[]))))
        cells = page.texts("td", role="cell")
        self.assertIn("not measured hereno demo", cells)
        self.assertIn("not measured hererun brume bench frame/1080p", cells)
        self.assertEqual(page.texts("li"), ["voxelize/demo@512: no demo"])
        self.assertEqual(page.all("svg"), [])

    def test_bars_keep_their_proportions(self):
        wide = [measured(f"holes/{i}", 10.0 ** i) for i in range(4)]
        page = Document(self.make(self.save(sound(results=wide + [measured("decals/1", 0), measured("decals/2", 2)]))))
        widths = [float(e[1]["width"]) for e in page.all("rect")]
        steps = [b - a for a, b in zip(widths[:3], widths[1:4])]
        self.assertLess(max(steps) - min(steps), 0.25)  # logarithmic: a decade is as long as the next; rounded to 0.1
        self.assertEqual(widths[4], 1)
        self.assertIn("ms, shorter is better, logarithmic scale", page.texts("figcaption")[0])
        self.assertNotIn("logarithmic", page.texts("figcaption")[1])

    def test_damaged_results_give_one_line_and_no_page(self):
        whole = json.dumps(sound()).encode()
        infinite = json.dumps(sound(results=[{**measured("a", 1), "max": 7654}])).replace("7654", "1e999").encode()
        bad = {"cut": whole[:len(whole) // 2], "empty": b"", "list": b"[]", "bytes": b"\xff\xfe\x00",
               "deep": b"[" * 10 ** 5, "infinite": infinite,
               "command": sound(command="render"), "schema": sound(schema=2), "results": sound(results={}),
               "entry": sound(results=[7]), "name": sound(results=[measured(None, 1)]),
               "text": sound(results=[{**measured("a", 1), "median": "1"}]),
               "nan": sound(results=[{**measured("a", 1), "median": math.nan}]),
               "large": sound(results=[{**measured("a", 1), "max": 10 ** 400}]),
               "negative": sound(results=[measured("a", -1)]), "order": sound(results=[{**measured("a", 1), "min": 2}]),
               "twice": sound(results=[measured("a", 1), measured("a", 1)]), "device": sound(device=None),
               "details": sound(results=[measured("a", 1, details={"b": "c"})]), "skipped": sound(skipped=[1]),
               "bool": sound(results=[{**measured("a", 1), "repetitions": True}])}
        good = self.save(sound(), "good.json")
        for name, values in bad.items():
            with self.subTest(name):
                path = self.save(values, f"{name}.json")
                done = self.call(good, path, "-o", self.page)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertRegex(done.stderr, r"\Ascript/bench-page: [^\n]*" + name + r"\.json[^\n]*\n\Z")
                path.unlink()
                self.assertEqual([p.name for p in self.folder.iterdir()], ["good.json"])

    def test_wrong_calls_leave_what_was_there(self):
        good = self.save(sound())
        self.page.write_text("kept")
        for arguments in ([good], [good, "-o", good], [self.folder / "none.json", "-o", self.page],
                          [self.folder, "-o", self.page], [good, "-o", self.folder / "none/page.html"],
                          [*[good] * 7, "-o", self.page], ["-o", self.page]):
            done = self.call(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertRegex(done.stderr.splitlines()[-1], r"script/bench-page: .*(expected|required)")
        self.assertEqual(self.page.read_text(), "kept")
        self.assertEqual(json.loads(good.read_text()), sound())
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["bench.json", "page.html"])


    def test_a_full_disk_leaves_what_was_there(self):
        good = self.save(sound())
        self.page.write_text("kept")
        done = subprocess.run([ROOT / "script/bench-page", good, "-o", self.page], capture_output=True, text=True,
                              check=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"\A[^\n]*page\.html: File too large; expected space[^\n]*\n\Z")
        self.assertEqual(self.page.read_text(), "kept")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["bench.json", "page.html"])


class ClaimsTest(unittest.TestCase):
    """What pages claim, in one line each."""
    pages = {str(path.relative_to(ROOT)): " ".join(path.read_text(encoding="utf-8").split())
             for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]}
    readme = pages["README.md"]

    def test_its_page_says_each(self):
        for claim in CLAIMS:
            self.assertEqual(self.pages[claim["page"]].count(claim["text"]), 1, claim["text"])

    def test_a_page_that_states_a_figure_states_its_condition(self):
        for claim in CLAIMS:
            for path, text in self.pages.items():
                if "condition" in claim and claim["figure"] in text:
                    for part in claim["condition"]:
                        self.assertTrue(part in text, f"{path} has \"{claim['figure']}\" and no \"{part}\"")

    def test_figures_are_those_of_their_texts(self):
        words = {"a quarter to a sixth of the CPU time": 0.25, "a fifth of its error": 0.2,
                 "twice as fast as a march through NanoVDB's tree": 0.5, "less than a sixth of the CPU time": 0.1667}
        for claim in CLAIMS:
            if "value" in claim:
                said = words.get(claim["figure"]) or float(re.search(r"[\d.]+", claim["figure"])[0])
                self.assertEqual(claim["value"], said)
            self.assertIn(claim["figure"], claim["text"])

    # A new figure of the README that nothing measures shows here.
    def test_no_figure_of_the_readme_is_left_out(self):
        does = self.readme[self.readme.index("## What it does"):self.readme.index("## Documentation")]
        texts = [c["text"] for c in CLAIMS if c["page"] == "README.md"]
        covered = [range(does.index(text), does.index(text) + len(text)) for text in texts]
        figure = (r"\d[\d.,]* (?:%|(?:ms|s|us|ns|million|bytes|MB|GB|times)\b)"
                  r"|\b(?:third|quarter|fifth|sixth|tenth) of|\btwice\b")
        found = [match for match in re.finditer(figure, does)]
        self.assertGreater(len(found), 5)
        for match in found:
            self.assertTrue(any(match.start() in part for part in covered), does[match.start() - 40:match.end() + 20])

    def test_the_program_has_each_case(self):
        text = subprocess.run([PROGRAM, "bench", "--help"], capture_output=True, text=True, check=True).stdout
        text = text[text.index("They are"):text.index("Options:")]
        names = set(re.split(r"[\s,]+", text))
        for claim in CLAIMS:
            if "by" not in claim:
                self.assertTrue(claim.get("run", claim["case"]) in names, claim["case"])


CLOUD = {"renderers": [{"renderer": "Brume, lavapipe", "cpu": 1.5, "rmse": 0.5},
                       {"renderer": "Brume, lavapipe, --step 2", "cpu": 1, "rmse": 1},
                       {"renderer": "vdb_render 10.0.1", "cpu": 6, "rmse": 4},
                       {"renderer": "vdb_render 10.0.1, finer", "cpu": 60, "rmse": 0.5}],
         "nanovdb": ["NanoVDB: 9 bytes", "nearest    median   0.4000 min 0.3 max 1 ms; transmittance 0.1",
                     "trilinear  median   9.0000 min 9 max 9 ms; transmittance 0.1",
                     "volumes/fog_sphere       median        0.3  min        0.2  max        0.4 ms (gpu)"]}
CYCLES = {"speed": {"rows": [{"cost": 2}, {"cost": 40}, {"cost": 20}]},
          "scenes": [{"same_model": True, "whole": -0.002}, {"same_model": True, "whole": 0.001},
                     {"same_model": False, "whole": 0.2}]}


class BenchClaimsTest(Case):
    """script/bench-claims, with a program in the place of brume."""

    def run_with(self, bench):
        """With a shell's words for `brume bench`; other commands fail."""
        build = self.folder / "build"
        (build / "bench/peers").mkdir(parents=True)
        for name, text in (("brume", f'[ "$1" = bench ] || {{ echo "no $1"; exit 3; }}\n{bench}'),
                           ("volume_reference", "exit 3")):
            path = build / ("bench/peers" if name != "brume" else "") / name
            path.write_text(f"#!/bin/sh\n{text}\n")
            path.chmod(0o755)
        return subprocess.run([ROOT / "script/bench-claims", "--build", build, "-o", self.folder / "claims.json"],
                              cwd=self.folder, capture_output=True, text=True, check=False)

    def test_multiples_of_other_renderers(self):
        values = {one["name"]: one["median"] for one in peers.of_bench_peers(CLOUD) + peers.of_compare_cycles(CYCLES)}
        for name, wanted in zip((*peers.OF_BENCH_PEERS, *peers.OF_COMPARE_CYCLES), (0.25, 0.125, 0.75, 0.1, 0.2)):
            self.assertAlmostEqual(values.pop(name), wanted, places=12)
        self.assertEqual(values, {})
        self.assertEqual(peers.of_bench_peers({"renderers": CLOUD["renderers"][2:], "nanovdb": []}), [])
        self.assertEqual(peers.of_compare_cycles({"speed": None, "scenes": []}), [])

    def test_a_page_has_a_figure_of_each(self):
        self.assertEqual({(c["case"], c["by"]) for c in CLAIMS if "by" in c},
                         {(name, "script/bench-claims") for name in peers.OF_BENCH_PEERS + peers.OF_COMPARE_CYCLES})

    def test_one_file_has_all_or_says_why_not(self):
        named = [measured(claim["case"], 1, details={claim.get("detail", "triangles"): 1})
                 for claim in CLAIMS if "by" not in claim]
        (self.folder / "canned.json").write_text(json.dumps(sound(results=named, skipped=["x: why"])))
        done = self.run_with(f'echo "$@" > {self.folder}/words; cp {self.folder}/canned.json bench.json')
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads((self.folder / "claims.json").read_text())
        self.assertEqual(found["results"], named)
        self.assertEqual(found["skipped"][0], "x: why")
        reasons = dict(line.split(": ", 1) for line in found["skipped"][1:])
        self.assertEqual(set(reasons), {claim["case"] for claim in CLAIMS if "by" in claim})
        self.assertTrue(all("script/" in reason for reason in reasons.values()), reasons)
        words = (self.folder / "words").read_text().split()
        for claim in CLAIMS:
            self.assertEqual(words.count(claim.get("run", claim["case"])), "by" not in claim, claim["case"])
        page = Document(self.make(self.folder / "claims.json"))
        self.assertIn(f"5 of the {len(CLAIMS)} claimed figures", page.texts("div", role="note")[0])

    def test_a_failure_is_one_line_and_leaves_an_earlier_file(self):
        (self.folder / "claims.json").write_text("kept")
        done = self.run_with("echo no device; exit 5")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"\nscript/bench-claims: [^\n]* code 5: no device; see [^\n]*log.txt\n\Z")
        self.assertEqual((self.folder / "claims.json").read_text(), "kept")


def report(result, path):
    skipped = "".join(f"<skipped message={xml.sax.saxutils.quoteattr(reason)}/>\n" for _, reason in result.skipped)
    failed = {test.id().split(" ")[0] for test, _ in result.failures + result.errors}
    path.write_text(f'<testsuite name="bench_page" tests="{result.testsRun}" failures="{len(failed)}" disabled="0" '
                    f'skipped="{len(result.skipped)}" errors="0">\n{skipped}</testsuite>\n', encoding="utf-8")


if __name__ == "__main__":
    names = sys.argv[1:] or ["BrowserTest", "PageTest", "ClaimsTest", "BenchClaimsTest"]
    tests = unittest.defaultTestLoader.loadTestsFromNames(names, sys.modules["__main__"])
    outcome = unittest.TextTestRunner(verbosity=2).run(tests)
    if os.environ.get("GTEST_OUTPUT", "").startswith("xml:"):
        report(outcome, pathlib.Path(os.environ["GTEST_OUTPUT"][4:], "bench_page_tests.xml"))
    sys.exit(0 if outcome.wasSuccessful() and outcome.testsRun > 0 else 1)
