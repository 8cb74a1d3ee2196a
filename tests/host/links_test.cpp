// What the installed libraries bring into a game.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "tests/api/run_shell.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

namespace fs = std::filesystem;

/// Each library with the reason for it.
using Libraries = std::map<std::string, std::string>;

const Libraries kSystem{
    {"libc.so.6", "the C runtime"},
    {"libm.so.6", "its mathematics"},
#ifndef BRUME_STATIC_RUNTIME
    {"libstdc++.so.6", "the C++ runtime"},
    {"libgcc_s.so.1", "its exceptions"},
#endif
};

/// What the dynamic section of the only file of this name below a folder names; without the loader of
/// programs, whose name is that of the processor.
Libraries needed_by(const fs::path& folder, const std::string& name) {
  Libraries libraries;
  const api::ShellRun run = api::run_shell("readelf --wide --dynamic \"$(find '" + folder.string() +
                                           "' -name '" + name + "' -type l | head -n 1)\"");
  EXPECT_EQ(run.status, 0) << name;
  std::istringstream lines(run.output);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find('[');
    if (line.find("(NEEDED)") == line.npos || begin == line.npos) continue;
    const std::string library = line.substr(begin + 1, line.find(']') - begin - 1);
    if (!library.starts_with("ld-linux")) libraries.emplace(library, "");
  }
  return libraries;
}

std::string names_of(const Libraries& libraries) {
  std::string names;
  for (const auto& [name, reason] : libraries) names += name + "\n";
  return names;
}

TEST(Links, TheLibrariesNeedTheseAndNoOthers) {
  const cli::WorkFolder folder;
  for (const char* component : {"sim", "host"})
    ASSERT_EQ(api::run_shell("cmake --install '" BRUME_BUILD_DIR "' --component " + std::string(component) +
                             " --prefix '" + folder.path().string() + "'")
                  .status,
              0);
  EXPECT_EQ(names_of(needed_by(folder.path(), "libbrume-sim.so.0")), names_of(kSystem));
  Libraries expected = kSystem;
  expected.emplace("libzstd.so.1", "bricks of .brv files are compressed");
  EXPECT_EQ(names_of(needed_by(folder.path(), "libbrume.so.0")), names_of(expected))
      << "docs/OVERVIEW.md says how libbrume stays free of others";
}

// A server's security review asks what a library in the network's path can do.
TEST(Links, TheSimulationStartsNoProcess) {
  const api::ShellRun run = api::run_shell("nm --dynamic --undefined-only '" BRUME_SIM_LIBRARY "'");
  ASSERT_EQ(run.status, 0);
  EXPECT_NE(run.output.find(" memcpy"), run.output.npos) << "what it calls is listed";
  for (const char* call :
       {"fork", "exec", "posix_spawn", "system", "memfd_create", "prctl", "kill", "socket", "dlopen"})
    EXPECT_EQ(run.output.find(" " + std::string(call)), run.output.npos) << call;
}

}  // namespace
}  // namespace brume::host
