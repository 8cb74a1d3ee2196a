"""Renders a scene in real time and by the path tracer, and finds how far they differ."""
import json
import subprocess
import sys

import numpy

import images
import pictures
import scenes

TIMES = 4  # width and height of real-time pictures before they are averaged
MEDIA_BELOW = 0.9  # transmittance of a pixel that counts as one with media

# What --check renders: scene, mode; small, and with so many samples of the path tracer.
KEPT = (("one_light", "full"), ("one_light", "single"), ("cloud", "full"))
KEPT_SIZE, KEPT_SAMPLES, KEPT_FOLDER = (60, 40), 2048, scenes.FOLDER / "kept"
FIGURES = scenes.FOLDER.parent.parent / "docs/fidelity.json"
# A random step of 255 in two thirds of all values moves the figures by at most 0.42 dB and 0.0044. Means of 16 pixels
# differ by less from device to device. 0.9 times the multiple scattering moves the cloud by 0.46 dB.
MOST_PSNR_CHANGE, MOST_FLIP_CHANGE = 0.3, 0.004


class Studio:
    """Where and with what pictures are rendered."""

    def __init__(self, brume, folder, size, samples):
        self.brume, self.folder, self.size, self.samples = brume, folder, size, samples
        self.pictures = {}
        self.seconds = {name: seconds for name, _, seconds in scenes.SCENES}

    def call(self, *words):
        done = subprocess.run([str(self.brume), *(str(word) for word in words)], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            line = " ".join(map(str, words))
            sys.exit(f"script/fidelity: brume {line} ended with code {done.returncode}: {done.stderr}")
        return done.stdout

    def bake(self, name):
        if name in scenes.VOLUMES and not (self.folder / scenes.VOLUMES[name][0]).exists():
            file, how = scenes.VOLUMES[name]
            self.call("bake", *how, "-o", file, "-q")

    def timeline(self, name, stem, edits, paint):
        self.bake(name)
        text = scenes.timeline(name, self.folder, edits)
        if paint is not None:
            text = scenes.edited(text, "", "scene", f'"{scenes.painted(name, self.folder, paint)}"')
        (self.folder / f"{stem}.toml").write_text(text)
        return f"{stem}.toml"

    def realtime(self, name, stem, edits=(), paint=None, more=()):
        """Linear radiance and transmittance."""
        file, (width, height) = f"{stem}_realtime.exr", self.size
        self.call("render", self.timeline(name, stem, edits, paint), "-o", file, "--size",
                  f"{TIMES * width}x{TIMES * height}", "--time", self.seconds[name], "--background", "in", "-q", *more)
        layers = images.read_exr(self.folder / file)
        return (pictures.averaged(images.radiance(layers), TIMES), pictures.averaged(layers["transmittance.V"], TIMES))

    def reference(self, name, stem, edits=(), paint=None, more=()):
        """Linear radiance and its standard error."""
        file, (width, height) = f"{stem}_reference.exr", self.size
        self.call("render", self.timeline(name, stem, edits, paint), "-o", file, "--size", f"{width}x{height}",
                  "--time", self.seconds[name], "--background", "in", "-q", "--mode", "reference", "--samples",
                  self.samples, *more)
        layers = images.read_exr(self.folder / file)
        return images.radiance(layers), layers["error.V"]

    def pair(self, name, mode, edits=(), paint=None):
        """Tables named `realtime ...` in edits are of the real-time picture alone."""
        stem, single = f"{name}_{mode}", mode.startswith("single")
        of_realtime = [(table.removeprefix("realtime "), key, value) for table, key, value in edits]
        of_both = [edit for edit in edits if not edit[0].startswith("realtime ")]
        test = self.realtime(name, stem, (*(scenes.SINGLE if single else ()), *of_realtime), paint)
        return test, self.reference(name, stem, of_both, paint, ("--max-bounces", 1) if single else ())

    def difference(self, stem, test, truth, settings):
        """PSNR and FLIP of what a screen shows."""
        for kind, picture in (("realtime", test), ("reference", truth)):
            images.write_png(self.folder / f"{stem}_{kind}.png", pictures.shown(picture, *settings))
        return json.loads(self.call("diff", f"{stem}_reference.png", f"{stem}_realtime.png", "-o", f"{stem}_flip.png",
                                    "--json", "-", "-q"))

    def figures(self, stem, test, transmittance, truth, error, settings):
        metrics = self.difference(stem, test, truth, settings)
        media = transmittance < MEDIA_BELOW
        everywhere = numpy.ones(media.shape, bool)
        bias, bias_error = pictures.bias(test, truth, error, everywhere)
        media_bias, media_error = pictures.bias(test, truth, error, media)
        own = self.difference(f"{stem}_noise", pictures.noisy(truth, error), truth, settings)["psnr"]
        found = {"samples": self.samples, "psnr": metrics["psnr"], "flip": metrics["flip"], "bias": bias,
                 "bias_error": bias_error, "media_bias": media_bias, "media_bias_error": media_error,
                 "media": float(media.mean()), "reference_psnr": own}
        return {key: None if value is None else round(value, 4) for key, value in found.items()}

    def compare(self, name, mode, edits=(), paint=None):
        """The figures of a scene; its picture goes into the folder."""
        (test, transmittance), (truth, error) = self.pair(name, mode, edits, paint)
        settings, stem = scenes.look(name, edits), f"{name}_{mode}"
        self.pictures[stem] = numpy.concatenate(
            [pictures.shown(test, *settings), pictures.shown(truth, *settings),
             pictures.signed_map(test, truth, settings[0])], axis=1)
        images.write_png(self.folder / f"{stem}.png", self.pictures[stem])
        found = self.figures(stem, test, transmittance, truth, error, settings)
        print(f"fidelity: {stem}: {found}", file=sys.stderr, flush=True)
        return found

    def contact(self, name):
        """The picture of a scene on the page: full transport above single scattering."""
        images.write_palette_png(self.folder / f"{name}.png", numpy.concatenate(
            [self.pictures[f"{name}_full"], self.pictures[f"{name}_single"]]))


def check(studio, keep):
    """Compares pictures with the kept ones, and their figures with the kept figures; 1: they moved."""
    studio.size, studio.samples = KEPT_SIZE, KEPT_SAMPLES
    kept, moved = json.loads(FIGURES.read_text()), 0
    for name, mode in KEPT:
        stem = f"{name}_{mode}"
        edits, settings = scenes.SINGLE if mode == "single" else (), scenes.look(name)
        test, _ = studio.realtime(name, stem, edits)
        images.write_png(studio.folder / f"{stem}.png", pictures.shown(test, *settings))
        if keep:
            KEPT_FOLDER.mkdir(exist_ok=True)
            truth, _ = studio.reference(name, stem, more=("--max-bounces", 1) if mode == "single" else ())
            images.write_png(KEPT_FOLDER / f"{stem}.png", pictures.shown(truth, *settings))
        metrics = json.loads(studio.call("diff", KEPT_FOLDER / f"{stem}.png", f"{stem}.png", "--json", "-", "-q"))
        if keep:
            kept.setdefault("check", {})[stem] = {key: round(metrics[key], 4) for key in ("psnr", "flip")}
            continue
        before = kept["check"][stem]
        psnr, flip = metrics["psnr"] - before["psnr"], metrics["flip"] - before["flip"]
        print(f"{stem}: PSNR {metrics['psnr']:.2f} dB ({psnr:+.2f}), FLIP {metrics['flip']:.4f} ({flip:+.4f})")
        if abs(psnr) > MOST_PSNR_CHANGE or abs(flip) > MOST_FLIP_CHANGE:
            moved = 1
            print(f"script/fidelity: {stem} moved; if it should, run script/fidelity, then script/fidelity --keep",
                  file=sys.stderr)
    if keep:
        FIGURES.write_text(json.dumps(kept, indent=1) + "\n")
    return moved
