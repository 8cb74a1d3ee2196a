#!/usr/bin/env python3
"""Floods a level of two rooms with smoke and shows what a guard sees of it, as an array and as a picture.

    python3 flood.py [PICTURE.png]

Requires the module brume only: no scene, no GPU. Every run prints the same numbers.
"""

import sys

import brume
import numpy as np

VOXEL = 0.25  # metres
GUARD = (1.0, 1.6, 5.0)
HIDDEN_BELOW = 0.05  # A place counts as hidden when smoke takes all but this part of its light.


def make_level():
    """Two rooms of 10 m by 10 m, with a wall and a door between them."""
    solid = np.zeros((81, 16, 40), bool)
    solid[40] = True
    solid[40, :9, 16:24] = False
    return brume.Level.from_array(solid, voxel_size=VOXEL)


def heads(level):
    """The places of heads, 1.6 m above the floor, over the centre of each column: an array (x, z, 3)."""
    x = VOXEL * (np.arange(level.size[0]) + 0.5)
    z = VOXEL * (np.arange(level.size[2]) + 0.5)
    return np.stack(np.broadcast_arrays(x[:, None], 1.6, z), axis=-1)


def main():
    picture = sys.argv[1] if len(sys.argv) > 1 else "flood.png"
    level = make_level()
    world = brume.World(level)
    world.throw_smoke(origin=(2, 1.6, 2), at=(8.5, 0.3, 5))

    places = heads(level)
    in_reach = world.visible(GUARD, places, np.inf)  # Not behind walls, whatever the smoke.
    maps = []
    for seconds in (0.5, 1.5, 4.0):
        world.advance_to(seconds)
        light = np.exp(-world.optical_depth(GUARD, places))
        hidden = in_reach & (light < HIDDEN_BELOW)
        print(f"{seconds:.1f} s: {in_reach.sum()} places in reach, smoke hides {hidden.sum()}")

        colors = light[..., None] * (255, 230, 120) + (1 - light[..., None]) * (60, 90, 160)
        colors[~in_reach] = 40
        maps.append(colors.transpose(1, 0, 2).repeat(4, axis=0).repeat(4, axis=1))
    brume.save_png(picture, np.concatenate(maps).astype(np.uint8))
    print(f"wrote {picture}")


if __name__ == "__main__":
    main()
