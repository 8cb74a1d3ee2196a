// An installed program finds its files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

TEST(Install, TheManualPageNamesEveryCommand) {
  const WorkFolder folder;
  const std::string help = run_brume(folder.path(), {"--help"}).out;
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/apps/cli/brume.1");
  std::istringstream lines(help.substr(help.find("Commands:\n") + 10));
  int commands = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 4 || line.rfind("  ", 0) != 0 || line[2] == ' ') continue;
    const std::string command = line.substr(2, line.find("  ", 2) - 2);
    EXPECT_NE(page.find(".It Cm " + command + "\n"), std::string::npos) << command;
    ++commands;
  }
  EXPECT_GE(commands, 11);
}

// What bash completes a command line to: words, the last of which is begun.
std::string completions(const WorkFolder& folder, const std::string& words) {
  const std::string script = "PATH='" + fs::path(BRUME_PROGRAM).parent_path().string() +
                             "':$PATH; source '" BRUME_SOURCE_DIR "/apps/cli/brume.bash'; COMP_WORDS=(" +
                             words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _brume; echo \"${COMPREPLY[*]}\"";
  folder.write("complete.sh", script);
  const std::string out = (folder.path() / "out").string();
  const std::string command = "cd '" + folder.path().string() + "' && bash complete.sh > '" + out + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << words;
  return *read_text_file(out);
}

TEST(Install, BashCompletesCommandsOfOneAndTwoWords) {
  const WorkFolder folder;
  folder.write("slices.glb", "");
  EXPECT_EQ(completions(folder, "brume b"), "bake bench\n");
  EXPECT_EQ(completions(folder, "brume bake ''"), "slices occlusion spheres pyroclastic sphere slab torus\n");
  EXPECT_EQ(completions(folder, "brume bake sl"), "slices slab\n");
  EXPECT_EQ(completions(folder, "brume bake slices sl"), "slices.glb\n");
  EXPECT_EQ(completions(folder, "brume bake slices --p"), "--progress --padding --preset\n");
  EXPECT_EQ(completions(folder, "brume bake slices slices.glb -o a.png --ch"), "--channels\n");
  EXPECT_EQ(completions(folder, "brume bake occlusion --fall"), "--falloff\n");
  EXPECT_EQ(completions(folder, "brume bake sphere --rad"), "--radius\n");
  EXPECT_EQ(completions(folder, "brume render sl"), "slices.glb\n");
  EXPECT_EQ(completions(folder, "brume help bake o"), "occlusion\n");
}

TEST(Install, TheProgramFindsItsScenesBesideItAndInShare) {
  const WorkFolder folder;
  const fs::path prefix = folder.path() / "usr";
  const std::string install = "cmake --install '" BRUME_BUILD_DIR "' --prefix '" + prefix.string() + "' > '" +
                              (folder.path() / "log").string() + "' 2>&1";
  ASSERT_EQ(std::system(install.c_str()), 0) << *read_text_file(folder.path() / "log");
  for (const char* file :
       {"bin/brume", "bin/brume-vdb", "share/brume/scenes/demo.toml", "share/brume/scenes/demo.glb",
        "share/brume/scenes/README.md", "share/brume/scenes/flyby/drone_ao.json",
        "share/brume/scenes/flyby/drone_ao.png", "share/brume/scenes/thruster/thruster.json",
        "share/brume/scenes/thruster/flame.png", "share/bash-completion/completions/brume",
        "share/man/man1/brume.1"})
    EXPECT_TRUE(fs::is_regular_file(prefix / file)) << file;

  // So does its helper.
  folder.write("a.json",
               R"({"format": "brume raw volume", "version": 1, "raw": "a.raw", "size": [1, 1, 2]})");
  folder.write("a.raw", "????????");
  RunOptions converter;
  converter.program = (prefix / "bin/brume").string();
  EXPECT_EQ(run_brume(folder.path(), {"convert", "a.json", "a.vdb"}, converter).exit_code, 0);

  // Which timeline it reads shows where it is damaged.
  RunOptions installed;
  installed.program = (prefix / "bin/brume").string();
  const auto read_first = [&](const fs::path& scenes) {
    fs::create_directories(scenes);
    folder.write((scenes / "demo.toml").lexically_relative(folder.path()).string(), "version = 9\n");
    const Outcome run = run_brume(folder.path(), {"demo", "--out", "."}, installed);
    EXPECT_EQ(run.exit_code, 3);
    return run.error.rfind("brume: " + (scenes / "demo.toml").string() + ":1:", 0) == 0;
  };
  EXPECT_TRUE(read_first(prefix / "share/brume/scenes"));
  EXPECT_TRUE(read_first(prefix / "bin/scenes"));
  expect_failure(folder, {"demo", "--out", ".", "--scenes", "usr"}, 2, {"--scenes usr", "demo.toml"},
                 installed);
}

}  // namespace
}  // namespace brume::cli
