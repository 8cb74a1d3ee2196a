// What commands do with tanks of spheres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/cli/summary.hpp"
#include "apps/command_line/outputs.hpp"
#include "core/box.hpp"
#include "spheres/tank.hpp"

namespace brume::cli {

/// What is worth knowing of a tank; 0 and empty without spheres.
struct TankFacts {
  float least = 0, median = 0, largest = 0;              ///< Radii [voxels].
  double fill = 0;                                       ///< Fraction of the tank that is inside of spheres.
  std::size_t opaque = 0;                                ///< Spheres of opacity 255.
  std::uint32_t least_opacity = 0, largest_opacity = 0;  ///< Bytes.
  Box<double> bounds;                                    ///< Box around all spheres [voxels].
};
TankFacts facts_of(const spheres::Tank& tank);

/// A .spheres file, for `brume info`. Throws Error.
Summary tank_summary(const std::filesystem::path& path);

/// A scene of a tank, for `brume info`: how it is packed, or the file it is in, what lights it, and its
/// camera. If that file cannot be loaded: a warning or, with `check`, an Error. Throws Error for a scene with
/// faults.
Summary tank_scene_summary(const std::filesystem::path& path, bool check);

/// Writes a .spheres file as meshes (.obj) or points (.ply), for `brume convert`. Throws Error.
void convert_tank(const std::string& input, const std::string& output, const std::string& json,
                  Outputs& outputs);

}  // namespace brume::cli
