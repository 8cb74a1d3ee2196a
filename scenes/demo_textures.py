"""The demo's textures: seamless colour and normal maps, all from seeded noise and a little masonry.

Each maker returns {"color": (n, n, 3) sRGB in 0..1, "height": (n, n) metres, "rough": (n, n) or absent} for a square
of `SIZE_M` metres a side. Row 0 is the top of the image. Everything wraps around, so every texture tiles.
"""
import numpy as np

SIZE_M = 2.0  # what one repeat covers; geometry maps its UVs by the same figure


def _rng(seed):
    return np.random.Generator(np.random.PCG64(seed))


def spectral(rng, n, beta, low=1.0, high=1e9, stretch=(1.0, 1.0)):
    """Seamless noise of mean 0 and deviation 1 with spectrum 1/f^beta; `stretch` lengthens features along x, y."""
    fy = np.fft.fftfreq(n)[:, None] * n * stretch[1]
    fx = np.fft.fftfreq(n)[None, :] * n * stretch[0]
    f = np.hypot(fx, fy)
    weight = np.where((f >= low) & (f <= high), np.maximum(f, 1e-6) ** (-beta / 2), 0.0)
    out = np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, n))) * weight).real
    return (out - out.mean()) / out.std()


def blur(image, sigma):
    n = image.shape[0]
    f = np.fft.fftfreq(n)
    kernel = np.exp(-2 * (np.pi * sigma) ** 2 * (f[:, None] ** 2 + f[None, :] ** 2))
    return np.fft.ifft2(np.fft.fft2(image) * kernel).real


def smooth(lo, hi, x):
    t = np.clip((x - lo) / (hi - lo), 0, 1)
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.ndim == 1 and np.ndim(t) == 2:
        a = a[None, None, :]
    if b.ndim == 1 and np.ndim(t) == 2:
        b = b[None, None, :]
    t = t[..., None] if max(a.ndim, b.ndim) == 3 and np.ndim(t) == 2 else t
    return a * (1 - t) + b * t


def grid_px(n):
    return np.meshgrid(np.arange(n) + 0.5, np.arange(n) + 0.5)


def dots(n, centers, radii):
    """Distance to the nearest of a few wrapped circles, in radii: below 1 is inside. Also the index of the nearest."""
    at = np.arange(n) + 0.5
    best = np.full((n, n), 1e9)
    which = np.zeros((n, n), int)
    for i, ((cx, cy), r) in enumerate(zip(centers, radii)):
        dx, dy = ((at - c + n / 2) % n - n / 2 for c in (cx, cy))
        d = np.hypot(dx, dy[:, None]) / r
        which = np.where(d < best, i, which)
        best = np.minimum(best, d)
    return best, which


def cells(rng, n, count, jitter=0.8):
    """Seamless Worley noise on a jittered count x count lattice: nearest and second distance in cells, and the id."""
    px, py = rng.random((2, count, count)) * jitter + (1 - jitter) / 2
    x, y = grid_px(n)
    x, y = x * count / n, y * count / n
    ix, iy = np.floor(x).astype(int), np.floor(y).astype(int)
    first, second = np.full((n, n), 9.0), np.full((n, n), 9.0)
    ident = np.zeros((n, n), int)
    for oy in (-1, 0, 1):
        for ox in (-1, 0, 1):
            cx, cy = (ix + ox) % count, (iy + oy) % count
            d = np.hypot(ix + ox + px[cy, cx] - x, iy + oy + py[cy, cx] - y)
            nearer = d < first
            second = np.where(nearer, first, np.minimum(second, d))
            ident = np.where(nearer, cy * count + cx, ident)
            first = np.where(nearer, d, first)
    return first, second, ident


