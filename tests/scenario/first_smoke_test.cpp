#include "scenario/first_smoke.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "scenario/scenario.hpp"
#include "scene/files/load.hpp"
#include "tests/log_lines.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

/// Boxes and tori in an OBJ file of its own.
class FirstSmokeTest : public testing::Test {
 protected:
  void add_box(glm::vec3 low, glm::vec3 high) {
    const int first = count_ + 1;
    for (int corner = 0; corner < 8; ++corner)
      add_vertex(glm::mix(low, high, glm::bvec3(corner & 1, corner & 2, corner & 4)));
    for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                     std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
      faces_ << "f " << first + a << ' ' << first + b << ' ' << first + c << ' ' << first + d << '\n';
  }

  /// Around axis 0, 1 or 2, of 1.25 m with a hole of 0.75 m.
  void add_torus(int axis) {
    constexpr int kAround = 32, kAcross = 12;
    constexpr float kTurn = 2 * std::numbers::pi_v<float>;
    const int first = count_ + 1;
    for (int i = 0; i < kAround; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const float a = kTurn * static_cast<float>(i) / kAround, b = kTurn * static_cast<float>(j) / kAcross;
        const float r = 1 + 0.25f * std::cos(b);
        glm::vec3 p;
        p[axis] = 0.25f * std::sin(b);
        p[(axis + 1) % 3] = r * std::cos(a);
        p[(axis + 2) % 3] = r * std::sin(a);
        add_vertex(p);
        const int in = (i + 1) % kAround, jn = (j + 1) % kAcross;
        faces_ << "f " << first + i * kAcross + j << ' ' << first + i * kAcross + jn << ' '
               << first + in * kAcross + jn << ' ' << first + in * kAcross + j << '\n';
      }
  }

  std::filesystem::path path() const {
    std::ofstream(folder_ / "a.obj") << vertices_.str() << faces_.str();
    return folder_ / "a.obj";
  }

  Scenario load(const FirstViewOptions& options, std::vector<std::string>& said) const {
    const LogLines log;
    auto loaded = load_scenario(path(), {}, options);
    said = log.lines;
    return std::move(loaded).value_or_throw();
  }

  /// Loads the file and expects one smoke that is seen, on the camera's side of the middle of the scene.
  void expect_seen(const FirstViewOptions& options = {}) const {
    std::vector<std::string> said;
    const Scenario scenario = load(options, said);
    ASSERT_EQ(scenario.timeline.smokes.size(), 1u);
    const SmokeView view{options.camera.value_or(scenario.camera), options.aspect, true};
    const scene::SmokeOptions& smoke = scenario.timeline.smoke;
    const float diameter =
        2 * std::cbrt(static_cast<float>(smoke.voxels) * 0.75f / 3.14159f) * scenario.timeline.grid.voxel;
    EXPECT_TRUE(is_smoke_seen(scenario.scene, view, scenario.timeline.smokes[0].at_world, diameter));
    EXPECT_TRUE(said.empty()) << said.front();
  }

 private:
  void add_vertex(glm::vec3 p) {
    vertices_ << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    ++count_;
  }

  const cli::WorkFolder work_folder_;
  const std::filesystem::path folder_ = work_folder_.path();
  std::ostringstream vertices_, faces_;
  int count_ = 0;
};

float depth_of(const scene::Camera& camera, glm::vec3 point) {
  return glm::dot(point - camera.position_world, glm::normalize(camera.target_world - camera.position_world));
}

// The middle of the view is in the hole of a torus, whichever side it shows: its smoke is before it.
TEST_F(FirstSmokeTest, IsBeforeWhatHasAHoleInTheMiddleOfTheView) {
  for (int axis = 0; axis < 3; ++axis) {
    add_torus(axis);
    expect_seen();
    const Scenario scenario = load_scenario(path(), {}).value_or_throw();
    EXPECT_LT(depth_of(scenario.camera, scenario.timeline.smokes[0].at_world), depth_of(scenario.camera, {}))
        << axis;
  }
}

