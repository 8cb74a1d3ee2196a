// The room of room.hpp with a volume in it.
#pragma once

#include <cstring>

#include "grids/files.hpp"
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

}  // namespace brume::viewer
