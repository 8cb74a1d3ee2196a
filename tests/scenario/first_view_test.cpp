#include "scenario/first_view.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "scenario/free_place.hpp"
#include "scenario/simulation.hpp"
#include "scenario/smoke_report.hpp"
#include "scene/files/load.hpp"
#include "scene/files/timeline_writer.hpp"
#include "tests/scene/scene_test_tools.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

/// A folder of its own, with a room of `size` units: a box of six walls.
class FirstViewTest : public testing::Test {
 protected:
  /// A box of 1 x 0.5 x 0.7 times `size`, 0.2 `size` above the origin and `east` of it.
  std::filesystem::path box(float size, float east = 0) const {
    const auto path = folder_ / "box.obj";
    std::ofstream out(path);
    out.precision(9);
    for (int corner = 0; corner < 8; ++corner)
      out << "v " << east + size * static_cast<float>(corner & 1) << ' '
          << size * (0.2f + 0.5f * static_cast<float>(corner >> 1 & 1)) << ' '
          << size * 0.7f * static_cast<float>(corner >> 2) << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    return path;
  }

  const cli::WorkFolder work_folder_;
  const std::filesystem::path folder_ = work_folder_.path();
};

TEST_F(FirstViewTest, ScalesByPowersOfTenIntoTheRange) {
  for (const float extent : {1e-5f, 0.3f, 1.0f, 60.0f, 3999.0f, 4001.0f, 36000.0f, 5e5f, 3e8f}) {
    const float scale = fitting_scale(extent), decade = std::log10(scale);
    EXPECT_GE(extent * scale, 0.999f) << extent;
    EXPECT_LE(extent * scale, 4000.5f) << extent;
    EXPECT_NEAR(decade, std::round(decade), 1e-4f) << extent;
    if (extent >= 1 && extent <= 4000) {
      EXPECT_EQ(scale, 1) << extent;
    }
  }
  for (const char* file : {"a.gltf", "a.glb", "a.GLB"}) {
    for (const float extent : {0.25f, 0.72f, 0.84f, 3999.0f})
      EXPECT_EQ(fitting_scale(extent, file), 1) << extent;
    EXPECT_EQ(fitting_scale(0.1f, file), 10);
    EXPECT_LT(fitting_scale(5000, file), 1);
  }
  EXPECT_EQ(fitting_scale(0.72f, "a.obj"), 10);
  EXPECT_EQ(fitting_scale(0), 1);
  EXPECT_EQ(fitting_scale(INFINITY), 1);
}

// The same model in metres, millimetres and hectometres makes the same image: places, sizes and optical
// depths are in proportion.
TEST_F(FirstViewTest, DoesNotDependOnTheUnit) {
  std::optional<Scenario> metres;
  for (const float size : {8.0f, 8000.0f, 80000.0f, 0.08f}) {
    auto scenario = load_scenario(box(size), {});
    ASSERT_TRUE(scenario) << scenario.failure().message;
    if (!metres) {
      metres = std::move(*scenario);
      continue;
    }
    const scene::Timeline &a = metres->timeline, &b = scenario->timeline;
    const float ratio =
        scene::world_bounds(scenario->scene).high.x / scene::world_bounds(metres->scene).high.x;
    EXPECT_NEAR(b.grid.voxel / a.grid.voxel, ratio, 1e-3f * ratio) << size;
    EXPECT_NEAR(static_cast<double>(b.smoke.voxels), static_cast<double>(a.smoke.voxels), 4) << size;
    EXPECT_NEAR(b.smoke.extinction * b.grid.voxel, a.smoke.extinction * a.grid.voxel, 1e-3f) << size;
    EXPECT_LT(glm::length(scenario->camera.position_world / ratio - metres->camera.position_world), 0.01f)
        << size;
    EXPECT_LT(glm::length(b.smokes[0].at_world / ratio - a.smokes[0].at_world), 2 * a.grid.voxel) << size;
  }
}

TEST_F(FirstViewTest, SmokeOfALoneSceneFillsItsVoxels) {
  for (const float size : {0.1f, 1.0f, 30.0f, 700.0f, 2500.0f}) {
    const auto scenario = load_scenario(box(size), {});
    ASSERT_TRUE(scenario) << scenario.failure().message;
    const auto reports = Simulation::create(*scenario).value_or_throw()->report_smokes(*scenario);
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(reports.front().fault, SmokeFault::none) << warning_of(reports.front(), 1, *scenario);
    EXPECT_EQ(reports.front().voxels, reports.front().budget) << size;
    EXPECT_TRUE(scenario->measure_exposure);
  }
}

