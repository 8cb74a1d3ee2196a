// A match whose machines have loaded different levels: noticed before the first line of sight.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "tests/api/match.hpp"

namespace brume::api {
namespace {

/// The result of a call, whose line must name the level where it is a mismatch.
brume_result level_result(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    if (error.result() == BRUME_ERROR_MISMATCH) {
      EXPECT_NE(std::string(error.what()).find("another level"), std::string::npos) << error.what();
    }
    return error.result();
  }
  return BRUME_OK;
}

class LevelTest : public testing::Test {
 protected:
  World played(const Level& level) const {
    brume_world_params params = brume_world_defaults();
    params.masks = masks_.get();
    World world(level, params);
    world.append(match_.events);
    return world;
  }
  brume_field_params field_params() const {
    brume_field_params params = brume_field_defaults();
    params.masks = masks_.get();
    return params;
  }
  Receiver receiver_of(const Level& level) const {
    brume_receiver_params params = brume_receiver_defaults();
    params.level = level.get();
    return Receiver(context_, params);
  }
  /// The match's level without its slope, in the same layout.
  Level without_slope() const {
    brume_triangles_params params = match_.triangle_params();
    params.index_count -= 6;
    return {context_, params};
  }
  /// The voxels of the match's level, without its surfaces.
  Level of_voxels() const {
    const Bytes solid = level_.solid({0, 0, 0}, match_.layout().size);
    Bytes bits((solid.size() + 7) / 8);
    for (std::size_t i = 0; i < solid.size(); ++i)
      bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | solid[i] << i % 8);
    brume_voxels_params params = brume_voxels_defaults();
    params.layout = match_.layout();
    params.bits = bits.data();
    params.byte_count = bits.size();
    return {context_, params};
  }

  Match match_;
  Context context_;
  Level level_ = match_.level(context_);
  Masks masks_ = match_.masks(context_);
};

TEST_F(LevelTest, EqualLevelsHaveEqualHashes) {
  const Level again = match_.level(context_);
  EXPECT_EQ(again.hash(), level_.hash());
  World world = played(level_), same = played(again);
  EXPECT_EQ(world.hash(), same.hash());
  const std::uint64_t before = level_.hash();
  world.advance_to(Match::kTicks);
  EXPECT_EQ(level_.hash(), before) << "a door has opened in the world, not in the level";
  same.restore(world.state());
  EXPECT_EQ(same.hash(), world.hash());
}

// One with other voxels, and one with the same voxels whose smoke ends elsewhere.
TEST_F(LevelTest, StatesOfAnotherLevelAreRefused) {
  World world = played(level_);
  const std::uint64_t at_start = world.hash();
  const Bytes first = Sender(context_).push(world.state());
  world.advance_to(200);
  const State state = world.state();
  const State loaded(context_, state.save());
  std::size_t differing = 0;
  for (const Level& other : {without_slope(), of_voxels()}) {
    EXPECT_NE(other.hash(), level_.hash());
    World there = played(other);
    EXPECT_NE(there.hash(), at_start) << "at tick 0";
    EXPECT_EQ(level_result([&] { there.restore(state); }), BRUME_ERROR_MISMATCH);
    EXPECT_EQ(level_result([&] { there.restore(loaded); }), BRUME_ERROR_MISMATCH);
    EXPECT_EQ(there.tick(), 0u);

    Field field(other, field_params());
    EXPECT_EQ(level_result([&] { field.update(state); }), BRUME_ERROR_MISMATCH);
    there.advance_to(200);
    field.update(there.state());
    const Bytes densities = field.densities({0, 0, 0}, match_.layout().size);
    EXPECT_EQ(level_result([&] { field.update(loaded); }), BRUME_ERROR_MISMATCH);
    EXPECT_EQ(field.densities({0, 0, 0}, match_.layout().size), densities) << "nothing has changed";

    Sender sender(context_);
    sender.push(there.state());
    world.advance_to(201);
    EXPECT_EQ(level_result([&] { sender.push(world.state()); }), BRUME_ERROR_MISMATCH);
    there.advance_to(202);
    sender.push(there.state());

    Receiver receiver = receiver_of(other);
    EXPECT_EQ(level_result([&] { receiver.receive(first); }), BRUME_ERROR_MISMATCH);
    EXPECT_EQ(level_result([&] { (void)receiver.state(); }), BRUME_ERROR_ORDER) << "there is none";
    EXPECT_EQ(receiver.receive(there.state().save()), BRUME_RECEPTION_APPLIED);

    // Why it matters: the levels answer differently.
    Field here(level_, field_params());
    here.update(state);
    const auto lines = match_.segments(2000, 1);
    const auto mine = here.optical_depths(lines), theirs = field.optical_depths(lines);
    for (std::size_t i = 0; i < lines.size(); ++i) differing += mine[i] != theirs[i];
  }
  EXPECT_GT(differing, 0u);
}

TEST_F(LevelTest, AReceiverWithALevelFollowsItsSender) {
  World world = played(level_);
  Sender sender(context_);
  std::optional<Level> level(match_.level(context_));
  Receiver receiver = receiver_of(*level);
  level.reset();
  for (std::uint32_t tick = 0; tick < 30; ++tick) {
    world.advance_to(tick);
    EXPECT_EQ(receiver.receive(sender.push(world.state())), BRUME_RECEPTION_APPLIED);
  }
  EXPECT_EQ(receiver.state().hash(), world.hash());
  receiver.reset();
  EXPECT_EQ(receiver.receive(world.state().save()), BRUME_RECEPTION_APPLIED);
}

}  // namespace
}  // namespace brume::api