TEST_F(FirstSmokeTest, IsBeforeAnArch) {
  add_box({-1.5f, 0, 0}, {-1, 3, 0.5f});
  add_box({1, 0, 0}, {1.5f, 3, 0.5f});
  add_box({-1.5f, 3, 0}, {1.5f, 3.5f, 0.5f});
  expect_seen();
  FirstViewOptions options;
  for (const glm::vec3 eye : {glm::vec3(0, 1.5f, 9), glm::vec3(0, 1.5f, -9), glm::vec3(5, 6, 7)}) {
    options.camera = scene::Camera{eye, {0, 1.5f, 0.25f}, 0.9f};
    expect_seen(options);
  }
}

// From above the edge of a table, where the floor that is below the edge is out of view or behind the table.
TEST_F(FirstSmokeTest, IsInViewWhereTheFloorIsNot) {
  add_box({-2, 3, -2}, {2, 3.2f, 2});
  add_box({-2, 0, -2}, {2, 0.1f, 2});
  FirstViewOptions options;
  options.camera = scene::Camera{{0, 3.6f, 7}, {0, 3.4f, 0}, 0.2f};
  expect_seen(options);
}

TEST_F(FirstSmokeTest, IsInARoomThatTheCameraIsIn) {
  add_box({-4, -0.2f, -4}, {4, 0, 4});
  add_box({-4, 3, -4}, {4, 3.2f, 4});
  for (const float side : {-4.0f, 3.8f}) {
    add_box({side, 0, -4}, {side + 0.2f, 3, 4});
    add_box({-4, 0, side}, {4, 3, side + 0.2f});
  }
  FirstViewOptions options;
  for (const glm::vec3 target : {glm::vec3(0, 1.5f, 3), glm::vec3(3, 1, 0), glm::vec3(0.1f, 3, 0.2f)}) {
    options.camera = scene::Camera{{0, 1.6f, -1}, target, 1};
    expect_seen(options);
  }
}

// A model with a camera of its own, which sees room beside it: the ray to its middle misses the smoke.
TEST_F(FirstSmokeTest, StandsBesideASmallModelOfItsOwnCamera) {
  add_box({-0.8f, 0, -0.6f}, {0.8f, 1.5f, 0.6f});
  const scene::Scene scene = scene::load_scene(path()).value_or_throw();
  const glm::vec3 middle(0, 0.75f, 0);
  const auto off_middle = [&](const SmokeView& view, float diameter) {
    const glm::vec3 eye = view.camera.position_world, along = glm::normalize(middle - eye);
    const glm::vec3 place = choose_smoke_place(scene, view, diameter);
    EXPECT_TRUE(is_smoke_seen(scene, view, place, diameter));
    const glm::vec3 smoke = place + glm::vec3(0, 0.25f * diameter, 0) - eye;
    return glm::length(smoke - glm::dot(smoke, along) * along);
  };
  for (const glm::vec3 eye : {glm::vec3(4, 4.6f, -4.3f), glm::vec3(0, 1, 7), glm::vec3(-6, 2, 1)}) {
    SmokeView view{scene::Camera{eye, {0.3f, 0.4f, -0.4f}, 0.66f}, 16.0f / 9.0f, true, true};
    for (const float diameter : {0.6f, 1.2f, 1.8f})
      EXPECT_GT(off_middle(view, diameter), 0.5f * diameter) << eye.x << ' ' << diameter;
    // A camera that is given may be one on the smoke.
    view.is_of_scene = false;
    EXPECT_LT(off_middle(view, 1.2f), 0.6f) << eye.x;
  }
  // Where there is no room in view, it is before the model.
  const SmokeView near{scene::Camera{{0, 1, 3.2f}, {0, 0.75f, 0}, 0.6f}, 16.0f / 9.0f, true, true};
  EXPECT_LT(off_middle(near, 1.2f), 0.6f);
}

// Inside of a wall, where no smoke fits: one line.
TEST_F(FirstSmokeTest, WarnsWhereNoneIsSeen) {
  add_box({0, 0, 0}, {0.2f, 3, 6});
  add_box({0, 0, 0}, {6, 3, 0.2f});
  FirstViewOptions options;
  options.voxel = 0.25f;
  options.camera = scene::Camera{{0.1f, 1.5f, 2}, {0.1f, 1.5f, 5}, 1};
  std::vector<std::string> said;
  load(options, said);
  EXPECT_EQ(said, std::vector{path().string() +
                              ": the smoke is hidden or out of the picture; choose a place with --smoke"});
}

}  // namespace
}  // namespace brume::scenario