def brick(n=512):
    """Running bond: 8 bricks by 26 courses of 225 x 75 mm with joints of about 10 mm."""
    rng = _rng(11)
    cols, rows = 8, 26
    x, y = grid_px(n)
    wobble = spectral(rng, n, 2.6, 4) * 0.7
    yy = ((y + wobble) * rows / n) % rows
    row = np.floor(yy).astype(int) % rows
    shift = (row % 2) * 0.5 + (rng.random(rows)[row] - 0.5) * 0.10
    xx = ((x + spectral(rng, n, 2.6, 4) * 0.7) * cols / n + shift) % cols
    col = np.floor(xx).astype(int) % cols
    fx, fy = xx - np.floor(xx), yy - np.floor(yy)
    dx, dy = np.minimum(fx, 1 - fx) * n / cols, np.minimum(fy, 1 - fy) * n / rows
    corner = 4.0  # rounded corners, px
    qx, qy = np.maximum(corner - dx, 0), np.maximum(corner - dy, 0)
    edge = np.where((qx > 0) & (qy > 0), corner - np.hypot(qx, qy), np.minimum(dx, dy))
    worn = edge + spectral(rng, n, 1.6, 10) * 0.55 - 0.9 * smooth(0.8, 2.2, spectral(rng, n, 1.8, 6))
    inside = smooth(0.9, 2.1, worn)
    per = lambda lo=0.0, hi=1.0: (lo + (hi - lo) * rng.random((rows, cols)))[row, col]
    palette = np.array([[.50, .24, .17], [.57, .30, .20], [.43, .20, .16], [.62, .36, .24], [.34, .18, .17],
                        [.55, .27, .17], [.47, .27, .21]])
    pick = rng.integers(0, len(palette), (rows, cols))[row, col]
    base = palette[pick] * per(0.84, 1.12)[..., None]
    grain = spectral(rng, n, 0.9, 20, 180)
    blotch = spectral(rng, n, 2.2, 5)
    base = base * (1 + 0.055 * grain + 0.07 * blotch)[..., None]
    burnt = smooth(0.80, 0.92, per()) * smooth(-0.5, 1.0, spectral(rng, n, 2.0, 5))
    base = mix(base, np.array([.19, .14, .15]), 0.7 * burnt)
    dust = smooth(1.0, 2.4, spectral(rng, n, 2.4, 3) + 0.25 * grain)
    base = mix(base, np.array([.66, .60, .54]), 0.38 * dust)
    mortar = np.array([.47, .44, .40])[None, None] * (1 + 0.06 * spectral(rng, n, 0.8, 16) +
                                                      0.10 * spectral(rng, n, 2.2, 3))[..., None]
    color = mix(mortar, base, inside)
    color = color * (1 - 0.30 * (1 - smooth(0.0, 2.2, worn)) * inside)[..., None]
    color = color * (1 + 0.07 * spectral(rng, n, 2.6, 1, 12))[..., None]
    round_edge = smooth(0.4, 4.5, worn)
    tilt = (per(-1, 1) * (fx - 0.5) + per(-1, 1) * (fy - 0.5) * 0.5) * 0.0016
    height = inside * (0.0045 * round_edge + per(-0.0012, 0.0012) + tilt + 0.00035 * grain) + \
        (1 - inside) * 0.0003 * spectral(rng, n, 1.0, 12)
    pits = smooth(1.7, 2.3, spectral(rng, n, 0.8, 24, 90))
    return {"color": color * (1 - 0.25 * pits * inside)[..., None], "height": height - 0.0012 * pits * inside}


