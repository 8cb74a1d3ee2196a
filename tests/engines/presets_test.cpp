// Where the importers of engines look for a voxel, by their documentation and sources, is where --preset puts
// it. The mappings are those of docs/guides/volume-textures.md; tests/engines/godot_test.cpp runs an
// importer.
#include <gtest/gtest.h>

#include <functional>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "image/png.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/engines/sample_volume.hpp"

namespace brume::engines {
namespace {

/// An importer makes the texture's point (u, v, w) of a texel; the engine's import of a glTF file makes an
/// engine's axis of each of the volume's.
struct Engine {
  const char* preset;
  bool first_row_is_highest;  ///< v is 1 at the first row of a tile, else 0.
  /// The voxel of the volume at (u, v, w), which count voxels along the engine's own axes.
  std::function<glm::uvec3(glm::uvec3 uvw)> voxel;
  glm::uvec3 size;  ///< Of the volume along the engine's axes.
};

std::vector<Engine> engines() {
  const glm::uvec3 n = kVolumeSize;
  const auto same = [](glm::uvec3 uvw) { return uvw; };
  return {{"unreal", false, [](glm::uvec3 uvw) { return glm::uvec3(uvw.x, uvw.z, uvw.y); }, {n.x, n.z, n.y}},
          {"unity", true, [n](glm::uvec3 uvw) { return glm::uvec3(n.x - 1 - uvw.x, uvw.y, uvw.z); }, n},
          {"godot", false, same, n},
          {"houdini", true, same, n}};
}

class Presets : public testing::Test {
 protected:
  std::vector<std::string> bake(const std::string& preset, const std::string& image) const {
    save_volume(folder_.path() / "volume.brv", volume_of_codes(3));
    const cli::Outcome run = cli::run_brume(
        folder_.path(), {"bake", "slices", "volume.brv", "-o", image, "--preset", preset, "-q"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return folder_.files();
  }
  cli::WorkFolder folder_;
};

TEST_F(Presets, PutVoxelsWhereTheImporterLooks) {
  for (const Engine& engine : engines()) {
    SCOPED_TRACE(engine.preset);
    bake(engine.preset, "a.png");
    const auto bytes = read_file(folder_.path() / "a.png").value_or_throw();
    const image::NumberImage image = image::decode_png_numbers(bytes, "a.png").value_or_throw();
    // Importers are given the columns and rows, and make a slice of each tile, from the top left.
    const glm::uvec3 size = engine.size;
    const std::uint32_t columns = image.width / size.x, rows = image.height / size.y;
    ASSERT_EQ(glm::uvec2(image.width, image.height), glm::uvec2(columns * size.x, rows * size.y));
    ASSERT_EQ(columns * rows, size.z) << "no tile is empty";
    for (glm::uvec3 uvw(0); uvw.z < size.z; ++uvw.z)
      for (uvw.y = 0; uvw.y < size.y; ++uvw.y)
        for (uvw.x = 0; uvw.x < size.x; ++uvw.x) {
          const std::uint32_t row = engine.first_row_is_highest ? size.y - 1 - uvw.y : uvw.y;
          const std::size_t texel =
              uvw.z % columns * size.x + uvw.x + std::size_t{image.width} * (uvw.z / columns * size.y + row);
          for (std::size_t channel = 0; channel < 3; ++channel)
            EXPECT_EQ(image.values[3 * texel + channel], code_at(engine.voxel(uvw), channel));
        }
  }
}

TEST_F(Presets, FilesAreTheSameVolume) {
  const std::vector<grids::DenseGrid> volume = volume_of_codes(3);
  for (const Engine& engine : engines()) {
    SCOPED_TRACE(engine.preset);
    const std::string name = engine.preset;
    bake(name, name + ".png");
    const cli::Outcome run = cli::run_brume(folder_.path(), {"convert", name + ".json", name + ".brv"});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    const grids::GridFile file = grids::load_grid_file(folder_.path() / (name + ".brv")).value_or_throw();
    ASSERT_EQ(file.grids.size(), 3u);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(file.grids[channel].name, volume[channel].name);
      // Fails unless its voxels are those of the box; these have their values as they are.
      const grids::GridBox box{glm::dmat4(1), volume[0].box, kVolumeSize};
      EXPECT_EQ(grids::resample(file.grids[channel], box).value_or_throw().values, volume[channel].values);
    }
  }
}

TEST_F(Presets, OnlyGodotGetsImportSettings) {
  for (const Engine& engine : engines()) bake(engine.preset, std::string(engine.preset) + ".png");
  const std::vector<std::string> expected{"godot.json",  "godot.png",  "godot.png.import", "houdini.json",
                                          "houdini.png", "unity.json", "unity.png",        "unreal.json",
                                          "unreal.png",  "volume.brv"};
  EXPECT_EQ(folder_.files(), expected);
}

}  // namespace
}  // namespace brume::engines
