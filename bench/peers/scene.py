"""What all renderers draw: one volume under one sun, and the arguments that describe it to each."""
import math


class Scene:
    """A pyroclastic cloud of `edge` voxels of a metre around the origin. The sun's light, scattered once and evenly in
    all directions by a medium that absorbs nothing, has a radiance of 1. `extinction` is that of a voxel of density
    1."""

    def __init__(self, edge, size, extinction=0.05):
        self.edge, self.size, self.extinction, self.albedo = edge, size, extinction, 0.9
        self.fov = 46.0  # vertical [degrees]
        length = math.hypot(0.4, 0.3, 1)
        self.eye = [round(1.4 * edge * part / length, 6) for part in (0.4, 0.3, 1)]
        self.azimuth, self.elevation = 75.0, 35.0
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        self.to_sun = [math.sin(azimuth) * math.cos(elevation), math.sin(elevation),
                       math.cos(azimuth) * math.cos(elevation)]
        self.irradiance = 4 * math.pi

    def words(self, numbers):
        return ",".join(f"{number:.9g}" for number in numbers)

    def timeline(self, file):
        """A Brume timeline; without a file, of a triangle that the eye does not see."""
        volume = f"""
[[volume]]
file = "{file}"
extinction = {self.extinction}
albedo = [{self.albedo}, {self.albedo}, {self.albedo}]
anisotropy = 0.0
multiple_scattering = 0.0
""" if file else ""
        return f"""version = 1
scene = "{file or 'triangle.obj'}"
duration = 10.0

[grid]
voxel = {min(max(self.edge / 16, 0.015625), 64)}
{volume}
[sky]
zenith = [0.0, 0.0, 0.0]
horizon = [0.0, 0.0, 0.0]
ambient = [0.0, 0.0, 0.0]

[sun]
azimuth = {self.azimuth}
elevation = {self.elevation}
irradiance = [{', '.join([f'{self.irradiance:.9g}'] * 3)}]

[[camera]]
time = 0.0
position = [{', '.join(map(str, self.eye))}]
target = [0.0, 0.0, 0.0]
fov = {self.fov}
"""

    def vdb_render(self):
        """Its light has no phase function: the light's colour is the radiance of what is scattered. Its gain would
        weaken extinction along shadow rays with the distance, to look like multiple scattering. The aperture is the
        image's width at the focal length."""
        focal = 50
        aperture = 2 * focal * math.tan(math.radians(self.fov) / 2) * self.size[0] / self.size[1]
        scatter, absorb = self.extinction * self.albedo, self.extinction * (1 - self.albedo)
        return ["-res", "{}x{}".format(*self.size), "-focal", str(focal), "-aperture", f"{aperture:.9g}",
                "-translate", self.words(self.eye), "-lookat", "0,0,0", "-scatter", f"{scatter:.9g}",
                "-absorb", f"{absorb:.9g}", "-light", self.words(self.to_sun + [1, 1, 1]), "-gain", "0"]

    def reference(self):
        """Arguments of volume_reference, whose result is to be multiplied by the albedo."""
        return ["--size", "{}x{}".format(*self.size), "--eye", self.words(self.eye), "--target", "0,0,0",
                "--fov", str(self.fov), "--to-sun", self.words(self.to_sun),
                "--extinction", str(self.extinction)]

    def description(self, file):
        """For cycles_cloud.py."""
        keys = ("edge", "size", "extinction", "albedo", "fov", "eye", "to_sun", "irradiance")
        return {"file": str(file), "voxel": 1, "target": [0, 0, 0], **{key: getattr(self, key) for key in keys}}
