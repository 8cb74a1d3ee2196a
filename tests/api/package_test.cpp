// The headers, the exported symbols and the installed package, used as other projects use them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "tests/api/abi.hpp"
#include "tests/api/header_example.hpp"
#include "tests/work_folder.hpp"

namespace brume::api {
namespace {

namespace fs = std::filesystem;

const std::string kInclude = BRUME_SOURCE_DIR "/include";

bool has(const std::string& program) {
  return run_shell("command -v " + program).status == 0;
}

void expect_runs(const std::string& command) {
  const ShellRun run = run_shell("{ " + command + "; } 2>&1");
  EXPECT_EQ(run.status, 0) << command << "\n" << run.output;
}

TEST(Headers, CompileWithoutAWarning) {
  const std::string warnings =
      " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I'" + kInclude + "' ";
  for (const char* compiler : {"gcc", "clang"}) {
    if (!has(compiler)) continue;
    for (const char* standard : {"c11", "c17"})
      expect_runs(compiler + warnings + "-Wstrict-prototypes -std=" + standard +
                  " " BRUME_SOURCE_DIR "/tests/api/header.c");
  }
  for (const char* compiler : {"g++", "clang++"}) {
    if (!has(compiler)) continue;
    for (const char* standard : {"c++11", "c++17", "c++20"})
      expect_runs(compiler + warnings + "-Wold-style-cast -Wzero-as-null-pointer-constant -x c++ -std=" +
                  standard + " " BRUME_SOURCE_DIR "/tests/api/header.c");
    expect_runs("echo '#include <brume/brume_textures.hpp>' | " + std::string(compiler) + warnings +
                "-Wold-style-cast -std=c++17 -x c++ -");
  }
}

// In a room of 16 m x 4 m x 18 m, whose middle the smoke fills.
TEST(Headers, TheExampleRunsInCAndCpp) {
  const std::string example = example_of("brume.h");
  ASSERT_NE(example.find("brume_world_forget_before"), example.npos);
  const cli::WorkFolder folder;
  folder.write("example.c",
               "#include <brume/brume.h>\n#include <stdio.h>\n#include <stdlib.h>\n"
               "static void check(brume_result result) {\n  if (result == BRUME_OK) return;\n"
               "  puts(brume_last_error());\n  exit(1);\n}\n"
               "int main(void) {\n  brume_point points[8];\n"
               "  for (int i = 0; i < 8; ++i) {\n    points[i].x = i & 1 ? 10.0f : -6.0f;\n"
               "    points[i].y = i & 2 ? 4.0f : 0.0f;\n    points[i].z = i & 4 ? 10.0f : -8.0f;\n  }\n"
               "  const uint32_t indices[] = {0, 1, 4, 1, 4, 5, 2, 3, 6, 3, 6, 7, 0, 1, 2, 1, 2, 3,\n"
               "                              4, 5, 6, 5, 6, 7, 0, 2, 4, 2, 4, 6, 1, 3, 5, 3, 5, 7};\n"
               "  const size_t point_count = 8, index_count = 36;\n"
               "  const brume_point bot_eyes = {2.0f, 1.6f, -6.0f}, player_eyes = {2.0f, 1.6f, 8.0f};\n" +
                   example +
                   "  check(brume_field_destroy(field));\n  check(brume_world_destroy(world));\n"
                   "  check(brume_level_destroy(level));\n  check(brume_context_destroy(context));\n"
                   "  return 0;\n}\n");
  const std::string program = (folder.path() / "example").string();
  for (const char* compiler : {"cc -std=c11", "c++ -std=c++17 -x c++"}) {
    expect_runs(std::string(compiler) + " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -I'" +
                kInclude + "' '" + program + ".c' -x none -o '" + program + "' '" BRUME_LIBRARY "'");
    const ShellRun run = run_shell("LD_LIBRARY_PATH=\"$(dirname '" BRUME_LIBRARY "')\" '" + program + "'");
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_EQ(run.output.rfind("tick 0: visible 1\n", 0), 0u) << run.output;
    EXPECT_TRUE(run.output.ends_with("tick 128: visible 0\n")) << run.output;
  }
}

/// The names of the functions that the headers declare.
std::set<std::string> declared() {
  std::set<std::string> names;
  const std::string text =
      *read_text_file(kInclude + "/brume/brume.h") + *read_text_file(kInclude + "/brume/brume_textures.h");
  for (std::size_t at = 0; (at = text.find("BRUME_API ", at)) != text.npos; ++at) {
    const std::size_t bracket = text.find('(', at), name = text.rfind("brume_", bracket);
    if (text.compare(at - 8, 8, "#define ") != 0) names.insert(text.substr(name, bracket - name));
  }
  return names;
}

TEST(Library, ExportsTheFunctionsOfTheHeaderAndNothingElse) {
  const ShellRun run = run_shell("nm --dynamic --defined-only '" BRUME_LIBRARY "'");
  ASSERT_EQ(run.status, 0);
  std::set<std::string> exported, listed;
  std::istringstream lines(run.output);
  for (std::string address, type, name; lines >> address >> type >> name;)
    if (type != "A") exported.insert(name.substr(0, name.find('@')));
  std::istringstream list(*read_text_file(BRUME_SOURCE_DIR "/tests/api/symbols.txt"));
  for (std::string name; list >> name;) listed.insert(name);
  EXPECT_EQ(exported, listed) << "a function that is removed or changes is a new SOVERSION";
  EXPECT_EQ(exported, declared());
}

// docs/reference/c-api.md has the command.
TEST(StaticLibrary, IsAllOfBrumeThatAProgramOfCLinks) {
  const cli::WorkFolder folder;
  const std::string program = (folder.path() / "server").string();
  const ShellRun shared = run_shell("'" BRUME_SERVER_PROGRAM "' --seconds 10");
  ASSERT_EQ(shared.status, 0);
  for (const std::string all : {"", " -static"}) {
    expect_runs("cc -std=c11 '" BRUME_SOURCE_DIR "/examples/server/server.c' -I'" + kInclude + "' -o '" +
                program + "' '" BRUME_STATIC_LIBRARY "' -lstdc++ -lm" + all);
    EXPECT_NE(run_shell("readelf --dynamic '" + program + "' | grep libbrume").status, 0);
    const ShellRun run = run_shell("'" + program + "' --seconds 10");
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.output, shared.output) << "hashes, sights and packets";
  }
}

TEST(Abi, IsTheOneThatIsKept) {
  for (const std::string header : {"brume", "brume_textures"}) {
    const ShellRun run = abi_difference(header + ".h", "api/" + header + ".abi");
    EXPECT_EQ(run.status, 0) << run.output << "\ntests/api/abi-of-headers says what to do";
  }
}

TEST(Abi, ChangesOfTheHeaderAreFound) {
  const cli::WorkFolder folder;
  const std::string header = *read_text_file(kInclude + "/brume/brume.h");
  fs::create_directories(folder.path() / "brume");
  struct Change {
    const char *before, *after;
  };
  for (const auto& [before, after] :
       {Change{"  float extinction; ", "  double extinction; "},
        Change{"  size_t byte_count; ", "  size_t byte_count; uint32_t added; "},
        Change{"  BRUME_HOLE_BOX = 1,", "  BRUME_HOLE_BOX = 3,"},
        Change{"BRUME_API brume_result brume_world_step(brume_world* world) BRUME_NOEXCEPT;", ""}}) {
    const std::size_t at = header.find(before);
    ASSERT_NE(at, header.npos) << before;
    folder.write("brume/brume.h", std::string(header).replace(at, std::string(before).size(), after));
    EXPECT_NE(abi_difference("brume.h", "api/brume.abi", folder.path().string()).status, 0) << after;
  }
}

class Package : public testing::Test {
 protected:
  void SetUp() override {
    expect_runs("cmake --install '" BRUME_BUILD_DIR "' --component sim --prefix '" + prefix_.string() + "'");
  }
  /// Configures, builds and runs the example outside of the tree.
  void expect_example_works(const fs::path& prefix, const std::string& build) {
    const std::string folder = (folder_.path() / build).string();
    expect_runs("cmake -S '" + example_.string() + "' -B '" + folder + "' -D CMAKE_PREFIX_PATH='" +
                prefix.string() + "' -D CMAKE_C_COMPILER='" BRUME_C_COMPILER "' && cmake --build '" + folder +
                "'");
    const ShellRun here = run_shell("'" + folder + "/brume_server' --seconds 10");
    const ShellRun tree = run_shell("'" BRUME_SERVER_PROGRAM "' --seconds 10");
    EXPECT_EQ(here.status, 0);
    EXPECT_EQ(here.output, tree.output);
    EXPECT_FALSE(here.output.empty());
  }

