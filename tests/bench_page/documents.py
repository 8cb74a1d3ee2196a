"""What a page consists of, read without a browser; and sound and hostile results of brume bench."""
import copy
import html.parser
import re

VOID = {"meta", "link", "br", "img", "input", "hr"}
LOADING = {"src", "href", "srcset", "xlink:href", "action", "data", "poster", "background", "style"}


class Document(html.parser.HTMLParser):
    """Elements in order, as (tag, attributes, text below)."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.elements, self.open, self.unbalanced = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        element = [tag, dict(attrs), ""]
        self.elements.append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_startendtag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])

    def handle_endtag(self, tag):
        if not self.open or self.open[-1][0] != tag:
            self.unbalanced.append(tag)
        else:
            self.open.pop()

    def handle_data(self, data):
        for element in self.open:
            element[2] += data

    def all(self, tag, **attributes):
        return [e for e in self.elements if e[0] == tag and all(e[1].get(k) == v for k, v in attributes.items())]

    def texts(self, tag, **attributes):
        return [" ".join(e[2].split()) for e in self.all(tag, **attributes)]

    def loaded(self):
        """All that a browser would fetch or run: values of attributes, scripts and URLs in styles."""
        found = [f"{key}={value}" for _, attributes, _ in self.elements for key, value in attributes.items()
                 if (key in LOADING and value != "data:,") or key.startswith("on")]
        found += [tag for tag, _, _ in self.elements
                  if tag in ("script", "img", "iframe", "object", "embed", "base", "form", "use", "image", "video")]
        styles = "".join(self.texts("style"))
        return found + re.findall(r"url\(|@import", styles)


def measured(name, median, unit="ms", **more):
    return {"name": name, "median": median, "min": median / 2, "max": 2 * median, "unit": unit, "clock": "wall",
            "repetitions": 7, **more}


def sound(**more):
    return copy.deepcopy({"schema": 1, "command": "bench", "device": "NVIDIA H100", "driver": "1.2", "processor": "CPU",
                          "threads": 2, "commit": "abc", "skipped": [],
                          "results": [measured("march/1080p", 0.25), measured("fill/1800", 0.11)], **more})


def hostile(address):
    """Every text tries to leave its place and to fetch from `address`."""
    attack = (f"\"'><script src=\"{address}\"></script><img src={address}></title></style></svg>"
              f"<style>@import url({address})</style>&lt;&#60;\u202e\u0000\u200b\ud800 \u65e5\u672c \U0001f32b")
    one = measured(f"fill/{attack}", 1.5, unit=f"ms{attack}", details={attack: 3, "finite": None})
    one["clock"] = attack
    return sound(device=attack, driver=attack, processor=attack, commit=attack, results=[one],
                 skipped=[f"voxelize/motel: {attack}", attack])
