// A game without a window: steering carriers, their keys, decals and masks.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "apps/viewer/carrier_keys.hpp"
#include "apps/viewer/game_frame.hpp"
#include "apps/viewer/option_panel.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/timeline_writer.hpp"
#include "tests/viewer/foggy_room.hpp"

namespace brume::viewer {
namespace {

constexpr float kNear = 1e-4f;  // a few roundings of matrices with entries up to 10

class CarriersTest : public testing::Test {
 protected:
  CarriersTest() { write_busy_room(folder_); }

  Game& start(const std::string& name = "busy.toml") {
    auto scenario = scenario::load_scenario(folder_.path() / name, {}).value_or_throw();
    game_.emplace(Session::create(std::move(scenario), false).value_or_throw(), Choices(),
                  [this](const std::string& line) { lines_.push_back(line); });
    game_->session().set_paused(true);
    return *game_;
  }
  void act(Action action) { game_->act(action, glm::vec3(0, 0, -1)); }
  static Input holding(Action action) {
    Input input;
    input.held[static_cast<std::size_t>(action)] = true;
    return input;
  }
  const scene::Timeline& timeline() const { return game_->session().live().scenario().timeline; }
  const std::vector<scene::CarrierKey>& keys() const { return timeline().carriers[0].keys; }
  /// What moves with the crane: the block, the second volume and the second decal.
  std::vector<glm::mat4> places() {
    const render::FrameInput input = frame_input(*game_, holes_);
    return {input.level.moved.at(0).world_from_mesh, input.volumes.at(1).world_from_voxel,
            input.decals.at(1).world_from_box};
  }
  glm::vec3 eye() const { return game_->player().camera().position_world; }

