"""Settings of timelines as src/scene/options.hpp states them, events as src/scene/event_fields.hpp does."""

from typing import NamedTuple


class Setting(NamedTuple):
    default: object  # None: none.
    low: float
    high: float
    unit: str
    about: str

    def clamped(self, value):
        return min(max(value, self.low), self.high)

    @property
    def description(self):
        """As Blender shows it."""
        return self.about[0].upper() + self.about[1:].replace("`", "")


class EventFields(NamedTuple):
    """A type of events."""

    points: tuple
    bytes: tuple  # Texts with the fewest and the most bytes.
    rules: tuple  # What must hold between two keys: its kind, and them.
    numbers: dict  # Settings.


# All below is written by BRUME_UPDATE=1 scene_tests --gtest_filter=*OfTheAddon.

SETTINGS = {
    "timeline": {
        "duration": Setting(4.0, 0.01, 3600, "s", "duration of the film"),
        "exposure": Setting(0.0, -20, 20, "EV", "radiance is multiplied by 2^exposure"),
    },
    "grid": {
        "voxel": Setting(0.25, 0.015625, 64, "m", "edge length of a voxel"),
        "size": Setting(None, 1, 4096, "voxels", "size of the grid"),
        "origin": Setting(None, -1e+06, 1e+06, "m", "low corner of the grid"),
    },
    "smoke": {
        "voxels": Setting(1800, 1, 16777216, "", "voxels that a grown smoke fills"),
        "bloom": Setting(1.0, 0.05, 60, "s", "time from going off to full size"),
        "hold": Setting(18.0, 0, 3600, "s", "time at full size"),
        "dissolve": Setting(3.0, 0.05, 60, "s", "time to dissolve"),
        "extinction": Setting(3.0, 0.01, 100, "1/m", "extinction at full density"),
        "albedo": Setting((0.92, 0.92, 0.92), 0, 1, "", "fraction of the lost light that is scattered"),
        "anisotropy": Setting(0.2, -0.99, 0.99, "", "Henyey-Greenstein g; above 0: forward scattering"),
        "droplet": Setting(None, 0.1, 50, "um", "droplet diameter; replaces `anisotropy`"),
        "multiple_scattering": Setting(1.0, 0, 1, "", "weight of multiple scattering; 0: single scattering only"),
        "erosion": Setting(0.5, 0, 1, "", "how deeply noise erodes the rim"),
        "noise_size": Setting(1.5, 0.05, 100, "m", "edge length of a noise cell"),
        "detail": Setting(1.0, 0, 1, "", "strength of noise finer than that, down to 2 cm; 0: none"),
        "swirl": Setting(0.2, 0, 10, "m", "how far the noise swirls around its place"),
        "swirl_period": Setting(12.0, 0.1, 3600, "s", "period of the swirl; the first turn is faster"),
        "rise": Setting(0.12, -10, 10, "m/s", "speed at which the noise rises"),
        "hole_rim": Setting(0.06, 0, 10, "m", "largest displacement of hole rims by noise"),
    },
    "volume": {
        "rotation": Setting((0.0, 0.0, 0.0), -360, 360, "degrees each", "rotation about x, then y, then z"),
        "scale": Setting(1.0, 1e-09, 1e+09, "", "metres per unit of the file"),
        "x_axis": Setting(
            (1.0, 0.0, 0.0), -1e+09, 1e+09, "", "where a step along the file's x leads, before `scale` and `rotation`"
        ),
        "y_axis": Setting((0.0, 1.0, 0.0), -1e+09, 1e+09, "", "the same for y"),
        "z_axis": Setting((0.0, 0.0, 1.0), -1e+09, 1e+09, "", "the same for z"),
        "extinction": Setting(1.0, 0, 1e+12, "1/m", "extinction where the density is 1"),
        "albedo": Setting((0.9, 0.9, 0.9), 0, 1, "", "fraction of the lost light that is scattered"),
        "anisotropy": Setting(0.2, -0.99, 0.99, "", "Henyey-Greenstein g; above 0: forward scattering"),
        "multiple_scattering": Setting(1.0, 0, 1, "", "weight of multiple scattering; 0: single scattering only"),
        "emission": Setting(1.0, 0, 1e+06, "", "brightness of what glows"),
        "kelvin": Setting(1000.0, 0, 1e+05, "K", "temperature where the heat is 1"),
        "frame_rate": Setting(24.0, 0.001, 1000, "1/s", "frames of a sequence a second"),
        "start": Setting(0.0, -3600, 3600, "s", "time of the first frame of a sequence"),
        "glow": Setting(0.0, 0, 1, "", "fraction of the colours that is emitted, unlit, instead of scattered"),
    },
    "camera": {
        "fov": Setting(60.0, 1, 170, "degrees", "vertical field of view"),
        "aperture": Setting(0.0, 0, 100, "m", "radius of the lens; 0: all is sharp"),
        "focus": Setting(0.0, 0, 1e+06, "m", "sharp distance along the view; 0: as far as the target"),
        "blades": Setting(0, 0, 64, "", "edges of the lens's opening; below 3: round"),
        "shutter": Setting(0.0, 0, 10, "s", "how long the shutter stays open, for motion blur"),
    },
}

