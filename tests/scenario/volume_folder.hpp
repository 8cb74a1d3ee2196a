// A folder of volume files, for one test.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "grids/files/grid_files.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {

class VolumeFolder : public testing::Test {
 protected:
  /// A brick full of one value.
  static grids::Grid cube(const std::string& name, float value) {
    grids::Grid grid;
    grid.name = name;
    grid.grid_class = grids::GridClass::fog_volume;
    grid.bricks.emplace_back().active.fill(~std::uint64_t{0});
    grid.values.resize(grids::kBrickVoxels * sizeof value);
    for (std::size_t i = 0; i < grid.values.size(); i += sizeof value)
      std::memcpy(&grid.values[i], &value, sizeof value);
    return grid;
  }
  std::filesystem::path save(const std::string& name, std::vector<grids::Grid> grids) const {
    const std::filesystem::path path = folder_ / name;
    grids::save_grid_file(path, {std::move(grids), {}}).value_or_throw();
    return path;
  }

  const cli::WorkFolder work_folder_;
  const std::filesystem::path folder_ = work_folder_.path();
};

}  // namespace brume::scenario
