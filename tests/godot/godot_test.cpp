// The add-on of integrations/godot: a match gives what it does in C, and errors are lines.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/file.hpp"
#include "tests/godot/add_on.hpp"

namespace brume {
namespace {

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

// The shader integrates in steps of 2 cm; it knows the displacement of the noise at every second voxel, which
// is worth about 1/100 of the light.
TEST_F(GodotAddOn, DrawsTheSmokeThatLinesOfSightMeet) {
  if (!draws()) GTEST_SKIP() << "godot3 or xvfb is not installed; script/bootstrap test installs them";
  const api::ShellRun drawn = run_drawing("compare_rays.gd");
  ASSERT_EQ(numbers_after(drawn.output, "mean").size(), 1u) << drawn.output;
  EXPECT_GT(numbers_after(drawn.output, "smoky")[0], 0.1) << drawn.output;
  EXPECT_LT(numbers_after(drawn.output, "mean")[0], 0.003) << drawn.output;
  EXPECT_LT(numbers_after(drawn.output, "worst")[0], 0.3) << drawn.output;
  EXPECT_EQ(drawn.output.find("SHADER ERROR"), drawn.output.npos) << drawn.output;
}

// The page's script, as the root of a scene with a light.
TEST_F(GodotAddOn, TheExampleOfThePageRuns) {
  if (!draws()) GTEST_SKIP() << "godot3 or xvfb is not installed; script/bootstrap test installs them";
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/docs/guides/godot.md");
  const std::size_t begin = page.find("```gdscript\n"), end = page.find("\n```\n", begin);
  ASSERT_NE(begin, page.npos);
  folder_.write("project/example.gd", "extends Spatial\n" + page.substr(begin + 12, end - begin - 12) + "\n");
  folder_.write("project/run_example.gd",
                "extends SceneTree\nfunc _init():\n\tOS.window_size = Vector2(64, 36)\n"
                "\tvar main = Spatial.new()\n\tvar light = OmniLight.new()\n\tlight.name = \"OmniLight\"\n"
                "\tmain.add_child(light)\n\tmain.set_script(load(\"res://example.gd\"))\n"
                "\troot.add_child(main)\n\twhile main.match_.tick() < 8:\n\t\tyield(self, \"idle_frame\")\n"
                "\tprint(\"ticks \", main.match_.tick())\n\tquit()\n");
  const api::ShellRun drawn = run_drawing("run_example.gd");
  EXPECT_EQ(drawn.status, 0);
  EXPECT_EQ(numbers_after(drawn.output, "ticks").size(), 1u) << drawn.output;
  EXPECT_EQ(drawn.output.find("SCRIPT ERROR"), drawn.output.npos) << drawn.output;
  EXPECT_EQ(drawn.output.find("BrumeMatch."), drawn.output.npos) << drawn.output;
}

TEST_F(GodotAddOn, TheDemoShowsSmokeHolesAndABlast) {
  if (!draws()) GTEST_SKIP() << "godot3 or xvfb is not installed; script/bootstrap test installs them";
  const char* kept = std::getenv("BRUME_PICTURES");
  const api::ShellRun drawn =
      run_drawing("picture.gd", "PICTURES='" + (kept ? std::string(kept) : folder_.path().string()) +
                                    "' SIZE=" + (kept ? "960x540" : "320x180"));
  const std::vector<double> smoky = numbers_after(drawn.output, "smoky");
  ASSERT_EQ(smoky.size(), 4u) << drawn.output;
  EXPECT_EQ(smoky[0], 0) << drawn.output;
  EXPECT_GT(smoky[1], 0.08) << drawn.output;
  EXPECT_LT(smoky[2], smoky[1]) << drawn.output;
  EXPECT_LT(smoky[3], 0.9 * smoky[2]) << drawn.output;
  EXPECT_EQ(drawn.output.find("SCRIPT ERROR"), drawn.output.npos) << drawn.output;
}

}  // namespace
}  // namespace brume
