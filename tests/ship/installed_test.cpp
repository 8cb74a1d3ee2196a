// The installed files hold no path of the build, the version is one, the headers have a reference.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/work_folder.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

int run(const std::string& command) {
  return std::system(command.c_str());
}

// What people expect of cmake --install: program, libraries, headers, and what CMake and pkg-config find them
// by.
TEST(Installed, WithoutAComponentIsEverythingThatDoesNotNeedMpi) {
  const WorkFolder folder;
  const fs::path prefix = folder.path() / "usr";
  ASSERT_EQ(run("cmake --install '" BRUME_BUILD_DIR "' --prefix '" + prefix.string() + "' > /dev/null"), 0);
  std::set<std::string> names;
  for (const auto& file : fs::recursive_directory_iterator(prefix)) names.insert(file.path().filename());
  for (const char* name : {"brume", "brume-vdb", "demo.toml", "brume.1", "brume-vdb.1", "libbrume-sim.so",
                           "libbrume-sim.so.0", "libbrume.so", "libbrume.so.0", "brume-config.cmake",
                           "brume-config-version.cmake", "brume-sim-targets.cmake",
                           "brume-host-targets.cmake", "brume-sim.pc", "brume.pc", "LICENSE", "NOTICES.txt"})
    EXPECT_TRUE(names.contains(name)) << name;
  for (const auto& header : fs::directory_iterator(BRUME_SOURCE_DIR "/include/brume"))
    EXPECT_TRUE(fs::is_regular_file(prefix / "include/brume" / header.path().filename())) << header.path();
  EXPECT_FALSE(names.contains("brume-mpi"));
}

TEST(Installed, NoFileNamesTheFolderOfTheBuild) {
  const WorkFolder folder;
  const std::string prefix = (folder.path() / "usr").string();
  for (const char* component : {"program", "sim", "host"})
    ASSERT_EQ(run("cmake --install '" BRUME_BUILD_DIR "' --component " + std::string(component) +
                  " --prefix '" + prefix + "' > /dev/null"),
              0);
  // The second search shows that the first would find it.
  const std::string search = "grep -rlaF --binary-files=text ";
  EXPECT_NE(run(search + "-e '" BRUME_SOURCE_DIR "/' -e '" BRUME_BUILD_DIR "/' '" + prefix + "'"), 0);
  EXPECT_EQ(run(search + "-e share/brume '" + prefix + "/bin/brume' > /dev/null"), 0);
  EXPECT_FALSE(fs::exists(fs::path(prefix) / "bin/brume-source.txt"));
}

TEST(Installed, TheVersionIsTheSameEverywhere) {
  const WorkFolder folder;
  const std::string version = run_brume(folder.path(), {"--version"}).out;
  const std::string number = version.substr(6, version.find('\n') - 6);
  const std::string header = *read_text_file(BRUME_SOURCE_DIR "/include/brume/brume.h");
  std::string declared;
  for (const char* part : {"MAJOR ", "MINOR ", "PATCH "}) {
    const std::size_t at = header.find(std::string("#define BRUME_VERSION_") + part) + 28;
    declared += (declared.empty() ? "" : ".") + header.substr(at, header.find('\n', at) - at);
  }
  EXPECT_EQ(declared, number);
  EXPECT_NE(read_text_file(BRUME_SOURCE_DIR "/CHANGELOG.md")->find("\n## " + number + " - 20"),
            std::string::npos);
  const std::string addon =
      *read_text_file(BRUME_SOURCE_DIR "/integrations/blender/brume_blender/blender_manifest.toml");
  EXPECT_NE(addon.find("\nversion = \"" + number + "\"\n"), std::string::npos);
}

TEST(Reference, DocumentsEverythingOfTheHeaders) {
  if (run("command -v doxygen > /dev/null") != 0) GTEST_SKIP() << "no doxygen";
  const WorkFolder folder;
  const std::string script =
      "'" BRUME_SOURCE_DIR "/script/reference' '" + (folder.path() / "all").string() + "'";
  EXPECT_EQ(run(script + " > '" + (folder.path() / "log").string() + "' 2>&1"), 0)
      << *read_text_file(folder.path() / "log");
  EXPECT_TRUE(fs::is_regular_file(folder.path() / "all/html/index.html"));

  // A function without a comment fails.
  for (const char* part : {"script", "docs/reference", "include"})
    fs::create_directories(folder.path() / "tree" / part);
  fs::copy_file(BRUME_SOURCE_DIR "/script/reference", folder.path() / "tree/script/reference");
  fs::copy_file(BRUME_SOURCE_DIR "/docs/reference/c-api.md", folder.path() / "tree/docs/reference/c-api.md");
  fs::copy_file(BRUME_SOURCE_DIR "/CMakeLists.txt", folder.path() / "tree/CMakeLists.txt");
  fs::copy(BRUME_SOURCE_DIR "/include", folder.path() / "tree/include", fs::copy_options::recursive);
  folder.write("tree/include/brume/more.h", "/** \\file\n A file. */\nint brume_more(void);\n");
  EXPECT_NE(run("'" + (folder.path() / "tree/script/reference").string() + "' '" +
                (folder.path() / "more").string() + "' > '" + (folder.path() / "log").string() + "' 2>&1"),
            0);
  EXPECT_NE(read_text_file(folder.path() / "log")->find("brume_more"), std::string::npos);
}

}  // namespace
}  // namespace brume::cli
