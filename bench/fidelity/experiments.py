"""The experiments of docs/fidelity.md: what becomes of the figures when a cause is removed, from both renderers."""

DARK = 0.05
BOTH = "surfaces and smoke reflect a twentieth"
PALE_SMOKE = (("smoke", "albedo", [0.045, 0.0455, 0.0465]),)
NO_SKY = (("sky", "ambient", [0.0, 0.0, 0.0]),)

# Scene, transport, what is changed, edits of the timeline, factor of the surfaces' colours.
EXPERIMENTS = (
    *((scene, "full", *change) for scene in ("shot", "wall_edge", "light_inside") for change in
      (("nothing", (), None), ("surfaces reflect a twentieth", (), DARK), (BOTH, PALE_SMOKE, DARK))),
    ("dusk", "full", "nothing", (), None),
    ("dusk", "full", "`bounce` 0 in place of 0.2, in real time", (("sky", "bounce", 0.0),), None),
    ("fire", "full", "nothing", (), None),
    ("fire", "full", "black smoke", (("volume", "albedo", [0.0, 0.0, 0.0]),), None),
    ("cloud", "single", "nothing", (), None),
    ("cloud", "single", "no sky", NO_SKY, None),
    ("word", "single", "nothing", (), None),
    ("word", "single", "no noise in the smoke", (("smoke", "erosion", 0.0),), None),
)


def run(studio):
    found = []
    for number, (scene, mode, change, edits, paint) in enumerate(EXPERIMENTS):
        row = studio.compare(scene, f"{mode}_{number}", edits, paint)
        found.append({"scene": scene, "mode": mode, "change": change, **row})
    return found
