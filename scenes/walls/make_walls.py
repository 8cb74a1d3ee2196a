#!/usr/bin/env python3
"""Writes three small scenes with smoke at a wall: flat, slanted and round. Needs nothing but Python 3."""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
HEIGHT = 6.0  # no smoke of the timelines goes over it [m]


def write_obj(name, points, faces):
    """Faces: corners counter-clockwise seen from outside, counted from 0."""
    lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    (HERE / "Meshes" / f"{name}.obj").write_text("\n".join(lines) + "\n")


def write_prism(name, outline, low, high):
    """A prism over an outline of (x, z) that turns from x to z."""
    n = len(outline)
    points = [(x, low, z) for x, z in outline] + [(x, high, z) for x, z in outline]
    faces = [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1))]
    faces += [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
    write_obj(name, points, faces)


def wall(degrees, middle_z, length=16.0, thickness=0.1):
    """Outline of a wall through (0, middle_z), turned from the x axis."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    corners = [(-length / 2, -thickness / 2), (length / 2, -thickness / 2),
               (length / 2, thickness / 2), (-length / 2, thickness / 2)]
    return [(c * x - s * z, middle_z + s * x + c * z) for x, z in corners]


def column(x, z, radius, sides=64):
    turns = [2 * math.pi * i / sides for i in range(sides)]
    return [(x + radius * math.cos(t), z + radius * math.sin(t)) for t in turns]


def main():
    (HERE / "Meshes").mkdir(exist_ok=True)
    write_prism("Floor", [(-15, -15), (15, -15), (15, 15), (-15, 15)], -0.3, 0.0)
    write_prism("Flat", wall(0, 0.13), -0.1, HEIGHT)
    write_prism("Slanted", wall(30, 0.13), -0.1, HEIGHT)
    write_prism("Round", column(0.11, 0.23, 1.0), -0.1, HEIGHT)
    for name in ("Flat", "Slanted", "Round"):
        lines = ["# NAME  position  rotation  scale"]
        lines += [f"{part} 0 0 0  0 0 0  1 1 1" for part in ("Floor", name)]
        lines += ["# LIGHT_SOURCE  position  colour  watts", "LIGHT_SOURCE -6 8 -9  1 0.93 0.82  9000"]
        (HERE / f"{name.lower()}.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
