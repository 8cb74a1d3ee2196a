// What a window shows of a tank, without a window.
#include "apps/viewer/tank_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "apps/viewer/job.hpp"
#include "apps/viewer/tank_mouse.hpp"
#include "apps/viewer/tank_refiner.hpp"
#include "scene/files/tank_reader.hpp"
#include "scene/files/tank_writer.hpp"

namespace brume::viewer {
namespace {

constexpr glm::vec2 kSize(640, 360);
// Of a point that is projected in floats: coordinates of at most 1000 pixels, of which 24 bits are left after
// some ten operations, 1000 * 10 * 2^-24 = 0.0006.
constexpr float kPixels = 0.01f;

scene::TankScene keyed_scene() {
  scene::TankScene scene;
  scene.duration = 4;
  scene.lights = {{{0.5f, 1, 0.8f}}, {{-0.5f, 0.2f, 1}}};
  scene.lights[1].keys = {{1, {-0.5f, 0.2f, 1}}, {3, {0.5f, 0.2f, 1}}};
  scene.glass.emplace();
  scene.glass->position_world = {0.1f, 0.2f, 0.9f};
  scene::CameraKey key;
  key.camera.position_world = {0.3f, 0.4f, 3};
  key.camera.target_world = {0, 0.1f, 0};
  scene.camera = {key};
  return scene;
}

scene::Camera camera_of_test() {
  return keyed_scene().camera[0].camera;
}

TEST(TankCameraTest, OrbitsAtTheSameDistanceWithTheTargetInTheMiddle) {
  const scene::Camera camera = camera_of_test();
  const auto distance = [](const scene::Camera& c) {
    return glm::distance(c.position_world, c.target_world);
  };
  for (const glm::vec2 drag :
       {glm::vec2(0.2f, 0), glm::vec2(-0.4f, 0.3f), glm::vec2(3, 9), glm::vec2(0, -9)}) {
    const scene::Camera moved = orbited(camera, drag);
    EXPECT_NEAR(distance(moved), distance(camera), 1e-5f);
    EXPECT_EQ(moved.target_world, camera.target_world);
    const auto middle = in_picture(moved, kSize, moved.target_world);
    ASSERT_TRUE(middle);
    EXPECT_NEAR(glm::distance(*middle, 0.5f * kSize), 0, kPixels);
  }
  // The picture follows the mouse: what is before the target moves to the right with it, and down.
  const glm::vec3 before = glm::mix(camera.target_world, camera.position_world, 0.2f);
  const glm::vec2 right = *in_picture(orbited(camera, {0.05f, 0}), kSize, before);
  const glm::vec2 down = *in_picture(orbited(camera, {0, 0.05f}), kSize, before);
  EXPECT_GT(right.x, 0.5f * kSize.x + 1);
  EXPECT_GT(down.y, 0.5f * kSize.y + 1);
}

TEST(TankCameraTest, WhatIsPannedStaysUnderTheMouse) {
  const scene::Camera camera = camera_of_test();
  const glm::vec2 drag(37, -21);
  const auto after = in_picture(panned(camera, drag / kSize.y), kSize, camera.target_world);
  ASSERT_TRUE(after);
  EXPECT_NEAR(glm::distance(*after, 0.5f * kSize + drag), 0, kPixels);
}

TEST(TankCameraTest, ZoomsTowardsTheTargetAndNeverPastIt) {
  const scene::Camera camera = camera_of_test();
  const auto distance = [](const scene::Camera& c) {
    return glm::distance(c.position_world, c.target_world);
  };
  EXPECT_NEAR(distance(zoomed(camera, 1)), 0.9f * distance(camera), 1e-5f);
  EXPECT_NEAR(distance(zoomed(zoomed(camera, 3), -3)), distance(camera), 1e-5f);
  EXPECT_GT(distance(zoomed(camera, 1000)), 0);
}

TEST(TankHandleTest, AMarkIsDraggedToWhereTheMouseIs) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(-1, 1);
  for (int round = 0; round < 200; ++round) {
    scene::TankScene scene = keyed_scene();
    const scene::Camera camera = orbited(camera_of_test(), {u(random), 0.4f * u(random)});
    const double time = 2 * std::abs(double(u(random)));
    for (const TankHandle& handle : handles_of(scene)) {
      const glm::vec3 place = place_of(scene, handle, time);
      const auto mark = in_picture(camera, kSize, place);
      ASSERT_TRUE(mark);
      const glm::vec2 drag = 100.0f * glm::vec2(u(random), u(random));
      move_handle(scene, handle, time, dragged(camera, drag / kSize.y, place));
      const glm::vec3 moved = place_of(scene, handle, time);
      // The drag is in the plane of the picture, and under the mouse.
      EXPECT_NEAR(depth_of(camera, moved), depth_of(camera, place), 1e-5f);
      EXPECT_NEAR(glm::distance(*in_picture(camera, kSize, moved), *mark + drag), 0, kPixels);
    }
  }
}

TEST(TankHandleTest, KeysMoveTogether) {
  scene::TankScene scene = keyed_scene();
  const TankHandle handle{TankHandle::Kind::light, 1};
  const glm::vec3 by(0.25f, 0.5f, -0.125f);
  move_handle(scene, handle, 2, place_of(scene, handle, 2) + by);
  const std::vector<scene::PlaceKey> before = keyed_scene().lights[1].keys;
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(glm::distance(scene.lights[1].keys[i].position_world, before[i].position_world + by), 0,
                1e-6f);
}

TEST(TankHandleTest, TheNearestMarkInReachIsTaken) {
  const scene::TankScene scene = keyed_scene();
  const scene::Camera camera = camera_of_test();
  const TankHandle light{TankHandle::Kind::light, 0};
  const glm::vec2 mark = *in_picture(camera, kSize, place_of(scene, light, 0));
  EXPECT_EQ(handle_at(scene, 0, camera, kSize, mark + glm::vec2(5, 0), 12), light);
  EXPECT_EQ(handle_at(scene, 0, camera, kSize, mark + glm::vec2(0, 13), 12), std::nullopt);
}

TEST(TankHandleTest, AMarkBesideThePictureIsAtItsEdge) {
  const scene::Camera camera = camera_of_test();
  const auto beside = mark_in(camera, kSize, camera.target_world + glm::vec3(9, 0, 0));
  ASSERT_TRUE(beside);
  EXPECT_TRUE(beside->is_at_edge);
  EXPECT_LT(beside->at.x, kSize.x);
  EXPECT_GT(beside->at.x, kSize.x - 20);
  const auto inside = mark_in(camera, kSize, camera.target_world);
  ASSERT_TRUE(inside);
  EXPECT_FALSE(inside->is_at_edge);
  EXPECT_FALSE(mark_in(camera, kSize, camera.position_world + glm::vec3(0, 0, 1)));
}

TEST(TankFocusTest, IsTheFirstSphereAheadElseTheMiddle) {
  spheres::Tank tank;
  tank.size = {100, 100, 100};
  tank.voxel = 0.01f;
  scene::Camera camera;
  camera.position_world = {0, 0, 3};
  camera.target_world = {0, 0, 0};
  EXPECT_NEAR(distance_ahead(camera, tank), 3, 1e-6f);
  tank.spheres = {{{50, 50, 20}, 10}, {{50, 50, 80}, 10}, {{20, 50, 95}, 5}};
  // The sphere around z = 0.3 m with a radius of 0.1 m.
  EXPECT_NEAR(distance_ahead(camera, tank), 2.6f, 1e-5f);
}

TEST(TankStateTest, TimeRunsInALoopAndStaysInRange) {
  TankState state(keyed_scene(), glm::vec3(1));
  state.advance(1);
  EXPECT_EQ(state.seconds(), 0);
  state.set_playing(true);
  state.advance(3.5);
  EXPECT_EQ(state.seconds(), 3.5);
  state.advance(1);
  EXPECT_EQ(state.seconds(), 0.5);
  state.seek(99);
  EXPECT_EQ(state.seconds(), 4);
  state.seek(-1);
  EXPECT_EQ(state.seconds(), 0);
}

TEST(TankStateTest, UndoesEditsOneByOne) {
  TankState state(keyed_scene(), glm::vec3(1));
  state.edit().exposure = 1;
  state.edit().exposure = 2;  // of the same drag
  state.settle();
  state.settle();
  state.edit().lights.clear();
  state.settle();
  state.undo();
  EXPECT_EQ(state.scene().lights.size(), 2u);
  EXPECT_EQ(state.scene().exposure, 2);
  state.undo();
  EXPECT_EQ(state.scene().exposure, 0);
  state.undo();
  EXPECT_EQ(state.scene().exposure, 0);
  state.redo();
  state.redo();
  state.redo();
  EXPECT_TRUE(state.scene().lights.empty());
}

TEST(TankStateTest, AnInputLeavesThePathAndHomeReturnsToIt) {
  TankState state(keyed_scene(), glm::vec3(1));
  EXPECT_TRUE(state.follows_path());
  const scene::Camera home = state.camera();
  state.move_camera(orbited(home, {0.1f, 0}));
  EXPECT_FALSE(state.follows_path());
  EXPECT_NE(state.camera().position_world, home.position_world);
  state.go_home();
  EXPECT_EQ(state.camera().position_world, home.position_world);
}

TEST(TankStateTest, KeysAreAddedInOrderAndReplaced) {
  TankState state(keyed_scene(), glm::vec3(1));
  for (const double time : {3.0, 1.0, 2.0, 1.0}) {
    state.seek(time);
    state.add_camera_key();
    state.add_light_key(0);
    state.add_glass_key();
  }
  ASSERT_EQ(state.scene().camera.size(), 4u);  // with the first, at 0
  EXPECT_EQ(state.scene().camera[1].time, 1);
  EXPECT_EQ(state.scene().lights[0].keys.size(), 3u);
  EXPECT_EQ(state.scene().glass->keys.size(), 3u);
  EXPECT_TRUE(scene::parse_tank_scene(scene::format_tank_scene(state.to_save(), ""), "t.toml"));
}

TEST(TankStateTest, ASnapshotShowsWhatTheWindowDid) {
  spheres::Tank tank;
  tank.size = {60, 60, 20};
  TankState state(keyed_scene(), planning::size_of(tank));
  state.seek(2.25);
  state.move_camera(orbited(state.camera(), {0.2f, 0.1f}));
  state.edit().pack.count = 7;  // not packed
  const scene::TankScene shot = state.snapshot(13);
  EXPECT_EQ(shot.samples, 13u);
  EXPECT_EQ(shot.pack.count, spheres::PackOptions().count);
  const TankState again(shot, planning::size_of(tank));
  EXPECT_TRUE(
      planning::same_samples(plan_picture(state, tank, {64, 36}), plan_picture(again, tank, {64, 36})));
}

TEST(TankStateTest, DiffersFromItsTankOnlyByWhatPacksIt) {
  TankState state(keyed_scene(), glm::vec3(1));
  state.edit().exposure = 3;
  EXPECT_FALSE(state.differs_from_packed());
  state.edit().pack.seed = 3;
  EXPECT_TRUE(state.differs_from_packed());
  state.set_packed(state.scene(), glm::vec3(1), true);
  EXPECT_FALSE(state.differs_from_packed());
  state.edit().palette = "viridis";
  EXPECT_TRUE(state.differs_from_packed());
}

// Whatever shows in a picture begins it again; the exposure does not.
TEST(TankRestartTest, AnyVisibleChangeBeginsThePictureAgain) {
  const spheres::Tank tank;
  const auto plan_after = [&](const std::function<void(scene::TankScene&)>& change, double seconds = 0) {
    scene::TankScene scene = keyed_scene();
    change(scene);
    TankState state(scene, glm::vec3(1));
    state.seek(seconds);
    return plan_picture(state, tank, {64, 36});
  };
  const planning::TankPlan still = plan_after([](scene::TankScene&) {});
  const auto restarts = [&](const std::function<void(scene::TankScene&)>& change) {
    return !planning::same_samples(still, plan_after(change));
  };
  EXPECT_FALSE(restarts([](auto&) {}));
  EXPECT_FALSE(restarts([](auto& s) { s.exposure = 1; }));
  EXPECT_FALSE(restarts([](auto& s) { s.tone = scene::ToneCurve::standard; }));
  EXPECT_FALSE(restarts([](auto& s) { s.samples = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.bounces = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.photons = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.view = scene::TankView::voxels; }));
  EXPECT_TRUE(restarts([](auto& s) { s.lighting = scene::TankLighting::exact; }));
  EXPECT_TRUE(restarts([](auto& s) { s.fog.extinction = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.sky.ambient.x = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.lights[0].intensity = 1; }));
  EXPECT_TRUE(restarts([](auto& s) { s.lights.pop_back(); }));
  EXPECT_TRUE(restarts([](auto& s) { s.glass.reset(); }));
  EXPECT_TRUE(restarts([](auto& s) { s.camera[0].camera.lens.aperture = 0.1f; }));
  EXPECT_FALSE(planning::same_samples(still, plan_after([](auto&) {}, 2)));  // a light has moved
}

TEST(TankScheduleTest, DrawsLessWhileSomethingMovesAndAllAtRest) {
  constexpr glm::uvec2 kWindow(640, 360);
  constexpr double kSeconds = 0.25;
  TankSchedule schedule;
  schedule.measured(kSeconds, kWindow, {1, 0});
  const glm::uvec2 moving = schedule.picture_px(kWindow, true);
  EXPECT_LT(moving.x, kWindow.x);
  EXPECT_LE(moving.x * moving.y * kSeconds / (kWindow.x * kWindow.y), TankSchedule::kMoving);
  EXPECT_EQ(schedule.picture_px(kWindow, false), kWindow);

  // On a fast device the picture has the window's size all the time, and many samples a frame.
  TankSchedule fast;
  fast.measured(0.0001, kWindow, {1, 0});
  EXPECT_EQ(fast.picture_px(kWindow, true), kWindow);
  EXPECT_EQ(fast.next(kWindow, 0, 0, 1000, true).samples, TankSchedule::kMostSamples);
}

TEST(TankScheduleTest, SlicesAddUpToAllSamples) {
  for (const double seconds : {1e-5, 0.02, 0.09, 0.25, 30.0}) {
    constexpr glm::uvec2 kPicture(640, 357);
    TankSchedule schedule;
    schedule.measured(seconds, kPicture, {1, 0});
    std::uint32_t samples = 0, rows = 0;
    for (int frames = 0;; ++frames) {
      ASSERT_LT(frames, 1000);
      const render::TankSlice slice = schedule.next(kPicture, samples, rows, 17, false);
      if (slice.samples == 0 && slice.rows == 0) break;
      ASSERT_TRUE(slice.samples == 0 || rows == 0);
      samples += slice.samples;
      rows += slice.rows;
      ASSERT_LE(rows, kPicture.y);
      ASSERT_TRUE(rows == kPicture.y || rows % render::TankSampler::kRows == 0);
      if (rows == kPicture.y) ++samples, rows = 0;
    }
    EXPECT_EQ(samples, 17u);
    EXPECT_EQ(rows, 0u);
  }
}

TEST(TankMouseTest, DragsMarksAndTheCamera) {
  TankState state(keyed_scene(), glm::vec3(1));
  TankChoices choices;
  TankMouse mouse;
  Input nothing, pressed, held;
  pressed.pressed = {Action::orbit};
  pressed.held[static_cast<std::size_t>(Action::orbit)] = true;
  held.held = pressed.held;

  // Beside all marks the camera moves.
  const scene::Camera before = state.camera();
  mouse.update(state, choices, pressed, {10, 10}, kSize, true);
  mouse.update(state, choices, held, {40, 20}, kSize, true);
  EXPECT_TRUE(mouse.is_dragging());
  mouse.update(state, choices, nothing, {40, 20}, kSize, true);
  EXPECT_FALSE(mouse.is_dragging());
  EXPECT_NE(state.camera().position_world, before.position_world);
  EXPECT_EQ(choices.selected, std::nullopt);

  // On the mark of a light, the light moves.
  const TankHandle light{TankHandle::Kind::light, 0};
  const scene::Camera camera = state.camera();
  const glm::vec2 mark = *in_picture(camera, kSize, place_of(state.scene(), light, 0));
  mouse.update(state, choices, pressed, mark, kSize, true);
  mouse.update(state, choices, held, mark + glm::vec2(30, -20), kSize, true);
  mouse.update(state, choices, nothing, mark + glm::vec2(30, -20), kSize, true);
  EXPECT_EQ(choices.selected, light);
  EXPECT_EQ(state.camera().position_world, camera.position_world);
  const glm::vec2 after = *in_picture(camera, kSize, place_of(state.scene(), light, 0));
  EXPECT_NEAR(glm::distance(after, mark + glm::vec2(30, -20)), 0, kPixels);

  // What is dragged may be undone meanwhile.
  mouse.update(state, choices, pressed, after, kSize, true);
  state.edit().lights.clear();
  mouse.update(state, choices, held, after + 1.0f, kSize, true);
  EXPECT_FALSE(mouse.is_dragging());
}

TEST(JobTest, StopsWithWhatThereIs) {
  bool is_stopped = false;
  Job job([&](const std::function<bool()>& stopped) {
    while (!stopped()) {
    }
    is_stopped = true;
  });
  EXPECT_FALSE(job.wait(0));
  job.stop();
  job.take();
  EXPECT_TRUE(is_stopped);

  Job failing([](const std::function<bool()>&) { throw Error(ErrorCode::bad_input, "none"); });
  EXPECT_THROW(failing.take(), Error);
}

}  // namespace
}  // namespace brume::viewer
