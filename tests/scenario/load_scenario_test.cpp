#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/log.hpp"
#include "scenario/scenario.hpp"
#include "scenario/tank.hpp"

namespace brume::scenario {
namespace {

class LoadScenario : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("brume_load_scenario_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    set_log_callback([this](LogLevel, const std::string& line) { log_.push_back(line); });
  }
  void TearDown() override {
    set_log_callback({});
    std::filesystem::remove_all(folder_);
  }
  std::filesystem::path write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::filesystem::path folder_;
  std::vector<std::string> log_;
};

constexpr const char* kTriangle = "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(LoadScenario, ASceneWithoutATimelineIsReadOnce) {
  const auto scenario = load_scenario(write("a.obj", kTriangle), {});
  ASSERT_TRUE(scenario) << scenario.failure().message;
  const auto warns = [](const std::string& line) { return line.find("gone.mtl") != std::string::npos; };
  EXPECT_EQ(std::count_if(log_.begin(), log_.end(), warns), 1);
}

TEST_F(LoadScenario, SuffixesMayBeInCapitals) {
  write("A.OBJ", kTriangle);
  const auto scenario = load_scenario(write("D.TOML", "version = 1\nscene = \"A.OBJ\"\n"), {});
  EXPECT_TRUE(scenario) << scenario.failure().message;
}

TEST_F(LoadScenario, OnlyAThrownGrenadeIsMissedInASceneTxt) {
  std::filesystem::create_directories(folder_ / "Meshes");
  std::ofstream(folder_ / "Meshes/Box.obj") << kTriangle;
  write("a.txt", "Box 0 0 0 0 0 0 1 1 1\n");
  const auto warns = [&](const std::string& events) {
    log_.clear();
    const auto scenario = load_scenario(write("a.toml", "version = 1\nscene = \"a.txt\"\n" + events), {});
    EXPECT_TRUE(scenario) << scenario.failure().message;
    EXPECT_TRUE(scenario && scenario->scene.grenade);
    return std::ranges::any_of(
        log_, [](const std::string& line) { return line.find("no object is called Grenade") != line.npos; });
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
