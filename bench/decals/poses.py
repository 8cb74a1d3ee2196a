"""Where the drone of the flyby is compared: timelines with one key per second for drone and camera."""

# Position [m] and rotation about x, y, z [degrees] of the drone; camera [m], which looks at a point below the drone.
POSES = (
    ((0.0, 0.55, 2.0), (0, 0, 0), (2.6, 2.1, 4.6)),          # low over the pad
    ((0.0, 1.26, 2.0), (0, 0, 0), (2.8, 2.6, 5.0)),          # where it hovers
    ((1.5, 2.2, 3.0), (0, 40, 0), (3.9, 3.6, 6.2)),          # high
    ((-3.0, 0.7, 2.4), (0, 90, 12), (-0.6, 2.2, 5.0)),       # over the edge of the pad, rolled
    ((0.5, 0.9, 4.9), (20, 0, 0), (3.0, 2.4, 7.8)),          # nose down
    ((-6.0, 1.5, -7.4), (0, 0, 0), (-3.4, 2.9, -4.6)),       # over the dock
    ((-6.4, 0.9, -4.2), (-15, 0, 0), (-3.6, 2.4, -1.4)),     # over the steps
    ((-3.4, 0.8, -4.2), (0, 30, 0), (-0.6, 2.0, -1.4)),      # before the dock's wall
    ((0.0, 1.1, -8.0), (0, 0, -12), (2.8, 2.7, -5.2)),       # over the ramp
    ((-6.6, 1.0, -1.5), (0, 20, 0), (-4.0, 2.2, 1.6)),       # before a pillar
    ((6.6, 1.2, -3.7), (0, 200, 0), (4.2, 2.4, -6.6)),       # behind the other
    ((0.0, 4.0, -2.6), (0, 90, 0), (3.0, 2.7, 0.6)),         # under the beam
    ((5.9, 2.3, 1.6), (0, 0, 0), (3.4, 3.6, 4.6)),           # over the crates
    ((3.8, 0.8, 1.4), (0, 60, 8), (1.2, 2.1, 4.0)),          # beside them
    ((10.0, 2.2, 3.2), (0, 0, 0), (7.2, 3.5, 6.0)),          # over the pipe
    ((10.0, 0.8, 4.7), (0, 90, 0), (7.4, 2.0, 7.2)),         # beside it
    ((4.5, 1.5, -4.5), (0, 15, 0), (2.0, 2.9, -1.6)),        # over the drums
    ((-10.8, 1.0, 0.9), (0, 90, 0), (-8.2, 2.3, 3.6)),       # before the tank
    ((0.0, 0.9, -0.4), (0, 45, 35), (2.8, 2.3, 2.6)),        # banked
    ((-2.0, 0.8, 6.4), (180, 0, 0), (0.8, 2.2, 9.0)),        # upside down
)


def vector(values):
    return "[" + ", ".join(f"{value:g}" for value in values) + "]"


def timeline(scene, volume, settings=""):
    """TOML with a decal of a volume around the drone; `settings`: further lines of it."""
    lines = ["version = 1", f'scene = "{scene}"', f"duration = {len(POSES)}", "[smoke]", "voxels = 100", "[sky]",
             "ambient = [0.4, 0.4, 0.4]", "[[carrier]]", 'name = "drone"', 'object = "drone"']
    for time, (position, rotation, _) in enumerate(POSES):
        lines += ["[[carrier.key]]", f"time = {time}", f"position = {vector(position)}",
                  f"rotation = {vector(rotation)}"]
    lines += ["[[decal]]", f'file = "{volume}"', 'carrier = "drone"', settings]
    for time, ((x, y, z), _, camera) in enumerate(POSES):
        lines += ["[[camera]]", f"time = {time}", f"position = {vector(camera)}",
                  f"target = {vector((x, max(0.7 * y - 0.3, 0.0), z))}", "fov = 55"]
    return "\n".join(lines) + "\n"