  cli::WorkFolder folder_;
  std::optional<Game> game_;
  std::vector<std::string> lines_;
  std::vector<shared::Hole> holes_;
};

void expect_near(const glm::mat4& a, const glm::mat4& b, int line) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(a[column][row], b[column][row], kNear) << "line " << line << ": " << column << ", " << row;
}

TEST_F(CarriersTest, WhatMovesWithACarrierFollowsThePlayer) {
  Game& game = start();
  const std::vector<glm::mat4> before = places();
  const glm::mat4 fixed = frame_input(game, holes_).volumes.at(0).world_from_voxel;
  act(Action::steer_carrier);
  ASSERT_TRUE(game.flight());
  game.move({}, 0.1);
  for (std::size_t i = 0; i < before.size(); ++i) expect_near(places()[i], before[i], __LINE__);

  // 0.2 s upwards, then a turn of 100 pixels to the right.
  const scene::CarrierKey begun = game.carrier_pose();
  const std::uint64_t changes = game.changes();
  game.move(holding(Action::up), 0.2);
  const float height = 0.2f * game.player().options().fly_speed;
  Input turn;
  turn.look_px = {100, 0};
  game.move(turn, 0.01);
  EXPECT_GT(game.changes(), changes);
  const float degrees = glm::degrees(100 * Player::kRadiansPerPixel);
  const scene::CarrierKey pose = game.carrier_pose();
  EXPECT_NEAR(pose.position_world.y - begun.position_world.y, height, kNear);
  EXPECT_NEAR(begun.rotation.y - pose.rotation.y, degrees, 1e-3f);
  // Up, and around the carrier.
  const auto to = [](glm::vec3 place) { return glm::translate(glm::mat4(1), place); };
  const glm::mat4 moved = to(pose.position_world) * scene::rotation_of(pose.rotation) *
                          glm::inverse(to(begun.position_world) * scene::rotation_of(begun.rotation));
  const std::vector<glm::mat4> after = places();
  for (std::size_t i = 0; i < after.size(); ++i) expect_near(after[i], moved * before[i], __LINE__);
  expect_near(frame_input(game, holes_).volumes.at(0).world_from_voxel, fixed, __LINE__);

  // Time moves nothing that is steered, and at the end all is on its path again.
  game.session().seek(1.5);
  for (std::size_t i = 0; i < after.size(); ++i) expect_near(places()[i], after[i], __LINE__);
  game.session().seek(Session::kFirstTime);
  act(Action::steer_carrier);
  EXPECT_FALSE(game.flight());
  for (std::size_t i = 0; i < before.size(); ++i) expect_near(places()[i], before[i], __LINE__);
  EXPECT_EQ(keys().size(), 2u);
}

TEST_F(CarriersTest, TheCameraIsBehindTheCarrierAndGoesBack) {
  Game& game = start();
  const glm::vec3 before = eye();
  act(Action::steer_carrier);
  game.move({}, 0.01);
  const glm::vec3 target = game.player().camera().target_world;
  EXPECT_EQ(target, game.carrier_pose().position_world);
  EXPECT_GT(glm::distance(eye(), target), 0.3f);
  // Ahead is away from the camera, level.
  game.move(holding(Action::forward), 0.1);
  const glm::vec3 moved = game.carrier_pose().position_world - target;
  EXPECT_EQ(moved.y, 0);
  EXPECT_NEAR(glm::length(moved), 0.1f * game.player().options().fly_speed, kNear);
  const glm::vec3 sight = game.player().camera().target_world - eye();
  EXPECT_NEAR(
      glm::dot(glm::normalize(glm::vec2(sight.x, sight.z)), glm::normalize(glm::vec2(moved.x, moved.z))), 1,
      kNear);
  act(Action::toggle_cursor);  // Escape
  EXPECT_FALSE(game.flight());
  EXPECT_FALSE(game.choices().free_cursor);
  EXPECT_EQ(eye(), before);
  EXPECT_EQ(lines_.back(), "crane is on its path again");
}

TEST_F(CarriersTest, KeysAreAddedMovedRemovedAndUndone) {
  Game& game = start();
  game.session().seek(1);
  act(Action::steer_carrier);
  game.move(holding(Action::up), 0.25);
  const scene::CarrierKey pose = game.carrier_pose();
  act(Action::add_key);
  EXPECT_EQ(lines_.back(), "key added: crane");
  EXPECT_EQ(game.session().key_changes(), 1u);  // which the autosave saves
  ASSERT_EQ(keys().size(), 3u);
  EXPECT_EQ(keys()[1].time, 1);
  EXPECT_EQ(keys()[1].position_world, pose.position_world);
  act(Action::toggle_cursor);
  // The path now leads there.
  EXPECT_EQ(game.carrier_pose().position_world, pose.position_world);
  EXPECT_EQ(game.carrier_pose().rotation, pose.rotation);

  act(Action::undo);
  EXPECT_EQ(lines_.back(), "undone: key of crane");
  EXPECT_EQ(game.session().key_changes(), 0u);
  EXPECT_EQ(keys().size(), 2u);
  EXPECT_NE(game.carrier_pose().position_world, pose.position_world);
  act(Action::redo);
  EXPECT_EQ(keys().size(), 3u);

  game.remove_carrier_key();
  EXPECT_EQ(lines_.back(), "key removed: crane");
  EXPECT_EQ(keys().size(), 2u);
  game.remove_carrier_key();
  EXPECT_EQ(lines_.back(), "crane has no key at this time");
  // A session begins a tick after time 0, whose key is its first one.
  game.session().rewind();
  act(Action::add_key);
  EXPECT_EQ(lines_.back(), "the key of this time moved: crane");
  EXPECT_EQ(keys()[0].time, 0);
  game.choices().carrier = 1;
  game.remove_carrier_key();
  EXPECT_EQ(lines_.back(), "the only key of rail cannot be removed");
}

TEST_F(CarriersTest, AKeyOutsideOfItsRangeIsRefused) {
  Game& game = start();
  game.session().seek(1);
  scene::Timeline settings = timeline();
  settings.carriers[0].keys[0].position_world.x = 2e6f;
  const auto done = game.session().set_settings(settings);
  ASSERT_FALSE(done);
  EXPECT_NE(done.failure().message.find("[[carrier]] crane: key at 0 s: \"position\""), std::string::npos);
  EXPECT_EQ(keys()[0].position_world.x, 2);
}

TEST_F(CarriersTest, ATimelineWithOtherPartsIsRefused) {
  scenario::EditableScenario& live = start().session().live();
  const auto expect_refused = [&](auto change) {
    scene::Timeline other = timeline();
    change(other);
    for (const auto& done : {live.reset(other), live.set_settings(other)}) {
      ASSERT_FALSE(done);
      EXPECT_NE(done.failure().message.find("load it as a new scenario"), std::string::npos);
    }
  };
  expect_refused([](scene::Timeline& t) { t.decals.pop_back(); });
  expect_refused([](scene::Timeline& t) { t.decals[0].grid = "fuel"; });
  expect_refused([](scene::Timeline& t) { t.volumes.pop_back(); });
  expect_refused([](scene::Timeline& t) { t.carriers[0].object = "Door"; });
  EXPECT_TRUE(live.reset(timeline()));
}

TEST_F(CarriersTest, ASnapshotShowsWhatIsSteeredAndHidden) {
  Game& game = start();
  act(Action::steer_carrier);
  game.move(holding(Action::left), 0.25);
  act(Action::decals);
  EXPECT_TRUE(frame_input(game, holes_).decals.empty());
  const scene::Timeline saved = game.snapshot();
  EXPECT_TRUE(saved.decals.empty());
  EXPECT_EQ(timeline().decals.size(), 2u);
  const scene::CarrierKey pose = game.carrier_pose();
  EXPECT_EQ(scene::key_at(saved.carriers[0], game.session().seconds()).position_world, pose.position_world);
  act(Action::decals);
  EXPECT_EQ(frame_input(game, holes_).decals.size(), 2u);
  EXPECT_EQ(game.snapshot().decals.size(), 2u);
  // The session itself has neither.
  EXPECT_EQ(game.session().recording().carriers[0].keys.size(), 2u);
  EXPECT_EQ(keys()[0].position_world, glm::vec3(2, 0, -2));
}

TEST_F(CarriersTest, WithoutCarriersNothingIsSteered) {
  Game& game = start("foggy.toml");
  act(Action::steer_carrier);
  EXPECT_FALSE(game.flight());
  EXPECT_EQ(lines_.back(), "nothing to steer: the timeline has no [[carrier]]");
  act(Action::add_key);
  EXPECT_EQ(lines_.back(), "no key added: the timeline has no [[carrier]]");
  act(Action::decals);
  EXPECT_TRUE(game.choices().decals);
  EXPECT_EQ(lines_.back(), "the timeline has no [[decal]]");
  EXPECT_EQ(game.session().end_seconds(), Session::kFirstTime);
  EXPECT_EQ(start().session().end_seconds(), 2);  // the last key
}

TEST_F(CarriersTest, DecalsAndMasksAreEditedUndoneAndSaved) {
  Game& game = start();
  scene::Timeline settings = timeline();
  settings.decals[1].strength = 0.25f;
  settings.decals[1].fade = 0.5f;
  game.change_settings("decal", settings);
  game.settle();
  scene::VolumeOptions& volume = settings.volumes[1];
  volume.masks[0].color = {0, 0.5f, 1};
  volume.disturbance.strength = 0;
  volume.particles = 100;
  game.change_settings("volume", settings);
  game.settle();
  EXPECT_EQ(frame_input(game, holes_).decals[1].strength, 0.25f);
  const auto particles = frame_input(game, holes_).particles;
  ASSERT_EQ(particles.size(), 1u) << "no longer marched";
  EXPECT_EQ(particles[0].tints[0], 2.0f * glm::vec3(0, 0.5f, 1));
  EXPECT_EQ(particles[0].count, 100u);

  // Saved and loaded again, all is the same.
  const auto path = folder_.path() / "made.toml";
  ASSERT_TRUE(scene::save_timeline(path, game.session().recording()));
  const scene::Timeline again = scene::load_timeline(path).value_or_throw();
  EXPECT_EQ(scene::format_timeline(again, folder_.path()),
            scene::format_timeline(game.session().recording(), folder_.path()));
  EXPECT_EQ(again.volumes[1].disturbance, volume.disturbance);

  act(Action::undo);
  EXPECT_EQ(lines_.back(), "undone: volume");
  EXPECT_EQ(timeline().volumes[1].masks[0].color, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(timeline().decals[1].strength, 0.25f);
  act(Action::undo);
  EXPECT_EQ(timeline().decals[1].strength, 1);

  settings.decals[0].gamma = 20;
  game.change_settings("decal", settings);
  EXPECT_EQ(lines_.back(), "[[decal]] fog.brv: \"gamma\": expected a number from 0.1 to 10, found 20");
}

TEST(CarrierKeysTest, KeysOfATime) {
  scene::Carrier carrier;
  carrier.keys = {{1, {}, {}}, {2, {}, {}}, {2.5, {}, {}}};
  EXPECT_EQ(key_of_time(carrier, 1.5), std::nullopt);
  EXPECT_EQ(key_of_time(carrier, 2 + Session::kTick), 1u);
  EXPECT_EQ(key_of_time(carrier, 2 + 1.01 * Session::kTick), std::nullopt);
  EXPECT_EQ(key_time_before(carrier, 2), 1);
  EXPECT_EQ(key_time_before(carrier, 1), std::nullopt);
  EXPECT_EQ(key_time_after(carrier, 2.001), 2.5);
  EXPECT_EQ(key_time_after(carrier, 2.5), std::nullopt);
  set_key(carrier, {1.25, glm::vec3(1), {}});
  ASSERT_EQ(carrier.keys.size(), 4u);
  EXPECT_EQ(carrier.keys[1].time, 1.25);
  set_key(carrier, {3, glm::vec3(1), {}});
  EXPECT_EQ(carrier.keys[4].time, 3);
  set_key(carrier, {0, glm::vec3(1), {}});
  EXPECT_EQ(carrier.keys[0].time, 0);
}

TEST(OptionLabelsOfEffectsTest, EverySettingHasALabelOfItsOwn) {
  const auto expect_labels = [](auto options, auto visit) {
    std::set<std::string> labels;
    visit(options, [&](const scene::OptionInfo& info, const auto&) {
      const std::string label = label_of(info);
      EXPECT_TRUE(labels.insert(label).second) << label;
    });
  };
  expect_labels(scene::VolumeMask(), [](auto& o, auto&& v) { scene::visit_mask_options(o, v); });
  expect_labels(scene::Disturbance(), [](auto& o, auto&& v) { scene::visit_disturbance_options(o, v); });
  expect_labels(scene::VolumeDetail(), [](auto& o, auto&& v) { scene::visit_detail_options(o, v); });
  expect_labels(scene::VolumeOptions(), [](auto& o, auto&& v) { scene::visit_particle_options(o, v); });
  expect_labels(scene::DecalOptions(), [](auto& o, auto&& v) { scene::visit_decal_options(o, v); });
}

}  // namespace
}  // namespace brume::viewer
