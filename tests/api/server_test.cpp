// The match of examples/server on the libraries below the C interface: the example, in C, must print the same
// lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/api/run_shell.hpp"

namespace brume::api {
namespace {

constexpr std::uint32_t kBots = 12;
constexpr sim::Position kEyes{0, 1638, 0};  // 1.6 m above the feet

/// Two rooms of 16 x 5 x 16 m with half-metre voxels, and a door between them.
voxel::BitGrid make_level() {
  voxel::BitGrid level({{65, 10, 32}, 0.5f, glm::vec3(0)});
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 10; ++y)
      if (z < 14 || z > 17 || y > 4) level.set({32, y, z}, true);
  return level;
}

/// A bot's position: it walks along its own lane to the other room and back.
sim::Position bot_at(std::uint32_t bot, std::uint32_t tick) {
  const std::uint32_t walked = (tick * 48 + bot * 6000) % 60000;
  const auto along = static_cast<int>(walked < 30000 ? walked : 60000 - walked);
  return {1024 + along, 0, 1024 + static_cast<int>(bot) * 1200};
}

/// The input of a tick; in a real match it comes from the network.
void take_input(sim::World& world, std::uint32_t tick) {
  const auto bot = tick / 16 % kBots;
  world.append(sim::MoveBody{tick, bot, bot_at(bot, tick)}).value_or_throw();
  const sim::Position eyes = bot_at(bot, tick) + kEyes;
  if (tick % 192 == 0) world.append(sim::ThrowSmoke{tick, eyes, {16000, 512, 15872}}).value_or_throw();
  if (tick % 40 == 0) world.append(sim::Shot{tick, eyes, {16000, 1600, 15872}}).value_or_throw();
  if (tick % 640 == 500) world.append(sim::Blast{tick, {14000, 1024, 15872}}).value_or_throw();
  if (tick % 320 == 0) {
    const bool closed = tick % 640 == 320;
    const sim::EditBlocks door = sim::edit_box(world.state().layout, {32, 0, 14}, {33, 5, 18}, closed);
    world.append(sim::LevelEdit{tick, door}).value_or_throw();
  }
}

/// The number of pairs of bots that see each other past the current walls and smoke.
std::size_t count_visible_pairs(const sim::World& world, const smoke::SmokeVolume& smoke) {
  const auto holes = smoke::holes_of(world.state());
  const smoke::Sight sight(smoke, world.grid(), holes, world.state().seconds(world.tick()));
  std::vector<smoke::Segment> pairs;
  const auto metres = [&](std::uint32_t bot) {
    return glm::vec3(sim::metres_from_position(bot_at(bot, world.tick()) + kEyes));
  };
  for (std::uint32_t a = 0; a < kBots; ++a)
    for (std::uint32_t b = a + 1; b < kBots; ++b) pairs.push_back({metres(a), metres(b)});
  std::vector<std::uint8_t> visible(pairs.size());
  sight.visible(pairs, 3, visible).value_or_throw();
  return static_cast<std::size_t>(std::count(visible.begin(), visible.end(), 1));
}

std::string play_match(std::uint32_t seconds) {
  const voxel::BitGrid level = make_level();
  sim::World world(level);
  smoke::SmokeVolume smoke(level, [](glm::ivec3) { return std::span<const voxel::Plane>(); });
  const std::uint32_t rate = world.settings().ticks_per_second;
  std::string lines;
  for (std::uint32_t tick = 0; tick <= seconds * rate; ++tick) {
    take_input(world, tick);
    world.advance_to(tick);
    if (tick > rate) world.forget_before(tick - rate);
    smoke.update(world);
    const std::size_t visible = count_visible_pairs(world, smoke);
    if (tick % rate != 0) continue;
    char line[200];
    std::snprintf(line, sizeof line,
                  "tick %u: %zu smokes, %zu holes, %zu pairs of bots see each other, state %016llx\n", tick,
                  world.state().clouds.size(), world.state().holes.size(), visible,
                  static_cast<unsigned long long>(world.state_hash()));
    lines += line;
  }
  return lines;
}

TEST(Server, PrintsTheMatchOfTheLibraries) {
  const ShellRun run = run_shell("'" BRUME_SERVER_PROGRAM "' --seconds 30");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, play_match(30));
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 31);
}

TEST(Server, RejectsArgumentsThatItDoesNotHave) {
  EXPECT_EQ(run_shell("'" BRUME_SERVER_PROGRAM "' --minutes 3 2>&1").status, 2);
}

}  // namespace
}  // namespace brume::api
