"""Bars as SVG: medians, with a line from the least to the largest value."""
import math

from text import escaped, number, shortened

WIDE, BARS, ROW, LABEL, GAP = 400, 296, 15, 17, 9  # of the drawing, its longest bar, and a case's rows
LOGARITHMIC_FROM = 30  # largest median by least


class Scale:
    """From values to places along the bars. Linear from 0, or logarithmic where medians differ too much."""

    def __init__(self, measurements):
        medians = [m.median for m in measurements]
        # A line to a single late value may leave the drawing; it may not make all bars short.
        self.high = max(max(min(m.max, 1.5 * m.median) for m in measurements), 1e-30)
        self.is_logarithmic = min(medians) > 0 and max(medians) > LOGARITHMIC_FROM * min(medians)
        self.low = 10.0 ** math.floor(math.log10(min(medians)) - 0.1) if self.is_logarithmic else 0

    def place(self, value):
        if self.is_logarithmic:
            part = math.log(max(value, self.low) / self.low) / math.log(self.high / self.low)
        else:
            part = value / self.high
        return BARS * min(max(part, 0), 1)

    def ticks(self):
        if self.is_logarithmic:
            powers = range(math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9) + 1)
            step = math.ceil(len(powers) / 6)
            return [10.0 ** power for power in powers[::step]]
        power = 10.0 ** math.floor(math.log10(self.high / 2))
        step = next(factor * power for factor in (5, 2, 1) if 2 * factor * power <= self.high * 1.0001)
        return [i * step for i in range(int(self.high / step * 1.0001) + 1)]


def spread(m, scale, y):
    """The line from least to largest, with ends; an arrow where it leaves the drawing."""
    left, right = scale.place(m.min), scale.place(m.max)
    out = [f'<path class="spread" d="M{left:.1f} {y - 3}v6M{left:.1f} {y}H{right:.1f}']
    out.append(f'm-4 -3l4 3l-4 3"/>' if m.max > scale.high * 1.0001 else f'm0 -3v6"/>')
    return "".join(out)


def bar(m, series, scale, y):
    value = f"{number(m.median)} {m.unit}"
    tip = f"{m.name}: median {value}, {number(m.min)} to {number(m.max)}, {m.repetitions} repetitions"
    return (f'<g><title>{escaped(tip)}</title>'
            f'<rect class="s{series}" y="{y + 1}" width="{max(scale.place(m.median), 1):.1f}" height="{ROW - 4}"'
            ' rx="2"/>'
            f'{spread(m, scale, y + ROW / 2 - 1)}'
            f'<text class="value" x="{WIDE}" y="{y + ROW - 4}" text-anchor="end">{escaped(shortened(value, 18))}</text>'
            '</g>')


def axis(scale, bottom):
    out = []
    for tick in scale.ticks():
        x = scale.place(tick)
        anchor = "start" if x < 8 else "middle"
        out.append(f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="0" y2="{bottom}"/>'
                   f'<text class="tick" x="{x:.1f}" y="{bottom + 13}" text-anchor="{anchor}">{number(tick)}</text>')
    return out


def plot(title, unit, rows, letters, name):
    """`rows`: (case, [(series, measurement)]); `letters` name the series in the alternative text; `name`: an id."""
    scale = Scale([m for _, bars in rows for _, m in bars])
    bottom = sum(LABEL + ROW * len(bars) + GAP for _, bars in rows)
    out, y, told = axis(scale, bottom), 0, []
    for case, bars in rows:
        out.append(f'<text class="case" y="{y + LABEL - 5}">{escaped(shortened(case, 56))}</text>')
        y += LABEL
        for series, m in bars:
            out.append(bar(m, series, scale, y))
            y += ROW
            machine = f" ({letters[series]})" if len(letters) > 1 else ""
            told.append(f"{case}{machine} {number(m.median)} {m.unit}")
        y += GAP
    kind = "logarithmic" if scale.is_logarithmic else "linear"
    return (f'<svg viewBox="0 0 {WIDE} {bottom + 18}" role="img" aria-labelledby="{name}-t {name}-d">'
            f'<title id="{name}-t">{escaped(title)}: medians in {escaped(unit)}, {kind} scale</title>'
            f'<desc id="{name}-d">{escaped("; ".join(told))}</desc>{"".join(out)}</svg>', scale.is_logarithmic)
