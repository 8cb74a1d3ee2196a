"""Processor time at equal error of both path tracers: a pyroclastic cloud under one sun with multiple scattering."""
import json
import math
import re

import pictures
from processes import median_run
from scene import Scene

BOUNCES = 1024


def _apart(a, b):
    """Root of the mean variance of a pixel, from two independent pictures, and the mean of both; relative to the mean
    over the pixels that the cloud covers."""
    covered = (a > 0) | (b > 0)
    mean = (a + b)[covered].mean() / 2
    variance = ((a - b)[covered]**2).mean() / 2
    return float(math.sqrt(variance) / mean), float((a + b).mean() / 2)


def _row(name, samples, measured, error, mean, **more):
    """`cost`: processor seconds for an error of 1 %; the error falls with the root of the time."""
    return {"renderer": name, "samples": samples, "cpu": measured.cpu, "error": 100 * error, "mean": mean,
            "cost": measured.cpu * (100 * error) ** 2, **more}


def brume(comparison, size):
    """Samples n to 2 n are a block of their own: what they add to the first n is independent of them."""
    samples = comparison.options.speed_brume_samples
    words = [comparison.brume, "render", "speed.toml", "--mode", "reference", "--quiet", "--background", "in",
             "--size", size]

    def render(count, times):
        out = f"speed_brume_{count}.exr"
        measured = median_run([*words, "--samples", count, "-o", out], comparison.folder, times)
        return measured, pictures.read_exr(comparison.folder / out)

    measured, first = render(samples, comparison.options.repeat)
    _, both = render(2 * samples, 1)
    return _row("Brume", samples, measured, *_apart(first, 2 * both - first))


def cycles(comparison, scene, step_rate):
    folder, samples = comparison.folder, comparison.options.speed_samples
    seen, runs = [], []
    for seed in (1, 2):
        about = {**scene.description(folder / "speed.vdb"), "bounces": BOUNCES, "seed": seed, "step_rate": step_rate}
        (folder / "speed.json").write_text(json.dumps(about))
        out = folder / f"speed_cycles_{seed}.exr"
        for _ in range(comparison.options.repeat if seed == 1 else 1):
            runs.append(comparison.blender("cycles_cloud.py", "speed.json", out, samples))
        seen.append(pictures.read_exr(out))
    measured = sorted(runs, key=lambda one: one.cpu)[(len(runs) - 1) // 2]
    parts = json.loads(re.search(r"^CYCLES (\{.*\})", measured.out, re.MULTILINE)[1])
    return _row(f"Cycles, steps of {step_rate:g} voxels", samples, measured, *_apart(*seen), start=parts["start"])


def measure(comparison):
    """The rows of both, and by how much Cycles costs more."""
    options = comparison.options
    scene = Scene(options.speed_edge, options.speed_size)
    edge = str(options.speed_edge)
    comparison.call([comparison.brume, "bake", "pyroclastic", "--edge", edge, "--voxel", "1", "-o", "speed.vdb"])
    (comparison.folder / "speed.toml").write_text(scene.timeline("speed.vdb"))
    rows = [brume(comparison, "{}x{}".format(*options.speed_size))]
    rows += [cycles(comparison, scene, step_rate) for step_rate in options.speed_step_rate or [1]]
    for row in rows:
        row["ratio"] = row["cost"] / rows[0]["cost"]
        comparison.say(f"{row['renderer']}: {row['cpu']:.1f} CPU s, error {row['error']:.2f} %, mean "
                       f"{row['mean']:.5f}, {row['ratio']:.2f} times Brume's time at equal error")
    return {"edge": options.speed_edge, "size": options.speed_size, "repeat": options.repeat, "rows": rows}
