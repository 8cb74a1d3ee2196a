// Blender opens the volume files that are written, at the right place and size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::blender {
namespace {

using Json = nlohmann::json;

// Float32 within 4 m.
constexpr double kNear = 1e-6;

TEST(BlenderVolume, OpensAWrittenFile) {
  if (std::system("command -v blender > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "blender is not installed; script/bootstrap test installs it";
  const cli::WorkFolder folder;
  const grids::Grid density = grids::smoke_grid("density", 11);
  grids::save_grid_file(folder.path() / "a.brv", {{density}, {}}).value_or_throw();
  ASSERT_EQ(cli::run_brume(folder.path(), {"convert", "a.brv", "a.vdb"}).exit_code, 0);
  const std::string path = folder.path().string();
  const std::string command =
      "cd '" + path +
      "' && BLENDER_USER_CONFIG=. blender -b --factory-startup --python-exit-code 1 -P '" BRUME_SOURCE_DIR
      "/tests/blender/volume.py' -- '" +
      path + "/a.vdb' '" + path + "/a.json' > log 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << *read_text_file(folder.path() / "log");

  const Json found = Json::parse(*read_text_file(folder.path() / "a.json"));
  EXPECT_EQ(found["loaded"], true);
  EXPECT_EQ(found["error"], "");
  ASSERT_EQ(found["grids"].size(), 1u);
  const Json& grid = found["grids"][0];
  EXPECT_EQ(grid["name"], "density");
  EXPECT_EQ(grid["type"], "FLOAT");
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(
          grid["matrix"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>(),
          density.world_from_index[column][row], kNear);
  // Around the centres of the voxels of its leaves.
  glm::dvec3 low(1e9), high(-1e9);
  for (const Json& corner : found["corners"]) {
    const glm::dvec3 p(corner[0].get<double>(), corner[1].get<double>(), corner[2].get<double>());
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 expected_low(density.world_from_index * glm::dvec4(-16, -16, -16, 1));
  const glm::dvec3 expected_high(density.world_from_index * glm::dvec4(15, 15, 15, 1));
  EXPECT_LT(glm::length(low - expected_low), 1e-5);
  EXPECT_LT(glm::length(high - expected_high), 1e-5);
}

}  // namespace
}  // namespace brume::blender
