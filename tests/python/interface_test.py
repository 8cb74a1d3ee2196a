"""What belongs to every function: a docstring, a type stub with the same parameters, and Ctrl-C."""

import ast
import inspect
import os
import re
import signal
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

import brume
import numpy as np
from places import BUILD, STUBS, lines_through, smoky_world, work_folder


def public(names):
    return {name for name in names if not name.startswith("_") or name == "__init__"}


def parameters(function):
    """Names of the parameters that a docstring of pybind11 or Python itself declares, without self."""
    try:
        return [name for name in inspect.signature(function).parameters if name != "self"]
    except ValueError:
        pass
    line = function.__doc__.splitlines()[0]
    inside = line[line.index("(") + 1:line.rindex(") ->")]
    flat = re.sub(r"=[^,()]*\([^)]*\)", "", re.sub(r"\[[^\[\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", inside)))
    names = [part.split(":")[0].split("=")[0].strip() for part in flat.split(",")]
    return [name for name in names if name not in ("self", "*", "/", "")]


def stub_parameters(node):
    names = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
    return [name for name in names if name != "self"]


class StubTest(unittest.TestCase):
    def test_names_are_the_same(self):
        declared = {node.name for node in STUBS.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(declared, set(brume.__all__))
        for node in STUBS.body:
            if not isinstance(node, ast.ClassDef) or node.name == "Grid":
                continue
            with self.subTest(node.name):
                members = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
                real = getattr(brume, node.name)
                own = public(vars(real)) - ({"__init__"} if "__init__" not in members else set())
                self.assertEqual(public(members), own)

    def test_parameters_are_the_same(self):
        count = 0
        for node in STUBS.body:
            scope = [(brume, node)] if isinstance(node, ast.FunctionDef) else [
                (getattr(brume, node.name), part) for part in getattr(node, "body", [])
                if isinstance(node, ast.ClassDef) and isinstance(part, ast.FunctionDef)]
            for owner, function in scope:
                if any(getattr(d, "id", "") == "property" for d in function.decorator_list):
                    continue
                with self.subTest(f"{owner.__name__}.{function.name}"):
                    real = inspect.getattr_static(owner, function.name)
                    real = getattr(owner, function.name) if isinstance(real, staticmethod) else real
                    self.assertEqual(stub_parameters(function), parameters(real))
                    count += 1
        self.assertGreater(count, 25)

    def test_everything_has_a_docstring(self):
        self.assertTrue(brume.__doc__)
        for name in brume.__all__:
            real = getattr(brume, name)
            self.assertTrue(real.__doc__, name)
            for member in public(vars(real)) if inspect.isclass(real) else ():
                if member == "__init__" and name in ("Level", "Scenario", "Smoke"):
                    continue  # They have none: functions make them.
                text = inspect.getattr_static(real, member).__doc__ if name != "Grid" else real.__doc__
                text = text or getattr(real, member).__doc__
                # The first line of pybind11's is the signature.
                lines = [line for line in (text or "").splitlines() if line.strip()]
                self.assertGreater(len(lines), 1 if lines and "(self" in lines[0] else 0, f"{name}.{member}")

    def test_names_of_classes_are_those_of_the_package(self):
        for name in brume.__all__:
            self.assertTrue(getattr(brume, name).__module__.startswith("brume"))
        self.assertEqual(brume.World.__module__, "brume")
        self.assertTrue(Path(brume.__file__).with_name("py.typed").exists())


class InterruptTest(unittest.TestCase):
    def test_ctrl_c_ends_a_query(self):
        """Requests are sent one after the other, as each is noticed; the last of them raises. A query that tests for
        none while it runs notices two at most: before it begins and after its end."""
        world = smoky_world()
        # Each core takes 65,536 lines between two tests, of which there are more than requests.
        a, b = (ends[0] for ends in lines_through(world, 1))
        many = np.broadcast_to(b, ((1 << 16) * os.cpu_count() * 24, 3))
        noticed = threading.Semaphore(0)
        requests, is_over = 6, False

        def notice(_signal, _frame):
            nonlocal requests
            requests -= 1
            noticed.release()
            if requests == 0:
                raise KeyboardInterrupt

        def request():
            while requests > 0 and not is_over:
                signal.raise_signal(signal.SIGINT)
                noticed.acquire()

        before = signal.signal(signal.SIGINT, notice)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        sender = threading.Thread(target=request)
        sender.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                world.optical_depth(a, many)
        finally:
            is_over = True
            noticed.release()
            sender.join()
        self.assertEqual(world.optical_depth(a, b[None]).shape, (1,))

    def test_another_thread_runs_meanwhile(self):
        """Longer and longer queries, until this thread had a hundred turns during one."""
        world = smoky_world()
        rounds, is_inside = 0, False

        def query(a, b):
            nonlocal is_inside
            is_inside = True
            world.optical_depth(a, b)
            is_inside = False

        for count in (300_000, 3_000_000, 15_000_000):
            lines = [np.broadcast_to(ends[0], (count, 3)) for ends in lines_through(world, 1)]
            thread = threading.Thread(target=query, args=lines)
            rounds = 0
            thread.start()
            while thread.is_alive() and rounds <= 100:
                rounds += is_inside
                time.sleep(0)
            thread.join()
            if rounds > 100:
                break
        self.assertGreater(rounds, 100)


class InstallTest(unittest.TestCase):
    def test_installed_package_works(self):
        with work_folder() as folder:
            prefix = Path(folder) / "usr"
            for component in ("python", "program"):
                subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix, "--component", component], check=True,
                               capture_output=True)
            packages = prefix / "lib/python3/dist-packages"
            for file in ("__init__.py", "__init__.pyi", "_grids.py", "py.typed"):
                self.assertTrue((packages / "brume" / file).is_file(), file)
            code = ("import brume, numpy as np, os; print(brume.__file__, os.environ['BRUME_VDB']);"
                    f"brume.write_grids({folder + '/a.vdb'!r}, brume.Grid(np.ones((2, 2, 2), np.float32)));"
                    f"print(brume.read_grids({folder + '/a.vdb'!r}))")
            done = subprocess.run([sys.executable, "-B", "-c", code], env={"PYTHONPATH": str(packages)}, cwd="/",
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{packages}/brume/__init__.py {prefix}/bin/brume-vdb\n", done.stdout)
            self.assertIn("Grid(name='density', shape=(2, 2, 2), dtype=float32)", done.stdout)


if __name__ == "__main__":
    unittest.main()