  cli::WorkFolder folder_;
  fs::path prefix_ = folder_.path() / "installed";
  fs::path example_ = folder_.path() / "example";
};

TEST_F(Package, SaysWhichComponentIsMissing) {
  fs::create_directories(example_);
  std::ofstream(example_ / "CMakeLists.txt")
      << "cmake_minimum_required(VERSION 3.25)\nproject(a LANGUAGES C)\n"
         "find_package(brume CONFIG REQUIRED COMPONENTS render)\n";
  const ShellRun run =
      run_shell("cmake -S '" + example_.string() + "' -B '" + (folder_.path() / "missing").string() +
                "' -D CMAKE_PREFIX_PATH='" + prefix_.string() + "' 2>&1");
  EXPECT_NE(run.status, 0);
  EXPECT_NE(run.output.find("component 'render'"), run.output.npos) << run.output;
}

TEST_F(Package, BuildsTheExampleAlsoAfterItWasMoved) {
  fs::copy(BRUME_SOURCE_DIR "/examples/server", example_);
  expect_example_works(prefix_, "first");
  const fs::path moved = folder_.path() / "elsewhere" / "deeper";
  fs::create_directories(moved.parent_path());
  fs::rename(prefix_, moved);
  expect_example_works(moved, "second");
  EXPECT_NE(run_shell("cmake -S '" + example_.string() + "' -B '" + (folder_.path() / "third").string() +
                      "' -D CMAKE_PREFIX_PATH='" + prefix_.string() + "' > /dev/null 2>&1")
                .status,
            0)
      << "nothing is left at the first prefix";
  // No file of the package names the folders of its build.
  EXPECT_NE(run_shell("grep -r --binary-files=text -l -e '" BRUME_BUILD_DIR "' -e '" + prefix_.string() +
                      "' '" + moved.string() + "'/*/cmake '" + moved.string() + "'/*/pkgconfig")
                .status,
            0);
}

TEST_F(Package, IsFoundByPkgConfig) {
  if (!has("pkg-config")) GTEST_SKIP() << "no pkg-config";
  const fs::path moved = folder_.path() / "moved";
  fs::rename(prefix_, moved);
  folder_.write(
      "wrapper.cpp",
      "#include <brume/brume.hpp>\n#include <cstdio>\nint main() {\n  const brume::api::Context context;\n"
      "  std::puts(brume_result_name(BRUME_OK));\n}\n");
  const std::string path = run_shell("find '" + moved.string() + "' -name pkgconfig").output;
  const std::string found = path.substr(0, path.find('\n'));
  const std::string program = (folder_.path() / "wrapper").string();
  expect_runs("export PKG_CONFIG_PATH='" + found + "'; c++ -std=c++17 '" + program + ".cpp' -o '" + program +
              "' $(pkg-config --cflags --libs brume-sim)");
  const std::string libraries = fs::path(found).parent_path().string();
  const ShellRun run = run_shell("LD_LIBRARY_PATH='" + libraries + "' '" + program + "'");
  EXPECT_EQ(run.output, "BRUME_OK\n");
  EXPECT_TRUE(fs::is_symlink(fs::path(libraries) / "libbrume-sim.so.0"));
}

}  // namespace
}  // namespace brume::api