def plaster(n=512):
    """Old painted render: trowel marks, water streaks, hairline cracks, and flakes down to the grey coat."""
    rng = _rng(23)
    sweeps = np.zeros((n, n))
    for stretch in ((3.2, 1.0), (1.0, 2.2), (2.0, 2.0)):
        sweeps += spectral(rng, n, 2.6, 3, 120, stretch)
    sweeps /= sweeps.std()
    ridge = 1 - np.abs(spectral(rng, n, 3.2, 2, 40))
    grit = spectral(rng, n, 0.9, 30, 200)
    paint = np.array([.70, .665, .575])
    color = paint[None, None] * (1 + 0.035 * sweeps + 0.010 * grit)[..., None]
    tone = spectral(rng, n, 2.8, 1, 20)
    color = mix(color, color * np.array([.90, .95, .93]), smooth(-1.0, 1.5, tone))
    streak = spectral(rng, n, 1.8, 4, 200, (1.0, 14.0)) + 0.8 * spectral(rng, n, 2.6, 1, 12)
    color = mix(color, np.array([.43, .38, .30]), 0.34 * smooth(0.6, 3.0, streak))
    rust = smooth(1.9, 3.0, spectral(rng, n, 2.0, 3, 120, (1.0, 6.0)) + 0.4 * tone)
    color = mix(color, np.array([.45, .28, .17]), 0.45 * rust)
    crack_field = spectral(rng, n, 3.7, 3, 70)
    crack = (1 - smooth(0.012, 0.040, np.abs(crack_field))) * smooth(0.7, 1.5, spectral(rng, n, 2.4, 2, 8))
    flake_field = spectral(rng, n, 2.6, 3, 90)
    flake = smooth(2.55, 2.63, flake_field + 0.06 * grit)
    rim = smooth(2.45, 2.55, flake_field) * (1 - flake)
    under = np.array([.46, .44, .41])[None, None] * (1 + 0.05 * spectral(rng, n, 1.0, 12))[..., None]
    color = mix(color, under, flake)
    color = color * (1 - 0.50 * crack - 0.12 * rim)[..., None]
    height = 0.0010 * sweeps + 0.0008 * ridge + 0.00012 * grit - 0.0014 * flake - 0.0012 * crack
    return {"color": color, "height": height}


def planks(n=512):
    """Ten weathered boards of 0.2 m along u, with butt joints, grain, knots, gaps and nails."""
    rng = _rng(37)
    boards = 10
    x, y = grid_px(n)
    width = n / boards
    board = np.floor(y / width).astype(int) % boards
    fy = y / width - np.floor(y / width)
    joint = ((np.arange(boards) * 0.382 + rng.random(boards) * 0.12) % 1 * n)[board]
    slide = rng.integers(0, n, boards)[board]
    take = lambda image: image[y.astype(int), (x.astype(int) + slide) % n]
    warp = take(spectral(rng, n, 3.0, 1, 16, (5.0, 1.0)))
    knots = np.zeros((n, n))
    bend = np.zeros((n, n))
    for b in range(boards):
        for _ in range(rng.integers(1, 3)):
            cx, cy = rng.random() * n, (b + 0.25 + 0.5 * rng.random()) * width
            dx = (x - cx + n / 2) % n - n / 2
            d = np.hypot(dx / 2.2, y - cy)
            own = board == b
            r = 2.2 + 2.6 * rng.random()
            knots = np.where(own, np.maximum(knots, 1 - smooth(r * 0.5, r * 1.5, d)), knots)
            bend += np.where(own, np.sign(y - cy) * 7 * np.exp(-(dx / 22) ** 2) * np.exp(-((y - cy) / 14) ** 2), 0)
    rings = np.sin((fy * width - bend) * 0.62 + 2.6 * warp + rng.random(boards)[board] * 20)
    fibre = take(spectral(rng, n, 1.2, 8, 240, (22.0, 1.0)))
    thread = take(spectral(rng, n, 0.6, 30, 250, (14.0, 1.0)))
    split = smooth(2.3, 2.7, take(spectral(rng, n, 1.0, 8, 200, (26.0, 1.0))))
    grain = 0.55 * rings + 0.6 * fibre + 0.5 * thread
    tone = np.array([[.42, .29, .19], [.36, .25, .17], [.47, .34, .23], [.39, .29, .21], [.33, .24, .18]])
    base = tone[(np.arange(boards) * 3 + rng.integers(0, 2, boards)) % len(tone)][board]
    color = base * (1 + 0.10 * grain)[..., None]
    color = mix(color, np.array([.42, .39, .35]), 0.45 * smooth(0.0, 2.0, spectral(rng, n, 2.4, 1, 40, (3.0, 1.0))))
    color = mix(color, np.array([.16, .10, .07]), 0.85 * knots) * (1 - 0.6 * split)[..., None]
    across = np.minimum(fy, 1 - fy) * width + 0.35 * spectral(rng, n, 1.8, 6, 120, (3.0, 1.0))
    along = np.abs((x - joint + n / 2) % n - n / 2)
    gap = np.minimum(across, along + 0.3)
    seam = 1 - smooth(0.7, 1.7, gap)
    color = color * (1 - 0.86 * seam)[..., None] * (0.80 + 0.20 * smooth(1.0, 5.0, gap))[..., None]
    ends = joint[(np.arange(boards) * width).astype(int) + 2, 0]
    centers = [((end + side) % n, (b + f) * width) for b, end in enumerate(ends) for side in (-7.5, 7.5)
               for f in (0.24, 0.76)]
    nail, _ = dots(n, centers, [2.1] * len(centers))
    head = 1 - smooth(0.75, 1.1, nail)
    color = mix(color, np.array([.13, .11, .10]), head)
    bleed, _ = dots(n, centers, [6.0] * len(centers))
    color = mix(color, np.array([.17, .11, .08]), 0.5 * (1 - smooth(0.2, 1.0, bleed)) * (1 - head))
    cup = 0.0012 * (1 - (2 * fy - 1) ** 2) + rng.uniform(-0.0008, 0.0008, boards)[board]
    height = cup + 0.00038 * grain - 0.0045 * seam - 0.0006 * knots - 0.0012 * split + 0.0010 * head
    return {"color": color, "height": height}


