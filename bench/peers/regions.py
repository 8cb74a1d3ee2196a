"""Means over parts of pictures, with their standard errors, and how two renderers differ there."""
import math

import numpy

ACROSS, DOWN = 4, 3
MOST = 0.01  # relative difference that is allowed beside the noise
SIGMAS = 3
DARK = 0.02  # of the brightest part: what is less is listed and not judged


class Estimate:
    """The mean of a picture and those of its parts, rows from the top, and their standard errors."""

    def __init__(self, whole, parts):
        (self.whole, self.whole_error), (self.means, self.errors) = whole, zip(*parts)


def _parts(picture):
    """The pixels of each part."""
    height, width = picture.shape
    return [picture[row * height // DOWN:(row + 1) * height // DOWN,
                    column * width // ACROSS:(column + 1) * width // ACROSS]
            for row in range(DOWN) for column in range(ACROSS)]


def of_errors(picture, error):
    """`error` has the standard error of each pixel, independent of the others."""
    def mean(values, errors):
        return float(values.mean()), math.sqrt((errors**2).sum()) / errors.size
    return Estimate(mean(picture, error), list(map(mean, _parts(picture), _parts(error))))


def of_seeds(seen):
    """Pictures of several seeds; the spread of their means gives its error, as pixels share random numbers."""
    def mean(values):
        return float(numpy.mean(values)), float(numpy.std(values, ddof=1)) / math.sqrt(len(values))
    parts = zip(*([part.mean() for part in _parts(one)] for one in seen))
    return Estimate(mean([one.mean() for one in seen]), list(map(mean, parts)))


def _apart(a, a_error, b, b_error):
    """The relative difference of a from b, its standard error, and whether it is allowed."""
    difference, error = a / b - 1, math.hypot(a_error, b_error) / b
    return difference, error, abs(difference) <= MOST + SIGMAS * error


def compare(brume, cycles):
    """A row per part: relative difference of Brume from Cycles, its standard error, and whether it is allowed."""
    brightest, rows = max(cycles.means), []
    for i, (a, b) in enumerate(zip(brume.means, cycles.means)):
        row = {"column": i % ACROSS, "row": i // ACROSS, "brume": a, "brume_error": brume.errors[i], "cycles": b,
               "cycles_error": cycles.errors[i], "judged": b > DARK * brightest}
        if b > 0:
            row["difference"], row["error"], row["agrees"] = _apart(a, brume.errors[i], b, cycles.errors[i])
        rows.append(row)
    return rows


def summary(rows, brume, cycles):
    """The largest difference among judged parts, its error, how many parts differ, and the whole picture."""
    judged = [row for row in rows if row["judged"]]
    worst = max(judged, key=lambda row: abs(row["difference"]))
    whole, whole_error, agrees = _apart(brume.whole, brume.whole_error, cycles.whole, cycles.whole_error)
    off = sum(not row["agrees"] for row in judged)
    return {"parts": len(judged), "off": off, "agrees": agrees and off == 0, "largest": worst["difference"],
            "largest_error": worst["error"], "at": [worst["column"], worst["row"]], "whole": whole,
            "whole_error": whole_error, "median_error": sorted(row["error"] for row in judged)[len(judged) // 2]}
