#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "tests/house/house_rules.hpp"
#include "tests/house/sources.hpp"

namespace brume::house {
namespace {

using Strings = std::vector<std::string>;

std::string folder_of_file(const std::filesystem::path& path) {
  return std::string(folder_of(std::filesystem::relative(path, kRoot).generic_string()));
}

TEST(HouseRules, DetectAnUpwardInclude) {
  EXPECT_EQ(upward_includes("voxel", "#include \"sim/world.hpp\"\n"), Strings{"sim/world.hpp"});
  EXPECT_EQ(upward_includes("core", "#  include \"image/image.hpp\"\n"), Strings{"image/image.hpp"});
  EXPECT_EQ(upward_includes("render", "#include \"apps/cli/options.hpp\"\n"),
            Strings{"apps/cli/options.hpp"});
  EXPECT_EQ(upward_includes("apps/mpi", "#include \"apps/cli/run.hpp\"\n"), Strings{"apps/cli/run.hpp"});
  EXPECT_EQ(upward_includes("apps/mpi", "#include \"apps/command_line/json.hpp\"\n"), Strings{});
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

TEST(HouseRules, DetectPlatformCode) {
  EXPECT_EQ(platform_code("#if defined(_WIN32) && x\n"), Strings{"#if defined(_WIN32"});
  EXPECT_EQ(platform_code("# elif __linux__\n#ifdef __MINGW32__\n"),
            (Strings{"# elif __linux__", "#ifdef __MINGW32__"}));
  EXPECT_EQ(platform_code("#include <sys/stat.h>\n#  include <windows.h>\n"),
            (Strings{"#include <sys/", "#  include <windows.h"}));
  EXPECT_EQ(platform_code("open(\"/proc/self/exe\");"), Strings{"\"/proc/"});
  EXPECT_TRUE(
      platform_code("#include <csignal>\n#if defined(__GNUC__)\nint _WIN32_like; // /proc/x").empty());
}

TEST(HouseRules, DetectAStructWithoutASize) {
  EXPECT_EQ(unsized_structs("struct A {\n float x;\n};\nSHARED_SIZE(A, 4);\nstruct B { int y; };\n"
                            "struct C {};\nSHARED_LOCAL(C);"),
            Strings{"B"});
}

TEST(HouseRules, SeeLinesThatAreTooWide) {
  EXPECT_EQ(wide_lines("12345\n123456\n\n1234567", 5), (std::vector<std::size_t>{2, 4}));
  EXPECT_TRUE(wide_lines("\xc3\xa4\xc3\xb6\xc3\xbc", 3).empty()) << "characters, not bytes";
  EXPECT_EQ(line_count("a\nb\n"), 2u);
  EXPECT_EQ(line_count("a\nb"), 2u);
}

/// A function of so many lines, in a block that begins with `head`.
std::string function_of(std::size_t lines, const std::string& indent, const char* head) {
  std::ostringstream text;
  text << head << indent << "int f(int a,\n" << indent << "      int b) {\n";
  for (std::size_t i = 3; i < lines; ++i) text << indent << "  ++a;\n";
  text << indent << "}\n}\n";
  return text.str();
}

TEST(HouseRules, SeeLongFunctions) {
  EXPECT_TRUE(long_functions(function_of(59, "", "namespace a {\n"), 60).empty());
  const auto found = long_functions(function_of(70, "", "namespace a {\n"), 60);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].lines, 70u);
  EXPECT_EQ(found[0].line, 2u);
  EXPECT_EQ(long_functions(function_of(70, "  ", "class A {\n public:\n"), 60).size(), 1u);
  EXPECT_TRUE(long_functions(function_of(2, "", "namespace a {\n"), 60).empty());
}

TEST(HouseRules, SeeWordsThatTheGlossaryReplaces) {
  const Strings words =
      replaced_words("| word | means | not |\n| **light** | a `source` | `lamp`, other |\n");
  EXPECT_EQ(words, Strings{"lamp"});
  EXPECT_EQ(occurring(words, "float far_lamp;"), words);
  EXPECT_EQ(occurring(words, "kLampCount = 1; // lamps"), words);
  EXPECT_TRUE(occurring(words, "x = clamp(y); clamps").empty());
}

TEST(House, IncludesPointDownwards) {
  int count = 0;
  const auto check = [](const std::filesystem::path& path, const std::string& text) {
    for (const auto& include : upward_includes(folder_of_file(path), text)) {
      ADD_FAILURE() << path << " includes " << include << ", which lies above it";
    }
  };
  for (const char* folder : {"src", "bench", "apps", "examples", "python"})
    count += for_each_source(kRoot / folder, check);
  EXPECT_GT(count, 20);
}

TEST(House, OnlyTheGpuFolderCallsVulkan) {
  const auto check = [](const std::filesystem::path& path, const std::string& text) {
    if (folder_of_file(path) == "gpu") return;
    for (const auto& call : vulkan_calls(text)) ADD_FAILURE() << path << " has " << call;
  };
  for (const char* folder : {"src", "bench", "apps", "python"}) for_each_source(kRoot / folder, check);
}

TEST(House, PlatformCodeIsInOneRoom) {
  // Beside src/core/platform:
  const std::set<std::filesystem::path> exceptions{
      "include/brume/brume.h",  // what exports a function is spelled differently
      "apps/vdb/main.cpp",      // limits its memory, time and files; OpenVDB has no build for Windows
      "apps/vdb/vdb.cpp",       // OpenVDB writes to the descriptor that it inherits
      "apps/mpi/main.cpp",      // the peak of its memory; not built for Windows
      "python/calls.cpp",       // permissions, as errno of Python; not built for Windows
  };
  std::set<std::filesystem::path> used;
  const auto check = [&](const std::filesystem::path& path, const std::string& text) {
    const std::filesystem::path file = path.lexically_relative(kRoot);
    if (file.parent_path() == "src/core/platform") return;
    for (const auto& found : platform_code(text)) {
      if (!exceptions.contains(file)) ADD_FAILURE() << file << " has " << found;
      used.insert(file);
    }
  };
  for (const char* folder : {"include", "src", "bench", "apps", "examples", "fuzz", "python", "shaders"})
    for_each_source(kRoot / folder, check);
  EXPECT_EQ(used, exceptions);
  // No header has what windows.h defines.
  for (const auto& header : std::filesystem::directory_iterator(kRoot / "src/core/platform"))
    if (header.path().extension() == ".hpp") {
      EXPECT_EQ(platform_code(*read_text_file(header.path())), Strings{}) << header.path();
    }
}

TEST(House, SharedStructsHaveASize) {
  const int count = for_each_source(kRoot / "shaders/shared", [](const auto& path, const std::string& text) {
    if (path.filename() == "shim.h") return;  // the types of the languages
    for (const auto& name : unsized_structs(text))
      ADD_FAILURE() << path << ": " << name << " has neither SHARED_SIZE nor SHARED_LOCAL";
  });
  EXPECT_GT(count, 1);
}

constexpr std::size_t kMaxScriptLines = 500, kMaxFunctionLines = 60, kMaxLineWidth = 120;

TEST(House, FunctionsAndLinesStayShort) {
  int count = 0;
  for (const char* folder :
       {"include", "src", "apps", "bench", "tests", "examples", "fuzz", "python", "shaders"}) {
    count += for_each_source(kRoot / folder, [&](const auto& path, const std::string& text) {
      for (const Length& function : long_functions(text, kMaxFunctionLines))
        ADD_FAILURE() << path << ":" << function.line << ": " << function.name << " has " << function.lines
                      << " lines; fewer than " << kMaxFunctionLines << " are allowed";
      for (const std::size_t line : wide_lines(text, kMaxLineWidth))
        ADD_FAILURE() << path << ":" << line << " is wider than " << kMaxLineWidth << " characters";
    });
  }
  EXPECT_GT(count, 300);
}

TEST(House, ScriptsStayShort) {
  int count = 0;
  const auto check = [&](const std::filesystem::path& path) {
    const std::string text = *read_text_file(path);
    EXPECT_LT(line_count(text), kMaxScriptLines) << path << " is too long: split it by purpose";
    for (const std::size_t line : wide_lines(text, kMaxLineWidth))
      ADD_FAILURE() << path << ":" << line << " is wider than " << kMaxLineWidth << " characters";
    ++count;
  };
  for (const auto& script : std::filesystem::directory_iterator(kRoot / "script"))
    if (script.is_regular_file()) check(script.path());
  for (const char* folder : {"bench", "data", "integrations", "python", "scenes", "tests"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / folder))
      if (entry.path().extension() == ".py") check(entry.path());
  EXPECT_GT(count, 100);
}

TEST(House, ExportedShadersAreTheSameInBothLanguages) {
  EXPECT_EQ(std::system(BRUME_SOURCE_DIR "/script/export-hlsl --check"), 0);
}

TEST(House, TheShaderForGodotIsTheExportedOne) {
  EXPECT_EQ(std::system(BRUME_SOURCE_DIR "/script/export-godot --check"), 0);
}

TEST(House, DeclarationsInCSharpAreThoseOfTheHeader) {
  EXPECT_EQ(std::system(BRUME_SOURCE_DIR "/script/export-csharp --check"), 0);
}

TEST(House, ScenesAreWhatTheirScriptsMake) {
  for (const char* script : {"make_demo.py", "make_thruster.py", "make_flyby.py"}) {
    const std::string command =
        std::string("/usr/bin/python3 " BRUME_SOURCE_DIR "/scenes/") + script + " --check";
    EXPECT_EQ(std::system(command.c_str()), 0) << script;
  }
}

TEST(House, NothingUsesAWordThatTheGlossaryReplaces) {
  const std::string guide = *read_text_file(kRoot / "CONTRIBUTING.md");
  const std::size_t begin = guide.find("\n## Words\n");
  ASSERT_NE(begin, std::string::npos);
  const Strings words = replaced_words(guide.substr(begin, guide.find("\n## ", begin + 1) - begin));
  ASSERT_GT(words.size(), 10u);
  for (const char* folder :
       {"include", "src", "apps", "bench", "tests", "examples", "fuzz", "python", "shaders"})
    for_each_source(kRoot / folder, [&](const auto& path, const std::string& text) {
      if (folder_of_file(path) == "tests" && path.string().find("/house/") != std::string::npos) return;
      for (const std::string& word : occurring(words, text))
        ADD_FAILURE() << path << " says \"" << word << "\", which CONTRIBUTING.md replaces";
    });
  for (const auto& page : std::filesystem::recursive_directory_iterator(kRoot / "docs")) {
    if (page.path().extension() != ".md") continue;
    for (const std::string& word : occurring(words, *read_text_file(page.path())))
      ADD_FAILURE() << page.path() << " says \"" << word << "\", which CONTRIBUTING.md replaces";
  }
}

}  // namespace
}  // namespace brume::house