TEST_F(FirstViewTest, AFloatingModelGetsAGroundOutsideOfItsBounds) {
  scene::Scene scene = scene::load_scene(box(4)).value_or_throw();
  const Box<float> bounds = scene::world_bounds(scene);
  const std::size_t objects = scene.objects.size();
  prepare_first_view("box.obj", scene, {});
  EXPECT_TRUE(scene.camera);
  ASSERT_EQ(scene.objects.size(), objects + 1);
  EXPECT_TRUE(scene.objects.back().backdrop);
  EXPECT_EQ(scene::world_bounds(scene).low.y, bounds.low.y);
}

// A volume alone has the light of the ground below it, and no level whose light could bounce.
TEST_F(FirstViewTest, VolumesAreLitByTheGround) {
  const auto first_view = [](scene::Scene scene, const FirstViewOptions& options) {
    return prepare_first_view("cloud.vdb", scene, options);
  };
  scene::Scene cloud;
  cloud.volumes.push_back({"cloud", {{-1, 1, -1}, {1, 3, 1}}, {{-1, 1, -1}, {1, 3, 1}}});
  const float usual = scene::SkyOptions{}.bounce;
  EXPECT_NEAR(first_view(cloud, {}).sky.bounce, 0.33f, 0.005f) << "the ground's reflectance";
  FirstViewOptions options;
  options.has_ground = false;
  EXPECT_EQ(first_view(cloud, options).sky.bounce, usual);
  EXPECT_EQ(first_view(scene::load_scene(box(4)).value_or_throw(), {}).sky.bounce, usual);
  const LogLines warnings;
  options.picture.bounces = 8;
  first_view(cloud, options);
  EXPECT_EQ(warnings.lines, std::vector<std::string>{"cloud.vdb: bounces change nothing without a level"});
}

TEST_F(FirstViewTest, OptionsReplaceWhatIsChosen) {
  scene::Scene scene = scene::load_scene(box(4)).value_or_throw();
  const FirstViewOptions options{.scale = 2.0f,
                                 .voxel = 0.3f,
                                 .smoke_size = 3.0f,
                                 .smokes = {{1, {0, 1, 0}, {1, 1, 1}}},
                                 .sun = scene::SunOptions{0, 1.5707963f},
                                 .picture = {-1.0f, 8, scene::ToneCurve::standard}};
  const scene::Timeline timeline = prepare_first_view("box.obj", scene, options);
  EXPECT_FLOAT_EQ(scene::world_bounds(scene).high.x, 8);
  EXPECT_EQ(timeline.grid.voxel, 0.3f);
  EXPECT_EQ(timeline.smoke.voxels, 523u) << "a ball of ten voxels across";
  EXPECT_EQ(timeline.smokes[0].time, 1);
  EXPECT_EQ(timeline.exposure, -1);
  EXPECT_EQ(timeline.bounces, 8u);
  EXPECT_EQ(timeline.tone, scene::ToneCurve::standard);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_NEAR(scene.lights[0].direction_world.y, -1, 1e-6f);
}

// A session that the viewer saves is rendered from its timeline alone.
TEST_F(FirstViewTest, SmokeIsBeforeTheCameraThatIsGiven) {
  FirstViewOptions options;
  for (const glm::vec3 eye : {glm::vec3(14, 2, 3), glm::vec3(-9, 2, 3), glm::vec3(4, 2, -12)}) {
    const glm::vec3 target(4, 2.5f, 3);
    options.camera = scene::Camera{eye, target, 1};
    scene::Scene scene = scene::load_scene(box(8)).value_or_throw();
    const scene::Timeline timeline = prepare_first_view(box(8), scene, options);
    ASSERT_EQ(timeline.smokes.size(), 1u);
    const glm::vec3 to_smoke = timeline.smokes[0].at_world - eye, along = glm::normalize(target - eye);
    EXPECT_GT(glm::dot(to_smoke, along), 0);
    EXPECT_LT(glm::dot(to_smoke, along), glm::length(target - eye)) << "behind the wall that is seen";
    EXPECT_LT(glm::length(glm::vec2(to_smoke.x - along.x * glm::dot(to_smoke, along),
                                    to_smoke.z - along.z * glm::dot(to_smoke, along))),
              0.1f);
  }
}

