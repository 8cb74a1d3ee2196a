#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "core/file.hpp"
#include "tests/house/house_rules.hpp"

namespace brume::house {
namespace {

using Strings = std::vector<std::string>;

const std::filesystem::path kRoot = BRUME_SOURCE_DIR;

// Calls visit(path, text) for each C++ file and header below a folder of the project, and returns their
// number.
int for_each_source(const std::filesystem::path& folder,
                    const std::function<void(const std::filesystem::path&, const std::string&)>& visit) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".cpp" && extension != ".hpp" && extension != ".h") continue;
    visit(entry.path(), *read_text_file(entry.path()));
    ++count;
  }
  return count;
}

// "core" for src/core/file.hpp, "apps" for apps/cli/main.cpp.
std::string folder_of(const std::filesystem::path& path) {
  const auto relative = std::filesystem::relative(path, kRoot);
  auto part = relative.begin();
  return *part == "src" ? (++part)->string() : part->string();
}

TEST(HouseRules, DetectAnUpwardInclude) {
  EXPECT_EQ(upward_includes("voxel", "#include \"sim/world.hpp\"\n"), Strings{"sim/world.hpp"});
  EXPECT_EQ(upward_includes("core", "#  include \"image/image.hpp\"\n"), Strings{"image/image.hpp"});
  EXPECT_EQ(upward_includes("render", "#include \"apps/cli/options.hpp\"\n"),
            Strings{"apps/cli/options.hpp"});
  EXPECT_EQ(upward_includes("sim", "#include \"elsewhere/a.hpp\"\n"), Strings{"elsewhere/a.hpp"});
  EXPECT_EQ(upward_includes("sim",
                            "#include \"sim/a.hpp\"\n#include \"core/b.hpp\"\n#include <vector>\n"
                            "#include \"shared/hole.h\"\n"),
            Strings{});
}

TEST(HouseRules, DetectACallOfVulkan) {
  EXPECT_EQ(vulkan_calls("  vkCmdDraw(c);"), Strings{"vkCmdDraw("});
  EXPECT_EQ(vulkan_calls("f.vkCmdDraw (c);"), Strings{"vkCmdDraw ("});
  EXPECT_EQ(vulkan_calls("#include <vulkan/vulkan.h>"), Strings{"#include <vulkan/vulkan.h"});
  EXPECT_EQ(vulkan_calls("VkImage image; recorder.dispatch(1); // as vkCmdDraw does"), Strings{});
}

TEST(HouseRules, DetectAStructWithoutASize) {
  EXPECT_EQ(unsized_structs("struct A {\n float x;\n};\nSHARED_SIZE(A, 4);\nstruct B { int y; };"),
            Strings{"B"});
}

TEST(House, IncludesPointDownwards) {
  int count = 0;
  const auto check = [](const std::filesystem::path& path, const std::string& text) {
    for (const auto& include : upward_includes(folder_of(path), text)) {
      ADD_FAILURE() << path << " includes " << include << ", which lies above it";
    }
  };
  for (const char* folder : {"src", "bench", "apps"}) count += for_each_source(kRoot / folder, check);
  EXPECT_GT(count, 20);
}

TEST(House, OnlyTheGpuFolderCallsVulkan) {
  const auto check = [](const std::filesystem::path& path, const std::string& text) {
    if (folder_of(path) == "gpu") return;
    for (const auto& call : vulkan_calls(text)) ADD_FAILURE() << path << " has " << call;
  };
  for (const char* folder : {"src", "bench", "apps"}) for_each_source(kRoot / folder, check);
}

TEST(House, SharedStructsHaveASize) {
  const int count = for_each_source(kRoot / "shaders/shared", [](const auto& path, const std::string& text) {
    for (const auto& name : unsized_structs(text))
      ADD_FAILURE() << path << ": " << name << " has no SHARED_SIZE";
  });
  EXPECT_GT(count, 1);
}

}  // namespace
}  // namespace brume::house
