"""Grey pictures, arrays of rows from the top: reads and compares them, and shows what differs."""
import numpy

import images


def read_pfm(path):
    """A PFM file of one channel."""
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().strip() for _ in range(3))
        width, height = map(int, size.split())
        if kind != b"Pf" or float(scale) >= 0:
            raise ValueError(f"{path}: expected a little-endian PFM file of one channel")
        values = numpy.frombuffer(file.read(), "<f4", width * height)
    return values.reshape(height, width)[::-1].astype(numpy.float64)


def read_exr(path):
    """The mean of an OpenEXR file's R, G and B."""
    layers = images.read_exr(path)
    return (layers["R"] + layers["G"] + layers["B"]) / 3


def compare(picture, reference):
    """Differences in percent of the reference's mean over the pixels that the volume covers: `rmse` over all pixels,
    `mean` with its sign, and `largest`; `ratio`: the picture's sum by that of the reference."""
    if picture.shape != reference.shape:
        size, found = ("{}x{}".format(*one.shape[::-1]) for one in (reference, picture))
        raise ValueError(f"expected {size} pixels, found {found}")
    covered = reference > 0
    if not covered.any():
        raise ValueError("the reference is black")
    apart = (picture - reference) / (reference[covered].mean() / 100)
    return {"rmse": float(numpy.sqrt((apart**2).mean())), "mean": float(apart.mean()),
            "largest": float(abs(apart).max()), "ratio": float(picture.sum() / reference.sum())}


def offset(picture, reference):
    """By how much the picture lies beside the reference [pixels right, pixels down]: the least squares fit of its
    difference to the reference's slopes, and to its brightness. Meaningful below a pixel."""
    inner = reference[1:-1, 1:-1]
    right = (reference[1:-1, 2:] - reference[1:-1, :-2]) / 2
    down = (reference[2:, 1:-1] - reference[:-2, 1:-1]) / 2
    sloped = (right != 0) | (down != 0)
    columns = numpy.stack([part[sloped] for part in (right, down, inner)], axis=-1)
    fit = numpy.linalg.lstsq(columns, (picture[1:-1, 1:-1] - inner)[sloped], rcond=None)[0]
    # A picture moved to the right is darker where the reference rises to the right.
    return -float(fit[0]), -float(fit[1])


def shown(picture, white):
    """What an eye sees: radiance `white` is white."""
    return numpy.repeat(images.srgb(picture / white)[..., None], 3, axis=-1)


def difference(picture, reference, most):
    """White: equal; red: brighter than the reference by `most` or more; blue: darker."""
    apart = picture - reference
    faded = numpy.rint(255 * (1 - numpy.minimum(abs(apart) / most, 1)))
    full = numpy.full_like(faded, 255)
    brighter = apart > 0
    return numpy.stack([numpy.where(brighter, full, faded), faded, numpy.where(brighter, faded, full)],
                       axis=-1).astype(numpy.uint8)
