// The header, the exported symbols, the installed package and its example, used as other projects use them.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "tests/api/abi.hpp"
#include "tests/api/header_example.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

namespace fs = std::filesystem;
using api::run_shell;
using api::ShellRun;

const std::string kInclude = BRUME_SOURCE_DIR "/include";

void expect_runs(const std::string& command) {
  const ShellRun run = run_shell("{ " + command + "; } 2>&1");
  EXPECT_EQ(run.status, 0) << command << "\n" << run.output;
}

TEST(VulkanHeader, CompilesWithoutAWarning) {
  const std::string flags =
      " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I'" + kInclude + "' ";
  for (const char* compiler : {"gcc", "clang"})
    if (run_shell(std::string("command -v ") + compiler).status == 0)
      expect_runs("echo '#include <brume/brume_vulkan.h>' | " + std::string(compiler) + flags +
                  "-std=c11 -x c -");
  for (const char* header : {"brume_vulkan.h", "brume_vulkan.hpp"})
    expect_runs("echo '#include <brume/" + std::string(header) + ">' | g++" + flags + "-std=c++17 -x c++ -");
}

// The frame of brume_vulkan.h, and in it the volume of brume_assets.h.
TEST(VulkanHeader, TheExamplesCompileAsCAndCpp) {
  const std::string frame = api::example_of("brume_vulkan.h"), volume = api::example_of("brume_assets.h");
  ASSERT_NE(frame.find("brume_renderer_record"), frame.npos);
  ASSERT_NE(volume.find("brume_volume_create"), volume.npos);
  const cli::WorkFolder folder;
  folder.write(
      "example.c",
      "#include <brume/brume_vulkan.h>\n#include <stdlib.h>\n"
      "static void check(brume_result result) {\n  if (result != BRUME_OK) exit(1);\n}\n"
      "void example(VkInstance instance, VkPhysicalDevice physical_device, VkDevice vulkan_device,\n"
      "             uint32_t queue_family, VkCommandBuffer commands, VkImageView color_view,\n"
      "             VkImageView depth_view, uint32_t width, uint32_t height, brume_context* context,\n"
      "             const brume_field* field, uint64_t frame_number, uint64_t completed_frame,\n"
      "             uint32_t tick, double seconds, brume_point eye, brume_point forward,\n"
      "             brume_point hearth) {\n" +
          frame + volume + "}\n");
  for (const char* compiler : {"cc -std=c11", "c++ -std=c++17 -x c++"})
    expect_runs(std::string(compiler) +
                " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I'" + kInclude +
                "' '" + (folder.path() / "example.c").string() + "'");
}

TEST(VulkanHeader, TheChainOfFeaturesOfThePageCompiles) {
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/docs/reference/c-api.md");
  const std::size_t call = page.find("check(brume_vulkan_merge_features("),
                    from = page.rfind("```c\n", call) + 5;
  ASSERT_NE(call, page.npos);
  const cli::WorkFolder folder;
  folder.write("chain.c",
               "#include <brume/brume_vulkan.h>\nvoid check(brume_result result);\n"
               "void chain(void);\nVkDeviceCreateInfo device_info;\nbrume_device_params host;\n"
               "void chain(void) {\n" +
                   page.substr(from, page.find("```", from) - from) + "}\n");
  expect_runs("cc -std=c11 -Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -I'" + kInclude + "' '" +
              (folder.path() / "chain.c").string() + "'");
}

TEST(VulkanLibrary, ExportsTheFunctionsOfItsHeadersAndNothingElse) {
  std::set<std::string> declared, exported;
  for (const char* header :
       {"/brume/brume.h", "/brume/brume_textures.h", "/brume/brume_assets.h", "/brume/brume_vulkan.h"}) {
    const std::string text = *read_text_file(kInclude + header);
    for (std::size_t at = 0; (at = text.find("BRUME_API ", at)) != text.npos; ++at) {
      const std::size_t bracket = text.find('(', at), name = text.rfind("brume_", bracket);
      if (at < 8 || text.compare(at - 8, 8, "#define ") != 0)
        declared.insert(text.substr(name, bracket - name));
    }
  }
  const ShellRun run = run_shell("nm --dynamic --defined-only '" BRUME_HOST_LIBRARY "'");
  ASSERT_EQ(run.status, 0);
  std::istringstream lines(run.output);
  for (std::string address, type, name; lines >> address >> type >> name;)
    if (type != "A") exported.insert(name.substr(0, name.find('@')));
  EXPECT_EQ(exported, declared);
}

TEST(VulkanAbi, IsTheOneThatIsKept) {
  for (const std::string header : {"brume_assets", "brume_vulkan"}) {
    const ShellRun run = api::abi_difference(header + ".h", "host/" + header + ".abi");
    EXPECT_EQ(run.status, 0) << run.output << "\ntests/api/abi-of-headers says what to do";
  }
}

constexpr const char* kValidation =
    "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "
    "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT ";

class HostExample : public testing::Test {
 protected:
  std::string picture(const std::string& program, const std::string& name, const std::string& options) {
    const fs::path file = folder_.path() / (name + ".ppm");
    expect_runs("'" + program + "' -o '" + file.string() + "' --size 32x18 " + options);
    return *read_text_file(file);
  }
  cli::WorkFolder folder_;
};

