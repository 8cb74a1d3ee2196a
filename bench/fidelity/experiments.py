"""Experiments for docs/how/path-tracer.md: the figures once a cause is removed, from both renderers."""

DARK = 0.05
BOTH = "surfaces and smoke reflect a twentieth"
PALE_SMOKE = (("smoke", "albedo", [0.045, 0.0455, 0.0465]),)
THREE_QUARTERS = (("realtime sky", "ambient", [0.225, 0.27, 0.3375]),)
FINE = (("realtime grid", "voxel", 0.0625), ("realtime grid", "size", [144, 68, 132]),
        ("realtime smoke", "voxels", 480000))
NO_SKY = (("sky", "ambient", [0.0, 0.0, 0.0]),)

# Scene, transport, what is changed, edits of the timeline, factor of the surfaces' colours.
EXPERIMENTS = (
    *((scene, "full", *change) for scene in ("shot", "wall_edge", "light_inside") for change in
      (("nothing", (), None), ("surfaces reflect a twentieth", (), DARK), (BOTH, PALE_SMOKE, DARK))),
    ("dusk", "full", "nothing", (), None),
    ("dusk", "full", "`bounce` 0 in place of 0.2, in real time", (("realtime sky", "bounce", 0.0),), None),
    ("dusk", "single", "nothing", (), None),
    ("dusk", "single", "voxels of 6 cm in place of 12, in real time", FINE, None),
    ("fire", "full", "nothing", (), None),
    ("fire", "full", "black smoke", (("volume", "albedo", [0.0, 0.0, 0.0]),), None),
    ("cloud", "single", "nothing", (), None),
    ("cloud", "single", "no sky", NO_SKY, None),
    ("cloud", "single", "3/4 of the sky's light, in real time", THREE_QUARTERS, None),
    ("yard", "single", "nothing", (), None),
    ("yard", "single", "3/4 of the sky's light, in real time", THREE_QUARTERS, None),
    ("word", "single", "nothing", (), None),
    ("word", "single", "no noise in the smoke", (("smoke", "erosion", 0.0),), None),
)


def run(studio):
    found = []
    for number, (scene, mode, change, edits, paint) in enumerate(EXPERIMENTS):
        row = studio.compare(scene, f"{mode}_{number}", edits, paint)
        found.append({"scene": scene, "mode": mode, "change": change, **row})
    return found
