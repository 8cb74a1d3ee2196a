"""Texts and numbers as they stand on the page. All that comes from a file goes through `escaped`."""
import html
import unicodedata


def escaped(text):
    """For elements and quoted attributes. What is invisible, or turns the direction of text, becomes U+FFFD."""
    return html.escape("".join(c if unicodedata.category(c)[0] != "C" else "\ufffd" for c in str(text)), quote=True)


def shortened(text, most):
    return text if len(text) <= most else text[:most - 1] + "\u2026"


def number(value):
    """Three digits, without an exponent where that stays short."""
    if value == 0:
        return "0"
    if value < 0:
        return "-" + number(-value)
    if value >= 1e15 or value < 1e-9:
        return f"{value:.2e}"
    if value >= 999.5:
        return f"{value:,.0f}"
    plain = f"{value:.3g}"
    return f"{value:.12f}".rstrip("0") if "e" in plain else plain