TEST_F(HostExample, DrawsTheSameWithAnyNumberOfFramesInFlight) {
  // Smoke is in view from frame 25 on.
  const std::string one = picture(BRUME_HOST_EXAMPLE, "one", "--frames 28 --in-flight 1");
  EXPECT_EQ(picture(BRUME_HOST_EXAMPLE, "three", "--frames 28 --in-flight 3"), one);
  EXPECT_NE(picture(BRUME_HOST_EXAMPLE, "none", "--frames 28 --no-smoke"), one);
  const std::string split = picture(BRUME_HOST_EXAMPLE, "split", "--frames 28 --players 3 --least-scale 0.5");
  EXPECT_EQ(picture(BRUME_HOST_EXAMPLE, "split1", "--frames 28 --players 3 --least-scale 0.5 --in-flight 1"),
            split);
}

// Behind a fast camera, the smoke's part of the picture lies where it is without temporal anti-aliasing, but
// for what jitter and accumulation smooth at this size.
TEST_F(HostExample, TemporalAntiAliasingFollowsTheSmoke) {
  const std::string film = "--frames 50 --size 64x36 --speed 3 ";
  const std::string without = picture(BRUME_HOST_EXAMPLE, "without", film),
                    empty = picture(BRUME_HOST_EXAMPLE, "empty", film + "--no-smoke");
  const auto away = [&](const std::string& taa) {
    const std::string drawn = picture(BRUME_HOST_EXAMPLE, taa, film + "--taa " + taa);
    const auto apart = [](char a, char b) {
      return std::abs(static_cast<unsigned char>(a) - static_cast<unsigned char>(b));
    };
    double sum = 0;
    int smoky = 0;
    for (std::size_t i = without.size() - std::size_t{3} * 64 * 36; i < without.size(); ++i) {
      if (apart(without[i], empty[i]) <= 12) continue;
      sum += apart(drawn[i], without[i]);
      ++smoky;
    }
    EXPECT_GT(smoky, 300);
    return sum / smoky;
  };
  const double surfaces = away("surfaces"), smoke = away("smoke");
  EXPECT_LT(smoke, 0.7 * surfaces) << surfaces;
}

// Its own barriers and those of the library fit together. What is valid with three frames in flight is so
// with one, which waits more often.
TEST_F(HostExample, IsValid) {
  const ShellRun run =
      run_shell(std::string(kValidation) +
                "'" BRUME_HOST_EXAMPLE "' --frames 26 --size 32x18 --players 2 --least-scale 0.4 -o '" +
                (folder_.path() / "valid.ppm").string() + "' --in-flight 3 2>&1");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, "");
  const ShellRun taa = run_shell(std::string(kValidation) +
                                 "'" BRUME_HOST_EXAMPLE "' --frames 26 --size 32x18 --taa smoke -o '" +
                                 (folder_.path() / "taa.ppm").string() + "' --in-flight 3 2>&1");
  EXPECT_EQ(taa.status, 0);
  EXPECT_EQ(taa.output, "");
}

// Grey walls, and the smoke in front of the doorway, which light comes through.
TEST_F(HostExample, TheSmallestIsValidAndDrawsSmoke) {
  const fs::path file = folder_.path() / "hello.png";
  const ShellRun run =
      run_shell(std::string(kValidation) + "'" BRUME_HELLO_HOST "' '" + file.string() + "' 2>&1");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, "");
  const image::Image8 picture = image::load_image(file).value_or_throw();
  ASSERT_EQ(glm::uvec2(picture.width, picture.height), glm::uvec2(640, 360));
  const auto pixel = [&](std::size_t x, std::size_t y) {
    const std::uint8_t* const rgba = &picture.rgba[4 * (x + 640 * y)];
    return glm::ivec3(rgba[0], rgba[1], rgba[2]);
  };
  // Linear 0.09, 0.0837 and 0.0738.
  EXPECT_EQ(pixel(600, 150), glm::ivec3(85, 82, 77));
  const glm::ivec3 doorway = pixel(275, 200), beside = pixel(360, 220);
  EXPECT_GT(beside.g, 120);
  EXPECT_GT(doorway.r, doorway.b + 20);
}

TEST_F(HostExample, BuildsAgainstTheInstalledPackage) {
  const std::string prefix = (folder_.path() / "installed").string(),
                    source = (folder_.path() / "source").string(),
                    build = (folder_.path() / "build").string(), hello = (folder_.path() / "hello").string();
  for (const char* component : {"sim", "host"})
    expect_runs("cmake --install '" BRUME_BUILD_DIR "' --component " + std::string(component) +
                " --prefix '" + prefix + "'");
  fs::copy(BRUME_SOURCE_DIR "/examples/host", source);
  fs::copy(BRUME_SOURCE_DIR "/examples/hello_host", hello);
  expect_runs("cmake -S '" + hello + "' -B '" + hello + "/build' -D CMAKE_PREFIX_PATH='" + prefix +
              "' && cmake --build '" + hello + "/build'");
  expect_runs("cmake -S '" + source + "' -B '" + build +
              "' -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH='" + prefix + "' && cmake --build '" +
              build + "'");
  expect_runs("grep -r --include=brume.pc -q -e -lbrume '" + prefix + "'");
  expect_runs("export PKG_CONFIG_PATH=$(dirname \"$(find '" + prefix +
              "' -name brume.pc)\"); pkg-config --exists brume");
  EXPECT_EQ(picture(build + "/brume_host_example", "installed", "--frames 4"),
            picture(BRUME_HOST_EXAMPLE, "tree", "--frames 4"));
}

}  // namespace
}  // namespace brume::host