// The grid and the fitted camera reach to smoke anywhere, and to where a grenade goes off.
TEST_F(FirstViewTest, SmokeAnywhereIsInTheGridAndInThePicture) {
  for (const float far : {-1.0f, 3.0f, -30.0f, 900.0f, -10000.0f})
    for (const bool thrown : {false, true}) {
      const glm::vec3 at(far, 0.9f, -3), from = thrown ? at + glm::vec3(0, 2, 2) : at;
      FirstViewOptions options;
      options.smokes = {{0, from, at}};
      const Scenario scenario = load_scenario(box(4), {}, options).value_or_throw();
      const SmokeReport report = Simulation::create(scenario).value_or_throw()->report_smokes(scenario).at(0);
      EXPECT_EQ(report.fault, SmokeFault::none) << warning_of(report, 1, scenario);
      const glm::vec3 eye = scenario.camera.position_world;
      const glm::vec3 off = glm::normalize(report.at_world - eye);
      const glm::vec3 forward = glm::normalize(scenario.camera.target_world - eye);
      const float half = std::tan(scenario.camera.vertical_fov / 2);
      EXPECT_GT(glm::dot(off, forward), 1 / std::hypot(1.0f, half, half * options.aspect)) << far;
    }
}

TEST_F(FirstViewTest, SmokeOutOfReachLeavesTheOthersInTheGrid) {
  scene::Timeline timeline;
  timeline.scene = box(6);
  for (const float x : {-9.0f, 2000.0f, 40.0f}) timeline.smokes.push_back({0, {x, 1, 2}, {x, 1, 2}});
  const Scenario scenario = make_scenario(timeline, {}).value_or_throw();
  const auto reports = Simulation::create(scenario).value_or_throw()->report_smokes(scenario);
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_EQ(reports[0].fault, SmokeFault::none);
  EXPECT_EQ(reports[1].fault, SmokeFault::outside_grid);
  EXPECT_EQ(reports[2].fault, SmokeFault::none);
}

TEST_F(FirstViewTest, ASavedTimelineGivesTheSameLevel) {
  for (const float size : {0.05f, 4.0f, 20000.0f}) {
    const auto path = box(size, 20 * size);
    const Scenario first = load_scenario(path, {}).value_or_throw();
    ASSERT_TRUE(scene::save_timeline(folder_ / "saved.toml", first.timeline));
    const Scenario again = load_scenario(folder_ / "saved.toml", {}).value_or_throw();
    ASSERT_EQ(again.scene.objects.size(), first.scene.objects.size());
    for (std::size_t i = 0; i < first.scene.objects.size(); ++i) {
      const scene::Object &a = first.scene.objects[i], &b = again.scene.objects[i];
      EXPECT_EQ(a.world_from_mesh, b.world_from_mesh) << a.name;
      EXPECT_EQ(a.backdrop, b.backdrop) << a.name;
      const auto &from = first.scene.meshes[a.mesh].vertices, &to = again.scene.meshes[b.mesh].vertices;
      ASSERT_EQ(from.size(), to.size()) << a.name;
      for (std::size_t v = 0; v < from.size(); ++v) EXPECT_EQ(from[v].position, to[v].position) << a.name;
    }
    ASSERT_EQ(again.scene.lights.size(), 1u);
    EXPECT_LT(glm::length(again.scene.lights[0].direction_world - first.scene.lights[0].direction_world),
              1e-6f);
    EXPECT_EQ(again.scene.lights[0].intensity, first.scene.lights[0].intensity);
    EXPECT_EQ(again.voxels.grid.count_solid(), first.voxels.grid.count_solid());
    EXPECT_EQ(again.voxels.grid.layout().origin_world, first.voxels.grid.layout().origin_world);
    EXPECT_EQ(again.timeline.smoke, first.timeline.smoke);
    EXPECT_EQ(again.timeline.smokes.at(0).at_world, first.timeline.smokes.at(0).at_world);
  }
}

