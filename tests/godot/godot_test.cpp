// The add-on of integrations/godot: a match gives what it does in C, and errors are lines.
#include <gtest/gtest.h>

#include "core/file.hpp"
#include "tests/api/run_shell.hpp"
#include "tests/work_folder.hpp"

namespace brume {
namespace {

namespace fs = std::filesystem;

class GodotAddOn : public testing::Test {
 protected:
  void SetUp() override {
    if (std::string(BRUME_GODOT_PROJECT).empty())
      GTEST_SKIP() << "the add-on is not built: script/godot-headers, then configure and build again";
    if (api::run_shell("command -v godot3-server").status != 0)
      GTEST_SKIP() << "godot3-server is not installed; script/bootstrap test installs it";
    fs::copy(BRUME_GODOT_PROJECT, project(), fs::copy_options::recursive);
    for (const char* script : {"play_match.gd", "call_match.gd"})
      fs::copy_file(std::string(BRUME_SOURCE_DIR "/tests/godot/") + script, project() / script);
  }
  fs::path project() const { return folder_.path() / "project"; }

  /// Runs a script without a window; errors of Godot are part of the output. The time limit ends only what
  /// hangs.
  api::ShellRun run(const std::string& script, const std::string& environment = "") const {
    return api::run_shell("HOME='" + folder_.path().string() + "' " + environment +
                          " timeout --kill-after=9 600 godot3-server --path '" + project().string() +
                          "' -s " + script + " 2>&1");
  }

  cli::WorkFolder folder_;
};

TEST_F(GodotAddOn, PlaysAMatchAsCDoes) {
  const api::ShellRun expected = api::run_shell("'" BRUME_LONG_MATCH "'");
  ASSERT_EQ(expected.status, 0);
  folder_.write("match.txt", expected.output);
  const std::string folder = folder_.path().string();
  const api::ShellRun played =
      run("play_match.gd", "MATCH='" + folder + "/match.txt' RESULTS='" + folder + "/results.txt'");
  ASSERT_EQ(played.status, 0) << played.output;
  const std::string results = read_text_file(folder_.path() / "results.txt").value_or_throw();
  EXPECT_GT(results.size(), 20'000u) << played.output;
  EXPECT_TRUE(expected.output.ends_with(results)) << played.output;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++found;
  return found;
}

TEST_F(GodotAddOn, CallsFailAndSucceedAsTheyShould) {
  const api::ShellRun called = run("call_match.gd");
  EXPECT_EQ(called.status, 0);
  EXPECT_EQ(called.output.find("expected: "), called.output.npos) << called.output;
  EXPECT_EQ(called.output.find("SCRIPT ERROR"), called.output.npos) << called.output;
  EXPECT_NE(called.output.find("\ndone\n"), called.output.npos) << called.output;
  EXPECT_EQ(count(called.output.substr(0, called.output.find("fails:")), "BrumeMatch"), 0u) << called.output;
  EXPECT_EQ(count(called.output, "ERROR: BrumeMatch: BrumeMatch."), 7u) << called.output;
}

}  // namespace
}  // namespace brume
