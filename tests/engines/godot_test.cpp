// Godot imports a baked atlas by the settings beside it: its voxels are those of the volume, at the same
// places.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/engines/sample_volume.hpp"

namespace brume::engines {
namespace {

namespace fs = std::filesystem;

/// A texture as the importer stores it.
struct GodotTexture {
  glm::uvec3 size{0};
  std::uint32_t flags = 0;
  std::vector<std::array<float, 4>> texels;  ///< Along x, then y, then z, as texture(sampler3D, uvw) counts.

  const std::array<float, 4>& at(glm::uvec3 voxel) const {
    return texels.at(voxel.x + std::size_t{size.x} * (voxel.y + std::size_t{size.y} * voxel.z));
  }
};

GodotTexture parse_texture(const fs::path& path) {
  const std::string bytes = read_text_file(path).value_or_throw();
  std::array<std::uint32_t, 4> head{};
  GodotTexture texture;
  if (bytes.size() < sizeof head) return texture;
  std::memcpy(head.data(), bytes.data(), sizeof head);
  texture.size = {head[0], head[1], head[2]};
  texture.flags = head[3];
  texture.texels.resize((bytes.size() - sizeof head) / sizeof(std::array<float, 4>));
  std::memcpy(texture.texels.data(), bytes.data() + sizeof head, bytes.size() - sizeof head);
  return texture;
}

class Godot : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v godot3-server > /dev/null 2>&1") != 0)
      GTEST_SKIP() << "godot3-server is not installed; script/bootstrap test installs it";
    fs::create_directories(project() / "addons/imported");
    fs::create_directories(folder_.path() / "home");
    folder_.write("project/project.godot",
                  "config_version=4\n\n[application]\n\nconfig/name=\"slices\"\n\n"
                  "[editor_plugins]\n\nenabled=PoolStringArray( \"imported\" )\n");
    folder_.write("project/addons/imported/plugin.cfg",
                  "[plugin]\n\nname=\"imported\"\ndescription=\"\"\nauthor=\"\"\nversion=\"1\"\n"
                  "script=\"end_when_imported.gd\"\n");
    const fs::path scripts = BRUME_SOURCE_DIR "/tests/engines";
    fs::copy_file(scripts / "end_when_imported.gd", project() / "addons/imported/end_when_imported.gd");
    fs::copy_file(scripts / "read_texture.gd", project() / "read_texture.gd");
  }
  fs::path project() const { return folder_.path() / "project"; }

  void bake(const std::vector<grids::DenseGrid>& volume, const std::string& image,
            const std::vector<std::string>& more = {}) const {
    save_volume(folder_.path() / "volume.brv", volume);
    std::vector<std::string> call{"bake",     "slices", "volume.brv", "-o", "project/" + image,
                                  "--preset", "godot"};
    call.insert(call.end(), more.begin(), more.end());
    const cli::Outcome run = cli::run_brume(folder_.path(), call);
    ASSERT_EQ(run.exit_code, 0) << run.error;
  }

  /// The importer of the editor, which ends when it is done, and then the script that reads what it made.
  void import_all() const {
    const std::string log = (folder_.path() / "log").string();
    // The time limit ends only what hangs.
    const std::string godot = "HOME='" + (folder_.path() / "home").string() +
                              "' timeout --kill-after=9 600 godot3-server --path '" + project().string() +
                              "' ";
    for (const std::string& part : {std::string("--editor"), std::string("-s read_texture.gd")})
      ASSERT_EQ(std::system((godot + part + " > '" + log + "' 2>&1").c_str()), 0) << *read_text_file(log);
    // Godot exits with 0 after errors of a script.
    const std::string said = read_text_file(log).value_or_throw();
    EXPECT_EQ(said.find("SCRIPT ERROR"), std::string::npos) << said;
  }

  GodotTexture texture(const std::string& image) const {
    GodotTexture texture = parse_texture(project() / (image + ".texels"));
    EXPECT_EQ(texture.size, kVolumeSize);
    // Filtered, neither repeated nor converted from sRGB, without mip levels.
    EXPECT_EQ(texture.flags, 4u);
    EXPECT_EQ(texture.texels.size(), std::size_t{kVolumeSize.x} * kVolumeSize.y * kVolumeSize.z);
    return texture;
  }

  /// Red, green, blue and alpha are the grids of the volume, up to `slack`; an image of one is grey, and of
  /// OpenEXR has it as alpha, too.
  void expect_volume(const std::string& image, const std::vector<grids::DenseGrid>& volume,
                     float slack) const {
    SCOPED_TRACE(image);
    const GodotTexture found = texture(image);
    ASSERT_FALSE(found.texels.empty());
    for (glm::uvec3 at(0); at.z < kVolumeSize.z; ++at.z)
      for (at.y = 0; at.y < kVolumeSize.y; ++at.y)
        for (at.x = 0; at.x < kVolumeSize.x; ++at.x)
          for (std::size_t channel = 0; channel < 4; ++channel) {
            const bool grey = volume.size() == 1 && (channel < 3 || image.ends_with(".exr"));
            float expected = channel == 3 ? 1.0f : 0.0f;
            if (grey || channel < volume.size())
              expected = volume[grey ? 0 : channel].values[volume[0].index(at)];
            EXPECT_LE(std::abs(found.at(at)[channel] - expected), slack)
                << at.x << "," << at.y << "," << at.z << " channel " << channel;
          }
  }

  cli::WorkFolder folder_;
};

TEST_F(Godot, PngOf8BitsGivesTheVoxelsOfTheVolume) {
  for (std::size_t channels = 1; channels <= 4; ++channels)
    bake(volume_of_codes(channels), std::to_string(channels) + ".png");
  import_all();
  // Codes of 8 bits come back as they are; both sides round code / 255 to float32, by 2^-25 below 1.
  for (std::size_t channels = 1; channels <= 4; ++channels)
    expect_volume(std::to_string(channels) + ".png", volume_of_codes(channels), 0x1p-23f);
}

TEST_F(Godot, OpenExrOf16BitsGivesHalvesAsTheyAre) {
  for (std::size_t channels = 1; channels <= 4; ++channels)
    bake(volume_of_halves(channels), std::to_string(channels) + ".exr");
  import_all();
  for (std::size_t channels = 1; channels <= 4; ++channels)
    expect_volume(std::to_string(channels) + ".exr", volume_of_halves(channels), 0);
}

// Godot 3 stores halves: of a 16-bit PNG it keeps 8 bits, of floats the next half.
TEST_F(Godot, MoreBitsAreReducedByTheImporter) {
  bake(volume_of_codes(1), "deep.png", {"--bits", "16"});
  bake(volume_of_codes(1), "deep.exr", {"--bits", "32"});
  import_all();
  expect_volume("deep.png", volume_of_codes(1), 1.0f / 255);
  // Values below 1: halves are at most 2^-11 apart.
  expect_volume("deep.exr", volume_of_codes(1), 0x1p-11f);
}

TEST_F(Godot, ABakeReplacesTheImportSettingsOfTheOneBefore) {
  bake(volume_of_codes(1), "a.png", {"--size", "10x6x8"});
  import_all();
  EXPECT_EQ(parse_texture(project() / "a.png.texels").size, glm::uvec3(10, 6, 8));
  bake(volume_of_codes(1), "a.png");
  // Godot compares the times of files in whole seconds.
  for (const char* file : {"a.png", "a.png.import"})
    fs::last_write_time(project() / file, fs::file_time_type::clock::now() + std::chrono::seconds(2));
  import_all();
  expect_volume("a.png", volume_of_codes(1), 0x1p-23f);
}

}  // namespace
}  // namespace brume::engines
