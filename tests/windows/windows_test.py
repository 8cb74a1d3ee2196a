#!/usr/bin/env python3
"""Compares the build for Windows, under Wine, with that for Linux: hashes, pictures, files, messages.

  windows_test.py LINUX_BUILD WINDOWS_BUILD WORK_FOLDER

Exit code 77: something to run it with is missing; the reason is printed.
"""
import pathlib
import shutil
import subprocess
import sys
import unittest
import zipfile

import wine

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LINUX, WINDOWS, WORK = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
# Letters of three scripts, of which no single-byte code page has all.
LETTERS = "R\u00e4ume \u03a9 \u7159"
MODES = (("--threads", "1"), ("--threads", "2"), ("--threads", "8"), ("--calls", "20"), ("--calls", "240"),
         ("--mode", "rollback"), ("--mode", "late"), ("--mode", "snapshot"))
SMALL = ("--size", "160x90")


def fresh(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


class WindowsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.wine = wine.Wine(WORK / "prefix")
        cls.addClassCleanup(cls.wine.close)

    def linux(self, command, folder):
        ended = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, check=False,
                               stdin=subprocess.DEVNULL, env={**self.wine.environment})
        return ended.returncode, ended.stdout, ended.stderr

    def both(self, program, *arguments, there="", name=None):
        """What a program printed on Windows, once it has printed the same on Linux, and two folders of its files."""
        folders = [fresh(WORK / (name or self.id()) / system) for system in ("linux", "windows")]
        here = self.linux([LINUX / there / program, *arguments], folders[0])
        other = self.wine.run([WINDOWS / (program + ".exe"), *arguments], folders[1])
        self.assertEqual(here[0], 0, here)
        self.assertEqual(other[0], 0, other)
        self.assertEqual(here[1], other[1].replace(b"\r\n", b"\n"), (program, arguments))
        return other[1], folders

    def same_file(self, folders, name):
        here, other = ((folder / name).read_bytes() for folder in folders)
        self.assertGreater(len(here), 100)
        self.assertTrue(here == other, f"{name} differs: {folders}")

    # ---- The simulation ----

    def test_a_busy_match_has_the_same_hashes_in_all_modes(self):
        for mode in MODES:
            lines, _ = self.both("busy_match", *mode, there="tests/determinism")
            self.assertGreater(lines.count(b"\n"), 600, mode)

    def test_a_match_through_the_c_interface_has_the_same_hashes_over_6000_ticks(self):
        lines, _ = self.both("brume_server", "--seconds", "94", there="examples/server")
        self.assertIn(b"\n5952 ", lines)

    def test_a_program_in_c_has_the_static_library_in_it(self):
        folder = fresh(WORK / self.id())
        compiled = subprocess.run(
            ["x86_64-w64-mingw32-gcc-posix", "-DBRUME_STATIC", SOURCE / "examples/server/server.c", "-I",
             SOURCE / "include", WINDOWS / "libbrume-sim-static.a", "-lstdc++", "-static", "-o", folder / "server.exe"],
            capture_output=True, text=True, check=False)
        self.assertEqual(compiled.returncode, 0, compiled.stderr)
        needed = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", folder / "server.exe"], capture_output=True,
                                text=True, check=True).stdout
        self.assertNotIn("DLL Name: brume", needed)
        code, output, errors = self.wine.run([folder / "server.exe", "--seconds", "10"], folder)
        self.assertEqual(code, 0, errors)
        here = self.linux([LINUX / "examples/server/brume_server", "--seconds", "10"], folder)
        self.assertIn(b"\n 640 ", here[1])
        self.assertEqual(output.replace(b"\r\n", b"\n"), here[1])

    def test_the_tests_of_the_c_interface_pass(self):
        code, output, _ = self.wine.run([WINDOWS / "windows_api_tests.exe"], fresh(WORK / self.id()))
        self.assertEqual(code, 0, output.decode(errors="replace"))

    def test_the_tests_of_files_and_children_pass(self):
        code, output, _ = self.wine.run([WINDOWS / "windows_core_tests.exe"], fresh(WORK / self.id()))
        self.assertEqual(code, 0, output.decode(errors="replace"))

    def test_the_libraries_need_only_the_system(self):
        system = {"KERNEL32.dll", "msvcrt.dll", "ADVAPI32.dll", "SHELL32.dll", "PSAPI.DLL"}
        for library in ("brume-sim.dll", "brume.dll"):
            text = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", WINDOWS / library], capture_output=True,
                                  text=True, check=True).stdout
            needed = {line.split()[-1] for line in text.splitlines() if "DLL Name:" in line}
            self.assertLessEqual(needed, system, library)
            table = text[text.index("[Ordinal/Name Pointer] Table"):].split("\n\n")[0]
            exported = [line.split()[-1] for line in table.splitlines()[1:]]
            self.assertTrue(all(name.startswith("brume_") for name in exported), exported)
            wanted = (SOURCE / "tests/api/symbols.txt").read_text().split()
            self.assertEqual([name for name in wanted if name not in exported], [], library)

    # ---- The renderer in a host ----

    def test_hosts_draw_the_same_pictures(self):
        _, folders = self.both("hello_host", "hello.png", there="examples/hello_host", name="hello_host")
        self.same_file(folders, "hello.png")
        for number, options in enumerate((("--frames", "30"), ("--frames", "12", "--players", "2"),
                                          ("--frames", "12", "--taa", "smoke"), ("--frames", "12", "--no-smoke"))):
            picture = f"{number}.ppm"
            _, folders = self.both("brume_host_example", "-o", picture, *options, there="examples/host",
                                   name=f"host_{number}")
            self.same_file(folders, picture)

    # ---- The program ----

    def test_the_program_draws_the_demo_as_on_linux(self):
        for scene in ("demo", "letters"):
            picture = scene + ".png"
            _, folders = self.both("brume", "render", SOURCE / f"scenes/{scene}.toml", "--time", "3", *SMALL,
                                   "-o", picture, name="render_" + scene)
            self.same_file(folders, picture)

    def test_the_program_answers_as_on_linux(self):
        demo = SOURCE / "scenes/demo.toml"
        sight = ("query", demo, "--from", "-5.2,1.35,10.8", "--to", "-1.75,1.65,-3", "--time", "3")
        for number, words in enumerate((("info", SOURCE / "scenes/demo.glb"), ("sim", demo, "--hash"), sight,
                                        ("palettes", "sea", "--limit", "3"))):
            self.both("brume", *words, name=f"answers_{number}")
        folders = [fresh(WORK / "volumes" / system) for system in ("linux", "windows")]
        for words in (("bake", "pyroclastic", "-o", "cloud.brv", "--voxel", "0.5"),
                      ("convert", "cloud.brv", "cloud.json"),
                      ("bake", "slices", "cloud.brv", "-o", "slices.png")):
            for run in (self.linux([LINUX / "brume", *words], folders[0]),
                        self.wine.run([WINDOWS / "brume.exe", *words], folders[1])):
                self.assertEqual(run[0], 0, run)
        for name in ("cloud.brv", "cloud.json", "slices.png"):
            self.same_file(folders, name)

    def test_paths_and_messages_are_utf8(self):
        folder = fresh(WORK / self.id() / LETTERS)
        shutil.copy(SOURCE / "scenes/demo.glb", folder / f"{LETTERS}.glb")
        picture = folder / f"{LETTERS}.png"
        code, _, errors = self.wine.run(
            [WINDOWS / "brume.exe", "render", f"{LETTERS}.glb", "--smoke", "0,0.4,2.5", *SMALL, "-o", picture.name],
            folder)
        self.assertEqual(code, 0, errors)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
        code, _, errors = self.wine.run([WINDOWS / "brume.exe", "info", f"no {LETTERS}.glb"], folder)
        self.assertNotEqual(code, 0)
        self.assertIn(f"no {LETTERS}.glb".encode(), errors)
        self.assertEqual({path.name for path in folder.iterdir()}, {f"{LETTERS}.glb", picture.name})

    def test_what_is_missing_is_said_in_one_line(self):
        folder = fresh(WORK / self.id())
        (folder / "a.vdb").write_bytes(b"x" * 100)
        for words, said in ((("info", "a.vdb"), b"requires the program brume-vdb"), (("view",), b"view")):
            code, _, errors = self.wine.run([WINDOWS / "brume.exe", *words], folder)
            self.assertNotEqual(code, 0)
            self.assertIn(said, errors)
            self.assertEqual(errors.strip().count(b"\n"), 0, errors)

    # ---- The package ----

    def test_the_package_unpacks_and_runs(self):
        made = subprocess.run([SOURCE / "script/package-windows"], capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stderr)
        folder = fresh(WORK / self.id() / LETTERS)
        with zipfile.ZipFile(made.stdout.strip()) as package:
            package.extractall(folder)
        root, = folder.iterdir()
        for name in ("bin/brume.dll", "bin/brume-sim.dll", "lib/libbrume.dll.a", "lib/libbrume-sim.dll.a",
                     "include/brume/brume.h", "include/brume/brume_vulkan.h", "LICENSE.txt", "licences/NOTICES.txt",
                     "licences/libzstd.txt"):
            self.assertTrue((root / name).is_file(), name)
        code, _, errors = self.wine.run(
            [root / "bin/brume.exe", "render", root / "share/brume/scenes/letters.toml", "--time", "3", *SMALL,
             "-o", "letters.png"], folder)
        self.assertEqual(code, 0, errors)
        code, _, errors = self.linux([LINUX / "brume", "render", SOURCE / "scenes/letters.toml", "--time", "3",
                                      *SMALL, "-o", "linux.png"], folder)
        self.assertEqual(code, 0, errors)
        self.assertTrue((folder / "letters.png").read_bytes() == (folder / "linux.png").read_bytes())

        # A program of one's own, with the package alone.
        compiled = subprocess.run(["x86_64-w64-mingw32-gcc-posix", root / "examples/server/server.c", "-I",
                                   root / "include", "-L", root / "lib", "-lbrume-sim", "-o", root / "bin/server.exe"],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(compiled.returncode, 0, compiled.stderr)
        code, output, errors = self.wine.run([root / "bin/server.exe", "--seconds", "5"], folder)
        self.assertEqual(code, 0, errors)
        self.assertIn(b"\n 320 ", output.replace(b"\r", b""))


def main():
    reason = wine.missing()
    if not reason and not shutil.which("x86_64-w64-mingw32-g++-posix"):
        reason = "MinGW is not installed; script/bootstrap windows installs it"
    if reason:
        print("skipped:", reason)
        return 77
    for command in (["script/windows-libraries"], ["cmake", "--preset", "windows"],
                    ["cmake", "--build", WINDOWS]):
        ended = subprocess.run(command, cwd=SOURCE, check=False)
        if ended.returncode != 0:
            return ended.returncode
    WORK.mkdir(parents=True, exist_ok=True)
    return 0 if unittest.main(argv=[sys.argv[0], *sys.argv[4:]], exit=False, verbosity=2).result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