TEST_F(FirstViewTest, AFarModelMovesToTheOrigin) {
  const Scenario far = load_scenario(box(8, 43200), {}).value_or_throw();
  EXPECT_EQ(far.timeline.origin, glm::vec3(43204, 4, 3));
  const Box<float> bounds = scene::world_bounds(far.scene);
  EXPECT_LT(glm::length(bounds.low + bounds.high), 2);
  const auto reports = Simulation::create(far).value_or_throw()->report_smokes(far);
  EXPECT_EQ(reports.at(0).voxels, reports.at(0).budget);
}

TEST_F(FirstViewTest, PointLightsAreScaledSoThatTheyLightAlike) {
  scene::Scene scene = scene::load_scene(box(4)).value_or_throw();
  scene.lights.push_back({scene::LightKind::point, {1, 2, 3}, {0, -1, 0}, glm::vec3(5)});
  scale_scene(scene, 3);
  EXPECT_EQ(scene.lights[0].position_world, glm::vec3(3, 6, 9));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(45));
}

// Suns and other lights of any brightness: the sky is as bright beside each, so that a measured exposure
// shows them alike.
TEST_F(FirstViewTest, TheSkyIsAsBrightAsTheLightsAskFor) {
  const auto room = box(8);
  for (const scene::LightKind kind : {scene::LightKind::directional, scene::LightKind::point}) {
    std::optional<glm::vec3> first;
    for (const float intensity : {1e-3f, 1.0f, 150.0f}) {
      scene::Scene scene = scene::load_scene(room).value_or_throw();
      scene::Light light;
      light.kind = kind;
      light.intensity = glm::vec3(intensity);
      light.position_world = {4, 2, 3};
      scene.lights = {light};
      const glm::vec3 sky = prepare_first_view(room, scene, {}).sky.horizon / intensity;
      if (!first) first = sky;
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_GT(sky[channel], 0);
        EXPECT_NEAR(sky[channel], (*first)[channel], 1e-5f * (*first)[channel]) << intensity;
      }
    }
  }
}

// Where a light ends depends on its brightness as little as the picture does.
TEST_F(FirstViewTest, FaintLightsReachAsFarAsBrightOnes) {
  const auto room = box(8);
  const auto least = [&](float intensity) {
    scene::Scene scene = scene::load_scene(room).value_or_throw();
    scene::Light light;
    light.intensity = glm::vec3(intensity);
    light.position_world = {4, 2, 3};
    scene.lights = {light};
    prepare_first_view(room, scene, {});
    return scene.lights[0].least;
  };
  EXPECT_EQ(least(150), scene::Light{}.least);
  EXPECT_LT(least(0.1f), scene::Light{}.least);
  for (const float intensity : {1e-4f, 1e-3f, 1e-2f})
    EXPECT_NEAR(least(intensity) / intensity, least(0.1f) / 0.1f, 1e-4f * least(0.1f) / 0.1f) << intensity;
}

/// A closed room of 6 m with walls, in voxels of 0.25 m, and open air around it.
class SmokeReportTest : public FirstViewTest {
 protected:
  /// The room with a shelf that is solid all through: sheets from 2 to 3 m above the origin, 0.1 m apart.
  SmokeReportTest() {
    std::ofstream out(box(6), std::ios::app);
    for (int sheet = 0; sheet <= 10; ++sheet) {
      for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(0, 4), glm::vec2(1, 4), glm::vec2(1, 0)})
        out << "v " << corner.x << ' ' << 2 + 0.1 * sheet << ' ' << corner.y << '\n';
      out << "f -4 -3 -2 -1\n";
    }
  }
  Scenario scenario(glm::vec3 from, glm::vec3 at, double time = 0) const {
    scene::Timeline timeline;
    timeline.scene = folder_ / "box.obj";
    timeline.smoke.voxels = 2000;
    timeline.smokes = {{time, from, at}};
    return make_scenario(timeline, {}).value_or_throw();
  }
  SmokeReport report(const Scenario& scenario) const {
    return Simulation::create(scenario).value_or_throw()->report_smokes(scenario).at(0);
  }
};

TEST_F(SmokeReportTest, TheGridReachesToSmokeBesideTheScene) {
  const glm::vec3 inside{3, 2, 2}, beside{-9, 1, -4};
  EXPECT_EQ(report(scenario(beside, beside)).fault, SmokeFault::none);
  EXPECT_GT(scenario(beside, beside).voxels.grid.layout().size.x,
            scenario(inside, inside).voxels.grid.layout().size.x);
}

