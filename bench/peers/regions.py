"""Means over parts of pictures, with their standard errors, and how two renderers differ there."""
import math

ACROSS, DOWN = 4, 3
MOST = 0.01  # relative difference that is allowed beside the noise
SIGMAS = 3
DARK = 0.02  # of the brightest part: what is less is listed and not judged


class Estimate:
    """Means of a picture's parts, rows from the top, and their standard errors."""

    def __init__(self, means, errors):
        self.means, self.errors = means, errors


def _parts(picture):
    """The pixels of each part."""
    height, width = picture.shape
    return [picture[row * height // DOWN:(row + 1) * height // DOWN,
                    column * width // ACROSS:(column + 1) * width // ACROSS]
            for row in range(DOWN) for column in range(ACROSS)]


def of_errors(picture, error):
    """`error` has the standard error of each pixel, independent of the others."""
    return Estimate([float(part.mean()) for part in _parts(picture)],
                    [math.sqrt((part**2).sum()) / part.size for part in _parts(error)])


def of_seeds(seen):
    """Pictures of several seeds; the spread of a part's means gives its error, as pixels share random numbers."""
    count, each = len(seen), [[float(part.mean()) for part in _parts(one)] for one in seen]
    means, errors = [], []
    for values in zip(*each):
        means.append(math.fsum(values) / count)
        errors.append(math.sqrt(math.fsum((value - means[-1]) ** 2 for value in values) / (count * (count - 1))))
    return Estimate(means, errors)


def compare(brume, cycles):
    """A row per part: relative difference of Brume from Cycles, its standard error, and whether it is allowed."""
    brightest, rows = max(cycles.means), []
    for i, (a, b) in enumerate(zip(brume.means, cycles.means)):
        row = {"column": i % ACROSS, "row": i // ACROSS, "brume": a, "brume_error": brume.errors[i], "cycles": b,
               "cycles_error": cycles.errors[i], "judged": b > DARK * brightest}
        if b > 0:
            row["difference"] = a / b - 1
            row["error"] = math.hypot(brume.errors[i], cycles.errors[i]) / b
            row["agrees"] = abs(row["difference"]) <= MOST + SIGMAS * row["error"]
        rows.append(row)
    return rows


def summary(rows):
    """The largest difference among judged parts, its error, that of the whole picture, and how many parts differ."""
    judged = [row for row in rows if row["judged"]]
    worst = max(judged, key=lambda row: abs(row["difference"]))
    whole = math.fsum(row["brume"] for row in rows) / math.fsum(row["cycles"] for row in rows) - 1
    return {"parts": len(judged), "off": sum(not row["agrees"] for row in judged), "largest": worst["difference"],
            "largest_error": worst["error"], "at": [worst["column"], worst["row"]], "whole": whole,
            "median_error": sorted(row["error"] for row in judged)[len(judged) // 2]}
