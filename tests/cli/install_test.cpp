// An installed program finds its files.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

TEST(Install, TheProgramFindsItsScenesBesideItAndInShare) {
  const WorkFolder folder;
  const fs::path prefix = folder.path() / "usr";
  const std::string install = "cmake --install '" BRUME_BUILD_DIR "' --component program --prefix '" +
                              prefix.string() + "' > '" + (folder.path() / "log").string() + "' 2>&1";
  ASSERT_EQ(std::system(install.c_str()), 0) << *read_text_file(folder.path() / "log");
  for (const char* file :
       {"bin/brume", "bin/brume-vdb", "share/brume/scenes/demo.toml", "share/brume/scenes/demo.glb",
        "share/brume/scenes/README.md", "share/brume/scenes/flyby/drone_ao.json",
        "share/brume/scenes/flyby/drone_ao.png", "share/brume/scenes/thruster/thruster.json",
        "share/brume/scenes/thruster/flame.png", "share/bash-completion/completions/brume",
        "share/man/man1/brume.1", "share/man/man1/brume-bake-slices.1", "share/zsh/vendor-completions/_brume",
        "share/fish/vendor_completions.d/brume.fish", "share/doc/brume/copyright"})
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
