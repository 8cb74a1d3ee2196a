// Small scenes whose every part is known, for comparisons with what they should look like.
#pragma once

#include <string>
#include <vector>

#include "scenario/simulation.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {

/// A scene, when it is looked at, and how its smoke looks.
struct TruthCase {
  std::string name;
  scenario::Scenario scenario;
  double seconds = 2;
  bool noisy = false;      ///< With the noise of the smoke and of the rims of holes.
  double least_psnr = 38;  ///< Of what is shown [dB].
};

/// One light, many lights, a shot through the smoke, two shots, the edge of a wall, a doorway, a blast, a
/// wall along the view; and noise. Quarter-metre voxels, black sky, no ambient light.
std::vector<TruthCase> truth_cases();

}  // namespace brume::render