def tiles(n=512):
    """Glazed 0.25 m tiles, cream and petrol in a check, some replaced, chipped or cracked; dirty grout."""
    rng = _rng(41)
    count = 8
    x, y = grid_px(n)
    size = n / count
    col, row = np.floor(x / size).astype(int), np.floor(y / size).astype(int)
    fx, fy = x / size - col, y / size - row
    per = lambda lo, hi: rng.uniform(lo, hi, (count, count))[row, col]
    grit = spectral(rng, n, 1.2, 12)
    edge = np.minimum(np.minimum(fx, 1 - fx), np.minimum(fy, 1 - fy)) * size + 0.3 * grit
    edge = edge - 5 * smooth(2.0, 2.6, spectral(rng, n, 1.9, 6, 80)) * (1 - smooth(2, 8, edge))
    inside = smooth(1.3, 2.3, edge)
    cream, petrol = np.array([.74, .70, .60]), np.array([.17, .30, .31])
    check = (row + col) % 2 == 0
    base = np.where(check[..., None], cream, petrol) * per(0.88, 1.09)[..., None]
    swirl = spectral(rng, n, 2.6, 4, 90)
    base = base * (1 + 0.05 * swirl)[..., None]
    odd = per(0, 1) > 0.95
    base = np.where(odd[..., None], base * np.array([.86, .80, .70]), base)
    field = spectral(rng, n, 3.6, 5, 80)
    cracked = per(0, 1) > 0.88
    crack = (1 - smooth(0.03, 0.08, np.abs(field))) * cracked * inside
    dirt = smooth(0.2, 2.2, spectral(rng, n, 2.4, 1, 60)) * 0.34 + 0.25 * (1 - smooth(2, 9, edge))
    color = mix(base, np.array([.27, .23, .18]), np.clip(dirt, 0, 1))
    grout = np.array([.30, .28, .25])[None, None] * (1 + 0.12 * grit)[..., None]
    color = mix(grout, color, inside) * (1 - 0.55 * crack)[..., None]
    tilt = per(-1, 1) * (fx - 0.5) + per(-1, 1) * (fy - 0.5)
    height = inside * (0.0022 * smooth(1.0, 5.0, edge) + 0.0011 * tilt + 0.00010 * swirl) - 0.0006 * crack + \
        (1 - inside) * 0.0002 * grit
    rough = np.clip(mix(np.full((n, n), 0.85), 0.26 + 0.5 * dirt, inside), 0, 1)
    return {"color": color, "height": height, "rough": rough}