EVENT_FIELDS = {
    "smoke": EventFields(
        ("from", "at"), (), (),
        {},
    ),
    "shot": EventFields(
        ("from", "toward"), (), (("differs", "toward", "from"), ("goes_with", "mask", "shape")),
        {
            "radius": Setting(0.25, 0.01, 10, "m", "radius of the hole; half the edge of a box or mask"),
            "reach": Setting(0.25, 0, 60, "s", "time until the front reaches the far end"),
            "expand": Setting(0.05, 0, 60, "s", "time to open, at each depth"),
            "stay": Setting(0.6, 0, 600, "s", "time fully open"),
            "fade": Setting(0.35, 0, 60, "s", "time to close"),
            "roll": Setting(0.0, -360, 360, "degrees", "rotates a box or mask clockwise as seen by the shooter"),
            "flash": Setting(25.0, 0, 1e+06, "W/sr", "intensity of the muzzle flash, 0.06 s long"),
        },
    ),
    "text": EventFields(
        ("from", "toward"), (("text", 1, 1024),), (("differs", "toward", "from"),),
        {
            "size": Setting(0.5, 0.02, 10, "m", "height of a capital letter"),
            "spacing": Setting(0.0, -0.5, 10, "", "extra space between letters, in heights of a capital"),
            "interval": Setting(0.0, 0, 10, "s", "time from letter to letter"),
            "reach": Setting(0.25, 0, 60, "s", "time until the front reaches the far end"),
            "expand": Setting(0.05, 0, 60, "s", "time to open, at each depth"),
            "stay": Setting(0.6, 0, 600, "s", "time fully open"),
            "fade": Setting(0.35, 0, 60, "s", "time to close"),
            "roll": Setting(0.0, -360, 360, "degrees", "rotates the row clockwise as seen by the shooter"),
        },
    ),
    "blast": EventFields(
        ("at",), (), (("at_least", "refill_middle", "refill_rim"),),
        {
            "radius": Setting(5.0, 0.1, 100, "m", "radius of the cavity"),
            "speed": Setting(32.0, 1, 10000, "m/s", "speed of the front"),
            "remaining": Setting(0.02, 0, 1, "", "fraction of the density that remains"),
            "refill_rim": Setting(0.5, 0.01, 60, "s", "time until the rim is full again"),
            "refill_middle": Setting(5.0, 0.01, 60, "s", "time until the middle is full again; at least `refill_rim`"),
            "flash": Setting(250.0, 0, 1e+06, "W/sr", "intensity of the fireball, 0.3 s long"),
        },
    ),
    "move": EventFields(
        ("to",), (), (),
        {},
    ),
    "edit": EventFields(
        ("low", "high"), (), (("above", "high", "low"),),
        {},
    ),
    "door": EventFields(
        (), (), (),
        {},
    ),
}
