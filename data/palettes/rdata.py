"""Objects of installed R packages: their lazy-load databases, in the XDR form of R's serialize (R Internals, 1.8)."""
import gzip
import struct
import zlib

NULLS = (254, 253, 252, 251, 250, 242, 241)


class Reader:
    """Reads lists, vectors and their attributes; anything else raises ValueError."""

    def __init__(self, data):
        self.data, self.at, self.references = data, 2, []
        version = self.whole()
        self.at += 8
        if version == 3:
            length = self.whole()
            self.at += length

    def whole(self):
        self.at += 4
        return struct.unpack_from(">i", self.data, self.at - 4)[0]

    def vector(self, form, size):
        count = self.whole()
        self.at += count * size
        return list(struct.unpack_from(f">{count}{form}", self.data, self.at - count * size))

    def attributes(self):
        found, pair = {}, self.item()
        while pair:
            tag, value, pair = pair
            found[tag] = value
        return found

    def item(self):
        flags = self.whole()
        kind = flags & 255
        if kind in NULLS:
            return None
        if kind == 255:
            return self.references[(flags >> 8 or self.whole()) - 1]
        if kind == 1:  # a name
            self.references.append(self.item())
            return self.references[-1]
        if kind == 2:  # a pair of a linked list
            if flags >> 9 & 1:
                self.item()
            tag = self.item() if flags >> 10 & 1 else None
            return tag, self.item(), self.item()
        if kind == 9:
            length = self.whole()
            self.at += max(length, 0)
            return None if length < 0 else self.data[self.at - length:self.at].decode()
        if kind in (10, 13):
            value = self.vector("i", 4)
        elif kind == 14:
            value = self.vector("d", 8)
        elif kind in (16, 19):
            value = [self.item() for _ in range(self.whole())]
        else:
            raise ValueError(f"an object of type {kind}")
        attributes = self.attributes() if flags >> 9 & 1 else {}
        names = attributes.get("names")
        return dict(zip(names, value)) if names else value


def objects(base, names):
    """Objects of the database `base`.rdb by their names."""
    index = Reader(gzip.decompress(base.with_suffix(".rdx").read_bytes())).item()
    data = base.with_suffix(".rdb").read_bytes()
    found = {}
    for name in names:
        offset, length = index["variables"][name]
        found[name] = Reader(zlib.decompress(data[offset + 4:offset + length])).item()
    return found
