// The match of examples/server on the libraries below the C interface: the example, in C, must print the same
// lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/api/run_shell.hpp"
#include "voxel/level_hash.hpp"
#include "voxel/voxelize.hpp"
#include "wire/sender.hpp"

namespace brume::api {
namespace {

constexpr std::uint32_t kBots = 12;
constexpr float kThreshold = 3;
constexpr smoke::Segment kAim{{2, 1.6f, 8}, {30, 1.6f, 8}};

std::vector<voxel::Triangle> make_triangles() {
  std::vector<voxel::Triangle> triangles;
  const auto add = [&](float low_y, float low_z, float high_z) {
    const glm::vec3 a{16.25f, low_y, low_z}, b{16.25f, 5, low_z}, c{16.25f, 5, high_z};
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, {16.25f, low_y, high_z}});
  };
  add(0, 0, 6.75f);
  add(0, 9.25f, 16);
  add(2.75f, 6.75f, 9.25f);
  return triangles;
}

/// Two rooms of 16 x 5 x 16 m, and a wall with a doorway between them.
struct Level {
  std::vector<voxel::Triangle> triangles = make_triangles();
  voxel::BitGrid grid = voxel::voxelize(triangles, {{65, 10, 32}, 0.5f, glm::vec3(0)}).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(triangles, grid);
};

/// The input of a tick, with the shot in time: it changes nothing that the example gets it late.
void take_input(sim::World& world, std::uint32_t tick) {
  const auto add = [&](const sim::Event& event) { world.append(event).value_or_throw(); };
  const auto position = [](glm::vec3 metres) { return sim::position_from_metres(glm::dvec3(metres)); };
  const std::uint32_t now = tick % 640;
  if (now == 60) {
    const sim::Position at = position({14, 0.25f, 8});
    sim::ThrowSmoke smoke{tick, at, at};
    smoke.smoke.voxels = 1600;  // of 1/8 m^3
    add(smoke);
  }
  if (now == 170) add(sim::Shot{tick, position(kAim.a_world), position(kAim.b_world)});
  if (now == 320 || now == 384) {
    const sim::EditBlocks door = sim::edit_box(world.state().layout, {32, 0, 14}, {33, 5, 18}, now == 320);
    add(sim::LevelEdit{tick, door});
  }
  if (now == 500) add(sim::Blast{tick, position({14, 1, 8})});
}

glm::vec3 eyes_of(std::uint32_t bot, std::uint32_t tick) {
  const std::uint32_t walked = (tick * 48 + bot * 6000) % 60000;
  const std::uint32_t along = walked < 30000 ? walked : 60000 - walked;
  return {1 + static_cast<float>(along) / 1024, 1.6f, 1 + static_cast<float>(bot) * 1.25f};
}

/// The number of pairs of bots that see each other past the current walls and smoke.
std::size_t count_visible_pairs(const smoke::Sight& sight, std::uint32_t tick) {
  std::vector<smoke::Segment> pairs;
  for (std::uint32_t a = 0; a < kBots; ++a)
    for (std::uint32_t b = a + 1; b < kBots; ++b) pairs.push_back({eyes_of(a, tick), eyes_of(b, tick)});
  std::vector<std::uint8_t> visible(pairs.size());
  sight.visible(pairs, kThreshold, visible).value_or_throw();
  return static_cast<std::size_t>(std::count(visible.begin(), visible.end(), 1));
}

const char* seen_by_sniper(const smoke::Sight& sight) {
  if (sight.visible(kAim.a_world, kAim.b_world, kThreshold).value_or_throw()) return "target";
  return sight.first_wall(kAim.a_world, kAim.b_world).value_or_throw() ? "wall" : "smoke";
}

std::string line_of(const Level& level, const sim::World& world, std::size_t packet_size) {
  // Smoke ends at the triangles, but for cells with an edited voxel.
  const auto is_edited = [&](glm::ivec3 voxel) {
    return world.grid().solid(voxel) != level.grid.solid(voxel);
  };
  smoke::SmokeVolume volume(level.grid, [&](glm::ivec3 cell) -> std::span<const voxel::Plane> {
    for (int corner = 0; corner < 8; ++corner)
      if (is_edited(cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))) return {};
    return level.planes.at(cell);
  });
  volume.update(world);
  const auto holes = smoke::make_holes(world.state());
  const smoke::Sight sight(volume, world.grid(), holes, world.state().seconds(world.tick()));
  char line[300];
  std::snprintf(line, sizeof line, "%4u  %6zu  %5zu  %-6s  %5.1f  %2zu/66  %6zu  %016llx\n", world.tick(),
                world.state().clouds.size(), world.state().holes.size(), seen_by_sniper(sight),
                static_cast<double>(sight.optical_depth(kAim.a_world, kAim.b_world).value_or_throw()),
                count_visible_pairs(sight, world.tick()), packet_size,
                static_cast<unsigned long long>(world.state_hash()));
  return line;
}

std::string play_match(std::uint32_t seconds) {
  const Level level;
  sim::World world(level.grid, {.level_hash = voxel::level_hash(level.grid, level.planes)});
  wire::Sender sender;
  const std::uint32_t rate = world.settings().ticks_per_second;
  std::string lines = "tick  smokes  holes  sniper  depth  pairs  packet  state\n";
  for (std::uint32_t tick = 0; tick <= seconds * rate; ++tick) {
    take_input(world, tick);
    world.advance_to(tick);
    if (tick > rate) world.forget_before(tick - rate);
    const auto packet = sender.push(world.state()).value_or_throw();
    if (tick % rate == 0) lines += line_of(level, world, packet.size());
  }
  return lines;
}

TEST(Server, PrintsTheMatchOfTheLibraries) {
  const ShellRun run = run_shell("'" BRUME_SERVER_PROGRAM "' --seconds 30");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, play_match(30));
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 32);
}

TEST(Server, RejectsArgumentsThatItDoesNotHave) {
  EXPECT_EQ(run_shell("'" BRUME_SERVER_PROGRAM "' --minutes 3 2>&1").status, 2);
}

}  // namespace
}  // namespace brume::api
