// The room of room.hpp with a volume in it.
#pragma once

#include <cstring>

#include "grids/files/grid_files.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {

/// A brick of one value.
inline grids::Grid full_brick(const std::string& name, float value) {
  grids::Grid grid;
  grid.name = name;
  grid.bricks.emplace_back().active.fill(~std::uint64_t{0});
  grid.values.resize(grids::kBrickVoxels * sizeof value);
  for (std::size_t voxel = 0; voxel < grids::kBrickVoxels; ++voxel)
    std::memcpy(grid.values.data() + voxel * sizeof value, &value, sizeof value);
  return grid;
}

/// Writes the room, fog.brv and foggy.toml.
inline void write_foggy_room(const cli::WorkFolder& folder) {
  write_room(folder);
  grids::Grid colors = full_brick("Cd", 0);
  colors.type = grids::ValueType::vec3f;
  colors.values.resize(grids::kBrickVoxels * sizeof(glm::vec3));
  const glm::vec3 color(1, 0.5f, 0.25f);
  for (std::size_t voxel = 0; voxel < grids::kBrickVoxels; ++voxel)
    std::memcpy(colors.values.data() + voxel * sizeof color, &color, sizeof color);
  grids::save_grid_file(
      folder.path() / "fog.brv",
      {{full_brick("density", 0.5f), full_brick("fuel", 0.25f), full_brick("temperature", 0.5f), colors}, {}})
      .value_or_throw();
  std::ifstream room(folder.path() / "room.toml");
  const std::string text((std::istreambuf_iterator<char>(room)), std::istreambuf_iterator<char>());
  folder.write("foggy.toml", text +
                                 "[[volume]]\nfile = \"fog.brv\"\nposition = [-1.0, 0.5, 0.0]\n"
                                 "scale = 0.2\nextinction = 2.0\nkelvin = 2000.0\n");
}

/// The same with busy.toml: a carrier moves the block, a decal, and a second volume, which has masks and is
/// disturbed; another decal is at the top of the door. That volume is behind the camera: where it meets the
/// other, light in both takes a software rasterizer seconds.
inline void write_busy_room(const cli::WorkFolder& folder) {
  write_foggy_room(folder);
  std::ifstream foggy(folder.path() / "foggy.toml");
  const std::string text((std::istreambuf_iterator<char>(foggy)), std::istreambuf_iterator<char>());
  folder.write("busy.toml", text +
                                R"([[volume]]
file = "fog.brv"
position = [0.0, 1.0, 20.0]
scale = 0.1
carrier = "crane"
[volume.disturb]
strength = 0.5
size = 2.0
drift = [0.0, 1.0, 0.0]
[[volume.mask]]
grid = "fuel"
color = [1.0, 0.5, 0.0]
intensity = 2.0
[[volume.mask]]
grid = "temperature"
[[volume.mask.key]]
time = 0.0
[[volume.mask.key]]
time = 1.0
intensity = 3.0
[[carrier]]
name = "crane"
object = "Block"
[[carrier.key]]
time = 0.0
position = [2.0, 0.0, -2.0]
[[carrier.key]]
time = 2.0
position = [0.0, 0.5, -2.0]
rotation = [0.0, 90.0, 0.0]
[[carrier]]
name = "rail"
[[carrier.key]]
time = 0.0
position = [1.0, 0.0, 0.0]
[[decal]]
file = "fog.brv"
grid = "density"
position = [-2.2, 2.2, -1.0]
scale = 0.2
[[decal]]
file = "fog.brv"
grid = "density"
carrier = "crane"
position = [0.0, -0.5, 0.0]
scale = 0.2
)");
}

}  // namespace brume::viewer