def concrete(n=512):
    """Cast concrete from 1 m form panels: seams, tie holes, air pits, mottling and water stains."""
    rng = _rng(53)
    x, y = grid_px(n)
    half = n / 2
    col, row = np.floor(x / half).astype(int) % 2, np.floor(y / half).astype(int) % 2
    px, py = x % half, y % half
    seam_dist = np.minimum(np.minimum(px, half - px), np.minimum(py, half - py)) + 0.5 * spectral(rng, n, 2.0, 6, 80)
    seam = 1 - smooth(0.5, 2.0, seam_dist)
    mottle = spectral(rng, n, 2.3, 2, 120)
    grit = spectral(rng, n, 0.7, 40, 220)
    per = rng.uniform(0.92, 1.07, (2, 2))[row, col]
    color = np.array([.475, .465, .445])[None, None] * (per * (1 + 0.075 * mottle + 0.022 * grit))[..., None]
    streak = spectral(rng, n, 1.9, 3, 160, (1.0, 10.0)) + 0.7 * spectral(rng, n, 2.6, 1, 10)
    color = mix(color, np.array([.26, .25, .24]), 0.45 * smooth(0.5, 2.6, streak))
    lime = smooth(1.5, 2.8, spectral(rng, n, 2.2, 2, 90, (1.0, 3.0)))
    color = mix(color, np.array([.63, .62, .58]), 0.45 * lime)
    count = 240
    radii = 0.8 + 2.2 * rng.random(count) ** 4 + 0.25
    pit, _ = dots(n, rng.random((count, 2)) * n, radii)
    hole = 1 - smooth(0.55, 1.1, pit)
    ties = [(cx * half + half * fx, cy * half + half * fy) for cx in (0, 1) for cy in (0, 1) for fx in (0.22, 0.78)
            for fy in (0.25, 0.75)]
    tie, _ = dots(n, ties, [5.2] * len(ties))
    plug = 1 - smooth(0.82, 1.05, tie)
    color = color * (1 - 0.42 * hole - 0.38 * plug - 0.40 * seam)[..., None]
    height = 0.0006 * mottle + 0.00016 * grit - 0.0020 * hole - 0.0035 * plug - 0.0022 * seam + \
        0.0010 * (rng.random((2, 2))[row, col] - 0.5)
    return {"color": color, "height": height}


def shingles(n=256):
    """Slate shingles, 16 courses, lower edge standing proud."""
    rng = _rng(61)
    rows, cols = 16, 12
    x, y = grid_px(n)
    yy = (y + spectral(rng, n, 2.4, 3) * 0.4) * rows / n % rows
    row = np.floor(yy).astype(int) % rows
    xx = (x * cols / n + (row % 2) * 0.5 + (rng.random(rows)[row] - 0.5) * 0.3) % cols
    col = np.floor(xx).astype(int) % cols
    fx, fy = xx - np.floor(xx), yy - np.floor(yy)
    drop = rng.uniform(-0.10, 0.06, (rows, cols))[row, col]
    gap = 1 - smooth(0.3, 1.1, np.minimum(fx, 1 - fx) * n / cols)
    lip = smooth(0.86, 0.95, fy - drop * 0.5)
    tone = rng.uniform(0.70, 1.18, (rows, cols))[row, col]
    tint = np.array([[.20, .23, .27], [.25, .24, .27], [.19, .21, .22]])[rng.integers(0, 3, (rows, cols))[row, col]]
    grain = spectral(rng, n, 1.4, 10, 120, (1.0, 3.0))
    color = tint * (tone * (1 + 0.08 * grain))[..., None]
    moss = smooth(1.1, 2.2, spectral(rng, n, 2.2, 2, 60))
    color = mix(color, np.array([.21, .25, .15]), 0.6 * moss) * (1 - 0.55 * np.maximum(gap, lip))[..., None]
    return {"color": color, "height": 0.010 * fy * (1 - lip) - 0.004 * gap + 0.0004 * grain + 0.0015 * moss}


def corrugated(n=256):
    """Corrugated steel, 24 waves, ribs along v, with rust from the sheet joints."""
    rng = _rng(67)
    x, y = grid_px(n)
    wave = np.cos(2 * np.pi * x / n * 24)
    rust_field = spectral(rng, n, 2.2, 2, 120, (1.0, 3.5)) + 0.35 * spectral(rng, n, 1.0, 20)
    rust = smooth(0.6, 2.2, rust_field)
    color = np.array([.40, .43, .45])[None, None] * (1 + 0.05 * spectral(rng, n, 2.2, 2, 60, (1.0, 4.0)))[..., None]
    color = color * (0.90 + 0.10 * wave)[..., None]
    color = mix(color, np.array([.34, .19, .11])[None, None] * (1 + 0.12 * spectral(rng, n, 1.0, 10))[..., None], rust)
    lap = 1 - smooth(0.6, 1.8, np.abs((y - n * 0.5 + n / 2) % n - n / 2))
    return {"color": color * (1 - 0.5 * lap)[..., None], "height": 0.009 * wave - 0.002 * lap + 0.0003 * rust}


