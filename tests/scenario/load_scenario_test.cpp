#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/scenario.hpp"
#include "scenario/tank.hpp"
#include "tests/log_lines.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

class LoadScenario : public testing::Test {
 protected:
  std::filesystem::path write(const char* name, const std::string& text) const {
    return folder_.path() / folder_.write(name, text);
  }
  const cli::WorkFolder folder_;
  LogLines log_;
};

constexpr const char* kTriangle = "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(LoadScenario, ASceneWithoutATimelineIsReadOnce) {
  const auto scenario = load_scenario(write("a.obj", kTriangle), {});
  ASSERT_TRUE(scenario) << scenario.failure().message;
  const auto warns = [](const std::string& line) { return line.find("gone.mtl") != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(log_.lines, warns), 1);
}

TEST_F(LoadScenario, SuffixesMayBeInCapitals) {
  write("A.OBJ", kTriangle);
  const auto scenario = load_scenario(write("D.TOML", "version = 1\nscene = \"A.OBJ\"\n"), {});
  EXPECT_TRUE(scenario) << scenario.failure().message;
}

TEST_F(LoadScenario, OnlyAThrownGrenadeIsMissedInASceneTxt) {
  std::filesystem::create_directories(folder_.path() / "Meshes");
  write("Meshes/Box.obj", kTriangle);
  write("a.txt", "Box 0 0 0 0 0 0 1 1 1\n");
  const auto warns = [&](const std::string& events) {
    log_.lines.clear();
    const auto scenario = load_scenario(write("a.toml", "version = 1\nscene = \"a.txt\"\n" + events), {});
    EXPECT_TRUE(scenario) << scenario.failure().message;
    EXPECT_TRUE(scenario && scenario->scene.grenade);
    return log_.has("no object is called Grenade");
  };
  const std::string smoke = "[[event]]\ntype = \"smoke\"\ntime = 0\nat = [0.3, 0.3, 1]\nfrom = ";
  EXPECT_FALSE(warns(""));
  EXPECT_FALSE(warns(smoke + "[0.3, 0.3, 1]\n")) << "it goes off where it is";
  EXPECT_TRUE(warns(smoke + "[0.3, 0.3, 3]\n"));
}

TEST_F(LoadScenario, TheFilesOfATankAreThoseItIsMadeFrom) {
  using Paths = std::vector<std::filesystem::path>;
  scene::TankScene scene;
  scene.palette = "viridis:0-0.5";
  EXPECT_EQ(files_of(scene), Paths{});
  scene.palette = "a/p.json:0-0.5";
  EXPECT_EQ(files_of(scene), Paths{"a/p.json"});
  scene.file = "t.spheres";
  EXPECT_EQ(files_of(scene), Paths{"t.spheres"}) << "it has colours of its own";
}

TEST_F(LoadScenario, ADecalWhoseFileIsGoneIsNamed) {
  write("a.obj", kTriangle);
  const auto scenario =
      load_scenario(write("d.toml", "version = 1\nscene = \"a.obj\"\n[[decal]]\nfile = \"ao.brv\"\n"), {});
  ASSERT_FALSE(scenario);
  EXPECT_EQ(scenario.failure().code, ErrorCode::bad_input);
  EXPECT_NE(scenario.failure().message.find("d.toml:4:8: "), std::string::npos) << scenario.failure().message;
  EXPECT_NE(scenario.failure().message.find("ao.brv"), std::string::npos) << scenario.failure().message;
  EXPECT_EQ(scenario.failure().message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace brume::scenario
