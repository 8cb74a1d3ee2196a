"""Linear pictures: what a screen shows of them, and what differs."""
import numpy

import images

LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def averaged(values, times):
    """Means over squares of so many pixels."""
    height, width = values.shape[0] // times, values.shape[1] // times
    return values.reshape(height, times, width, times, *values.shape[2:]).mean(axis=(1, 3))


def _neutral(c):
    """Khronos PBR Neutral (shaders/shared/tone.h)."""
    x = c.min(axis=-1, keepdims=True)
    c = c - numpy.where(x < 0.08, x - 6.25 * x * x, 0.04)
    peak = c.max(axis=-1, keepdims=True)
    start, d = 0.76, 0.24
    new_peak = 1 - d * d / (numpy.maximum(peak, start) + d - start)
    bleach = 1 - 1 / (0.15 * (peak - new_peak) + 1)
    scaled = c * (new_peak / numpy.maximum(peak, 1e-9))
    return numpy.where(peak < start, c, scaled + (new_peak - scaled) * bleach)


def shown(linear, exposure, tone):
    """What a screen shows: 8 bits, without dither."""
    c = linear * 2.0**exposure
    return images.srgb(_neutral(c) if tone == "neutral" else c)


def signed_map(test, reference, exposure):
    """Differences of luminance at the exposure: red where `test` is brighter, blue where it is darker; full at 0.5."""
    d = ((test - reference) @ LUMINANCE) * 2.0**exposure / 0.5
    d = numpy.clip(d, -1, 1)[..., None]
    red, blue = numpy.array([1.0, 0.25, 0.1]), numpy.array([0.15, 0.45, 1.0])
    return numpy.rint(255 * (numpy.sqrt(numpy.maximum(d, 0)) * red + numpy.sqrt(numpy.maximum(-d, 0)) * blue)
                      ).astype(numpy.uint8)


def bias(test, reference, error, where):
    """Relative difference of the means of luminance over some pixels, and its standard error; None: no pixels."""
    if not where.any():
        return None, None
    truth = (reference @ LUMINANCE)[where]
    mean = truth.mean()
    uncertain = numpy.sqrt((error[where]**2).sum()) / truth.size / mean
    return float((test @ LUMINANCE)[where].mean() / mean - 1), float(uncertain)


def noisy(reference, error, seed=1):
    """The reference with as much more noise as it has."""
    luminance = reference @ LUMINANCE
    offset = numpy.random.default_rng(seed).standard_normal(error.shape) * error
    return reference * numpy.maximum(1 + offset / numpy.maximum(luminance, 1e-9), 0)[..., None]
