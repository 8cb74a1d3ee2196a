// A small tank for window tests.
#pragma once

#include <string>

#include "tests/viewer/room.hpp"

namespace brume::viewer {

/// Writes tank.toml: a packed tank with two lights, one of which has keys, and glass.
inline void write_tank(const cli::WorkFolder& folder, const std::string& samples = "6") {
  folder.write("tank.toml",
               "version = 1\nduration = 2.0\n[tank]\nsize = [60, 60, 24]\nvoxel = 0.02\nspheres = 300\n"
               "radius = [1.5, 6]\npalette = \"viridis\"\nphotons = 100000\nsamples = " +
                   samples +
                   "\n[sky]\nambient = [0.2, 0.2, 0.25]\n"
                   "[[light]]\nposition = [-0.3, 0.3, 0.9]\nintensity = 3\nradius = 0.05\n"
                   "[[light]]\nposition = [0.5, 0.2, 0.7]\nintensity = 2\n"
                   "[[light.key]]\ntime = 0\nposition = [0.5, 0.2, 0.7]\n"
                   "[[light.key]]\ntime = 2\nposition = [-0.5, 0.2, 0.7]\n"
                   "[glass]\nposition = [0.1, -0.1, 0.5]\nradii = [0.15, 0.15, 0.15]\n"
                   "[[camera]]\ntime = 0\nposition = [0, 0, 2.4]\ntarget = [0, 0, 0]\nfov = 42\n");
}

}  // namespace brume::viewer