TEST_F(SmokeReportTest, NamesWhatIsWrongAndAPlaceThatWorks) {
  const glm::vec3 inside{3, 2, 2}, shelf{0.5f, 2.5f, 2}, far{2000, 1, 0};
  const Scenario good = scenario(inside, inside);
  EXPECT_EQ(report(good).fault, SmokeFault::none);
  EXPECT_EQ(report(good).voxels, 2000u);
  EXPECT_EQ(warning_of(report(good), 1, good), "");
  for (const auto& [at, fault, words] : {std::tuple(shelf, SmokeFault::in_solid, "lies in something solid"),
                                         std::tuple(far, SmokeFault::outside_grid, "is outside the grid")}) {
    const Scenario bad = scenario(at, at);
    const SmokeReport found = report(bad);
    EXPECT_EQ(found.fault, fault);
    EXPECT_NE(warning_of(found, 1, bad).find(words), std::string::npos) << warning_of(found, 1, bad);
    ASSERT_TRUE(found.works_at);
    const Scenario mended = scenario(*found.works_at, *found.works_at);
    EXPECT_EQ(report(mended).fault, SmokeFault::none);
  }
}

// 10 cm from a surface in voxels of 25 cm: smoke begins on its side of it, in the next voxel.
TEST_F(SmokeReportTest, SmokeBesideASurfaceIsNotInIt) {
  const Box<float> room{{0, 1.2f, 0}, {6, 4.2f, 4.2f}};  // box(6)
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true})
      for (const float off : {0.0f, 0.01f, 0.1f, 0.24f})
        for (const bool is_inside : {false, true}) {
          glm::vec3 at(3.5f, 3.5f, 2.1f);
          const float sign = is_high == is_inside ? -1.0f : 1.0f;
          at[axis] = (is_high ? room.high : room.low)[axis] + sign * off;
          const Scenario placed = scenario(at, at);
          const SmokeReport found = report(placed);
          EXPECT_EQ(found.fault, SmokeFault::none) << warning_of(found, 1, placed);
          // At most the diagonal of two voxels away, and on the same side.
          EXPECT_LE(glm::distance(found.at_world, at), 0.5f * std::sqrt(3.0f));
          if (off > 0) {
            EXPECT_EQ(room.contains(found.at_world), is_inside) << axis << ' ' << is_high << ' ' << off;
          }
        }
}

// A thin floor with a block on it: the nearest free voxels of a place in the floor are below it.
TEST(NearestFreePlace, IsAboveAFloorWhereThereIsOne) {
  voxel::BitGrid grid({{24, 24, 24}, 1, glm::vec3(0)});
  for (int z = 0; z < 24; ++z)
    for (int x = 0; x < 24; ++x) grid.set({x, 6, z}, true);
  EXPECT_EQ(nearest_free_place(grid, {12.5f, 6.5f, 12.5f}, 100), glm::vec3(12.5f, 7.5f, 12.5f));
  for (int y = 7; y < 11; ++y)
    for (int z = 8; z < 17; ++z)
      for (int x = 8; x < 17; ++x) grid.set({x, y, z}, true);
  const auto place = nearest_free_place(grid, {12.5f, 6.5f, 12.5f}, 100);
  ASSERT_TRUE(place);
  EXPECT_GT(place->y, 7);
}

TEST(NearestFreePlace, IsTheNearestWhereNothingIsBelow) {
  voxel::BitGrid grid({{24, 24, 24}, 1, glm::vec3(0)});
  EXPECT_EQ(nearest_free_place(grid, {12.5f, 6.5f, 12.5f}, 100), glm::vec3(12.5f, 6.5f, 12.5f));
  EXPECT_EQ(nearest_free_place(grid, {-3, 6.5f, 12.5f}, 100), glm::vec3(0.5f, 6.5f, 12.5f));
}

TEST_F(SmokeReportTest, ReportsThrowsThatEndTooLate) {
  // The timeline ends after four seconds.
  const Scenario late = scenario({3, 2, 2}, {3, 2, 2}, 10);
  EXPECT_EQ(report(late).fault, SmokeFault::after_end);
  EXPECT_NEAR(report(late).time, 10, 0.02);
}

}  // namespace
}  // namespace brume::scenario