def ground(n=512):
    """Wet gravel yard with puddles. One repeat covers twice SIZE_M."""
    rng = _rng(71)
    first, second, ident = cells(rng, n, 72)
    fine, fine2, fine_id = cells(rng, n, 150)
    swell = spectral(rng, n, 2.8, 1, 30)
    big = smooth(0.02, 0.30, second - first)
    small = smooth(0.02, 0.35, fine2 - fine)
    bare = smooth(-0.3, 1.1, spectral(rng, n, 2.2, 2, 60))
    stone = mix(big, small * 0.55, bare)
    tone = mix(rng.uniform(0.60, 1.30, 72 * 72)[ident], rng.uniform(0.75, 1.2, 150 * 150)[fine_id], bare)
    color = np.array([.37, .345, .31])[None, None] * (tone * (0.45 + 0.55 * stone))[..., None]
    color = mix(color, np.array([.23, .20, .165]), 0.55 * bare)
    water = smooth(0.75, 1.05, -swell - 0.25 * bare + 0.10 * spectral(rng, n, 1.5, 8))
    damp = smooth(0.1, 0.9, -swell)
    color = color * (1 - 0.35 * damp)[..., None]
    color = mix(color, np.array([.075, .075, .08]), 0.8 * water)
    height = (0.006 * stone * mix(np.ones((n, n)), np.full((n, n), 0.45), bare) + 0.004 * swell) * (1 - water) + \
        0.00005 * spectral(rng, n, 2.0, 6, 60)
    rough = np.clip(0.9 - 0.3 * damp - 0.52 * water, 0.20, 1)
    return {"color": color, "height": height, "rough": rough}


def grass(n=256):
    rng = _rng(83)
    blades = spectral(rng, n, 0.9, 12, 120, (1.0, 2.5))
    clump = spectral(rng, n, 2.2, 2, 60)
    color = mix(np.array([.12, .16, .08]), np.array([.25, .28, .13]), smooth(-1.6, 1.8, 0.7 * blades + 0.7 * clump))
    color = mix(color, np.array([.22, .18, .12]), 0.6 * smooth(0.9, 2.0, -clump))
    return {"color": color, "height": 0.004 * blades + 0.006 * clump}


MAKERS = {"brick": brick, "plaster": plaster, "planks": planks, "tiles": tiles, "concrete": concrete,
          "shingles": shingles, "corrugated": corrugated, "ground": ground, "grass": grass}
REPEAT_M = {name: SIZE_M for name in MAKERS} | {"ground": 2 * SIZE_M, "grass": 2 * SIZE_M, "crate": SIZE_M / 2}


def normal_map(height, repeat_m):
    """The tangent-space normals of a wrapped height field in metres: x right, y up the image, z out."""
    texel = repeat_m / height.shape[0]
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * texel)
    down = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) / (2 * texel)
    n = np.stack([-dx, down, np.ones_like(dx)], axis=-1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def level(values):
    """0..1 as bytes in steps of 2/255, which keep PNG files small."""
    return (np.round(np.clip(values, 0, 1) * 127.5) * 2).clip(0, 255).astype(np.uint8)


def normal_image(height, repeat_m):
    return (128 + 2 * np.round(normal_map(height, repeat_m) * 63.5)).clip(0, 255).astype(np.uint8)


def make_all():
    """name -> {"color", "normal", optional "rough"} as RGB8 images."""
    out = {}
    for name, maker in MAKERS.items():
        made = maker()
        images = {"color": level(made["color"]), "normal": normal_image(made["height"], REPEAT_M[name])}
        if "rough" in made:
            rough = made["rough"].reshape(256, 2, 256, 2).mean(axis=(1, 3))
            g = level(rough)
            images["rough"] = np.stack([np.full_like(g, 255), g, np.zeros_like(g)], axis=-1)
        out[name] = images
    return out
