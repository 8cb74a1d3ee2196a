"""Textures of the flyby's courtyard: slabs, the landing pad, wall panels, corrugated steel."""
import numpy as np

from demo_textures import _rng, corrugated, dots, grid_px, level, mix, normal_image, smooth, spectral

REPEAT_M = {"slabs": 4.0, "pad": 6.0, "panels": 4.0, "corrugated": 1.6}
YELLOW, WHITE = np.array([.72, .54, .13]), np.array([.74, .73, .69])


def worn(rng, n, amount):
    """How much of the paint is left, 0..1."""
    return 1 - smooth(amount, amount + 0.5, spectral(rng, n, 1.5, 5, 120) + 0.5 * spectral(rng, n, 2.4, 2, 20))


def slabs(n=512):
    """Cast concrete slabs, 2 m a side, with open joints, stains, hairline cracks and tyre marks."""
    rng = _rng(301)
    x, y = grid_px(n)
    half = n / 2
    edge = np.minimum(np.minimum(x % half, half - x % half), np.minimum(y % half, half - y % half))
    joint = 1 - smooth(0.8, 2.0, edge + 0.25 * spectral(rng, n, 1.6, 20, 120))
    tone = rng.uniform(0.93, 1.06, (2, 2))[(y // half).astype(int), (x // half).astype(int)]
    mottle = spectral(rng, n, 2.4, 2, 90)
    grit = spectral(rng, n, 0.8, 40, 200)
    color = np.array([.600, .592, .570])[None, None] * (tone * (1 + 0.045 * mottle + 0.012 * grit))[..., None]
    stain = smooth(0.8, 2.4, spectral(rng, n, 2.5, 1, 40))
    color = mix(color, np.array([.43, .415, .39]), 0.42 * stain)
    color = color * (1 - 0.10 * (1 - smooth(2, 16, edge)))[..., None]
    field = spectral(rng, n, 3.4, 3, 60)
    crack = (1 - smooth(0.010, 0.035, abs(field))) * smooth(0.9, 1.6, spectral(rng, n, 2.4, 2, 8))
    color = color * (1 - 0.62 * joint - 0.40 * crack)[..., None]
    return {"color": color, "height": 0.0008 * mottle - 0.006 * joint - 0.0012 * crack}


def pad(n=512):
    """The painted top of the landing pad: a ring, a cross, corner marks and a rim of yellow and black."""
    rng = _rng(307)
    x, y = grid_px(n)
    m = REPEAT_M["pad"] / n
    px, py = (x - n / 2) * m, (y - n / 2) * m
    mottle, grit = spectral(rng, n, 2.4, 2, 90), spectral(rng, n, 0.8, 40, 200)
    color = np.array([.53, .53, .52])[None, None] * (1 + 0.05 * mottle + 0.012 * grit)[..., None]
    r = np.hypot(px, py)
    left = worn(rng, n, 1.05)
    soft = lambda d: 1 - smooth(-m, m, d)  # inside of a distance below 0, antialiased
    square = np.maximum(abs(px), abs(py))
    stripes = smooth(-0.02, 0.02, np.sin((px + py) * 2 * np.pi / 0.72) * 0.12)
    rim = soft(abs(square - 2.78) - 0.11)
    color = mix(color, mix(np.array([.075, .075, .08]), YELLOW, stripes), rim * (0.25 + 0.75 * left))
    ring = soft(abs(r - 1.95) - 0.085)
    inner = soft(abs(r - 0.62) - 0.045)
    arm = soft(np.maximum(abs(np.minimum(abs(px), abs(py))) - 0.045, abs(np.maximum(abs(px), abs(py)) - 1.27) - 0.42))
    corner = np.maximum(abs(abs(px) - 2.1), abs(abs(py) - 2.1)) - 0.30
    tick = soft(np.maximum(corner, np.minimum(abs(abs(px) - 2.32), abs(abs(py) - 2.32)) - 0.05))
    color = mix(color, WHITE, np.maximum(np.maximum(ring, inner), np.maximum(arm, tick)) * (0.15 + 0.85 * left))
    scorch = np.exp(-(r / 1.1) ** 2) * smooth(-1.5, 1.5, mottle)
    color = color * (1 - 0.10 * scorch)[..., None]
    cell = n / 3
    edge = np.minimum(np.minimum(x % cell, cell - x % cell), np.minimum(y % cell, cell - y % cell))
    joint = (1 - smooth(0.6, 1.6, edge)) * (square < 2.9)
    return {"color": color * (1 - 0.5 * joint)[..., None], "height": -0.005 * joint + 0.0005 * mottle}


def panels(n=256):
    """Wall panels of cast concrete, 2 x 1 m, with tie holes and streaks from the joints."""
    rng = _rng(311)
    x, y = grid_px(n)
    w, h = n / 2, n / 4
    edge = np.minimum(np.minimum(x % w, w - x % w), np.minimum(y % h, h - y % h))
    joint = 1 - smooth(0.5, 1.5, edge)
    tone = rng.uniform(0.92, 1.06, (4, 2))[(y // h).astype(int), (x // w).astype(int)]
    mottle = spectral(rng, n, 2.3, 2, 60)
    color = np.array([.640, .635, .620])[None, None] * (tone * (1 + 0.04 * mottle))[..., None]
    streak = spectral(rng, n, 1.9, 3, 100, (1.0, 9.0)) + 0.6 * spectral(rng, n, 2.6, 1, 10)
    color = mix(color, np.array([.45, .44, .42]), 0.36 * smooth(0.5, 2.6, streak))
    ties = [(w * i + w * fx, h * j + h * 0.5) for i in (0, 1) for j in range(4) for fx in (0.2, 0.8)]
    plug = 1 - smooth(0.7, 1.15, dots(n, ties, [2.2] * len(ties))[0])
    color = color * (1 - 0.45 * joint - 0.35 * plug)[..., None]
    return {"color": color, "height": 0.0008 * mottle - 0.008 * joint - 0.006 * plug}


def make_all():
    out = {}
    sheet = corrugated()
    grey = sheet["color"].mean(axis=2, keepdims=True)
    made = {"slabs": slabs(), "pad": pad(), "panels": panels(),
            "corrugated": {"color": 0.5 + 0.9 * (sheet["color"] * 0.5 + grey * 0.5), "height": sheet["height"]}}
    for name, maps in made.items():
        height = maps["height"]
        if height.shape[0] > 256:  # half the texels: seams need no more
            height = height.reshape(256, height.shape[0] // 256, 256, -1).mean(axis=(1, 3))
        out[name] = {"color": level(maps["color"]), "normal": normal_image(height, REPEAT_M[name])}
    return out
