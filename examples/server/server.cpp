// A match on a server: a minimal program around brume::sim and brume::smoke, without Vulkan, window or scene
// files.
//
//   cmake -S . -B build/server -D BRUME_SERVER=ON -D CMAKE_BUILD_TYPE=Release
//   cmake --build build/server --target brume_server
//   build/server/examples/server/brume_server [--seconds N] [--realtime]
//
// Twelve bots run around in two rooms with a door in between, throw smokes and shoot through them. Each
// second it prints the tick, the number of pairs that see each other, and the state hash: the same on every
// machine.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <thread>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"

namespace {

using namespace brume;

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

void run_match(std::uint32_t seconds, bool realtime) {
  const voxel::BitGrid level = make_level();
  sim::World world(level);
  smoke::SmokeVolume smoke(level, [](glm::ivec3) { return std::span<const voxel::Plane>(); });
  const std::uint32_t rate = world.settings().ticks_per_second;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint32_t tick = 0; tick <= seconds * rate; ++tick) {
    if (realtime)
      std::this_thread::sleep_until(start + std::chrono::nanoseconds(1'000'000'000 / rate) * tick);
    take_input(world, tick);
    world.advance_to(tick);
    if (tick > rate) world.forget_before(tick - rate);  // accept input that is up to one second late
    smoke.update(world);
    const std::size_t visible = count_visible_pairs(world, smoke);
    if (tick % rate == 0)
      std::printf("tick %u: %zu smokes, %zu holes, %zu pairs of bots see each other, state %016llx\n", tick,
                  world.state().clouds.size(), world.state().holes.size(), visible,
                  static_cast<unsigned long long>(world.state_hash()));
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::uint32_t seconds = 30;
  bool realtime = false;
  for (int i = 1; i < count; ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--realtime")
      realtime = true;
    else if (argument == "--seconds" && i + 1 < count)
      seconds = static_cast<std::uint32_t>(std::clamp(std::atoi(arguments[++i]), 1, 86400));
    else
      return std::fprintf(stderr, "usage: brume_server [--seconds N] [--realtime]\n"), 2;
  }
  try {
    run_match(seconds, realtime);
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "brume_server: %s\n", error.what()), 1;
  }
}
