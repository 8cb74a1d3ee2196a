#include "smoke/field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "smoke/holes.hpp"
#include "tests/sanitized.hpp"
#include "voxel/level.hpp"
#include "voxel/voxelize.hpp"

namespace brume::smoke {
namespace {

using Patches = std::vector<std::shared_ptr<const voxel::PlanePatch>>;

constexpr voxel::GridLayout kLayout{{31, 15, 27}, 0.5f, {-1, 0.3f, 2}};
constexpr std::uint32_t kTicks = 260;
/// A wall that is opened, closed again, opened, and made of glass.
constexpr Box<int> kGate{{14, 1, 4}, {16, 8, 12}};

/// Walls along the axes and a slanted one.
std::vector<voxel::Triangle> walls() {
  std::vector<voxel::Triangle> mesh;
  const auto quad = [&](glm::vec3 at, glm::vec3 u, glm::vec3 v) {
    at += kLayout.origin_world;
    mesh.push_back({at, at + u, at + u + v});
    mesh.push_back({at, at + u + v, at + v});
  };
  quad({0.2f, 0.3f, 0.2f}, {15, 0, 0}, {0, 0, 13});
  quad({7.3f, 0.3f, 0.2f}, {0, 6, 0}, {0, 0, 13});
  quad({2, 0.3f, 6}, {0, 5, 0}, {4, 0, 2.3f});
  return mesh;
}

sim::Position at(double x, double y, double z) {
  return sim::position_from_metres(glm::dvec3(kLayout.origin_world) + glm::dvec3(x, y, z));
}

/// A level and what happens in it: smokes, a blast, holes, edits that come and go.
struct Match {
  explicit Match(bool with_planes = true) {
    if (with_planes) planes = voxel::SurfacePlanes::build(mesh, grid);
  }

  sim::World world() const {
    sim::World world(grid, {.masks = masks.key()});
    world.append(sim::ThrowSmoke{0, at(4, 2, 5), at(4, 2, 5), {900, 30, 150, 60}}).value_or_throw();
    world.append(sim::ThrowSmoke{40, at(10, 2, 6), at(10, 2, 6), {700, 30, 120, 50}}).value_or_throw();
    sim::Blast blast;
    blast.tick = 90;
    blast.at = at(5, 2, 5);
    blast.radius = 2 * sim::kUnitsPerMetre;
    world.append(blast).value_or_throw();
    std::mt19937 random(5);
    for (std::uint32_t i = 0; i < 12; ++i) {
      sim::Shot shot;
      shot.tick = 60 + 12 * i;
      shot.origin = at(1, 1.5 + 0.1 * i, 3 + 0.3 * i);
      shot.toward = at(14, 2, 8 - 0.2 * i);
      shot.shape = static_cast<sim::HoleShape>(i % 3);
      world.append(shot).value_or_throw();
    }
    for (const sim::LevelEdit& edit : edits()) world.append(edit).value_or_throw();
    return world;
  }
  std::vector<sim::LevelEdit> edits() const {
    const auto gate = [&](bool solid) { return sim::edit_box(kLayout, kGate.low, kGate.high, solid); };
    sim::EditBlocks glass = gate(true);
    for (sim::EditBlock& block : glass) std::swap(block.make_solid, block.make_glass);
    return {{50, gate(false)},
            {80, sim::edit_box(kLayout, {4, 1, 6}, {9, 4, 9}, true)},
            {110, sim::difference(opened(), grid, kGate.low, kGate.high)},
            {140, gate(false)},
            {170, glass},
            {200, sim::edit_box(kLayout, {4, 1, 6}, {9, 4, 9}, false)}};
  }
  /// With the gate open.
  voxel::BitGrid opened() const {
    voxel::BitGrid open = grid;
    sim::apply_edits(open, sim::edit_box(kLayout, kGate.low, kGate.high, false));
    return open;
  }

  std::vector<voxel::Triangle> mesh = walls();
  voxel::BitGrid grid = voxel::voxelize(mesh, kLayout).value_or_throw();
  voxel::SurfacePlanes planes;
  MaskAtlas masks = MaskAtlas::pack(std::vector<Mask>{{2, 2, {255, 0, 90, 255}}}).value_or_throw();
};

/// Patches of boxes that are cleared and filled one after the other; some cover others.
Patches make_patches(const Match& match) {
  voxel::Level level(match.grid, {match.mesh});
  Patches patches;
  std::mt19937 random(31);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 low(random() % 20, random() % 8, random() % 20);
    const auto size = static_cast<int>(i % 4 == 3 ? 14 : 3 + random() % 5);
    const voxel::LevelChange change = level.set_box({low, low + size}, i % 2 == 0);
    patches.push_back(
        std::make_shared<const voxel::PlanePatch>(voxel::PlanePatch{change.cells, change.planes}));
  }
  return patches;
}

template <typename Visit>
void for_each_cell(Visit visit) {
  for_each_in(Box<int>{glm::ivec3(-1), kLayout.size}, visit);
}

std::vector<Segment> segments(std::uint32_t seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(-0.05f, 1.05f);
  const auto end = [&] {
    const float x = share(random), y = share(random), z = share(random);
    return kLayout.origin_world + kLayout.voxel_size * glm::vec3(kLayout.size) * glm::vec3(x, y, z);
  };
  std::vector<Segment> segments(count);
  for (Segment& segment : segments) {
    segment.a_world = end();
    segment.b_world = end();
  }
  return segments;
}

std::vector<float> depths(const Field& field, const SightLook& look, std::span<const Segment> lines) {
  std::vector<float> depths(lines.size());
  field.sight(look)->optical_depths(lines, depths).value_or_throw();
  return depths;
}

SightLook drawn() {
  SightLook look;
  look.drawn = drawn_look({});
  return look;
}

/// The same answers to the bit, whatever slots and cells are numbered.
void expect_same(const Field& a, const Field& b, std::uint32_t seed) {
  int voxels = 0, surfaces = 0, densities = 0;
  for_each_cell([&](glm::ivec3 cell) {
    voxels += a.solids().role(cell) != b.solids().role(cell);
    surfaces += !std::ranges::equal(a.planes()(cell), b.planes()(cell));
    const glm::vec3 place = glm::vec3(cell) + glm::vec3(0.7f, 1.1f, 0.9f);
    densities += sample_density(a.volume(), place) != sample_density(b.volume(), place);
  });
  EXPECT_EQ(voxels, 0);
  EXPECT_EQ(surfaces, 0);
  EXPECT_EQ(densities, 0);
  EXPECT_EQ(a.state().hash(), b.state().hash());
  EXPECT_EQ(a.holes().size(), b.holes().size());
  const auto lines = segments(seed, 300);
  EXPECT_EQ(depths(a, {}, lines), depths(b, {}, lines));
  // Noise takes long.
  if (seed % 8 == 3) {
    const std::span few(lines.data(), 5);
    EXPECT_EQ(depths(a, drawn(), few), depths(b, drawn(), few));
  }
  std::vector<std::uint8_t> visible_a(lines.size()), visible_b(lines.size());
  a.sight({})->visible(lines, 1, visible_a).value_or_throw();
  b.sight({})->visible(lines, 1, visible_b).value_or_throw();
  EXPECT_EQ(visible_a, visible_b);
}

TEST(Field, UpdatedEqualsRebuiltAtAnyTick) {
  for (const bool with_planes : {true, false}) {
    const Match match(with_planes);
    const Patches patches = with_planes ? make_patches(match) : Patches();
    sim::World world = match.world();
    // One copies the states, one reads the world, one does both.
    Field copying(match.grid, match.planes, &match.masks), reading(match.grid, match.planes, &match.masks),
        either(match.grid, match.planes, &match.masks);
    std::mt19937 random(with_planes);
    int edited = 0, cut = 0;
    for (int i = 0; i < (kSanitized ? 8 : 24); ++i) {
      SCOPED_TRACE(i);
      world.advance_to(static_cast<std::uint32_t>(random() % kTicks));
      // Without patches, with some, with others in their stead.
      Patches some(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(
                                                          i % 3 ? random() % 9 % (patches.size() + 1) : 0));
      if (i % 5 == 4) std::ranges::shuffle(some, random);
      for (Field* field : {&copying, &reading, &either}) field->set_patches(some);
      copying.update(world.state());
      reading.update(world);
      if (random() % 2 != 0)
        either.update(world);
      else
        either.update(world.state());

      Field fresh(match.grid, match.planes, &match.masks);
      fresh.set_patches(some);
      fresh.update(world.state());
      const auto seed = static_cast<std::uint32_t>(i);
      for (const Field* field : {&copying, &reading, &either}) expect_same(*field, fresh, seed);
      edited += world.state().edits != nullptr;
      cut += !fresh.holes().empty();
    }
    EXPECT_GT(edited, kSanitized ? 3 : 12);
    EXPECT_GT(cut, kSanitized ? 2 : 6);
  }
}

TEST(Field, SurfacesAreThoseOfPatchesElseOfWhatIsNotEdited) {
  const Match match;
  const Patches patches = make_patches(match);
  sim::World world = match.world();
  Field field(match.grid, match.planes, &match.masks);
  std::size_t patched = 0, dropped = 0, as_loaded = 0;
  for (const std::uint32_t tick : {0u, 60u, 100u, 120u, 150u, 180u, 230u, 55u}) {
    world.advance_to(tick);
    const std::size_t count = tick % 60 == 0 ? 0 : tick % 9 % patches.size();
    const auto present = std::span(patches).first(count);
    field.set_patches({present.begin(), present.end()});
    field.update(world);
    for_each_cell([&](glm::ivec3 cell) {
      std::span<const voxel::Plane> expected = match.planes.at(cell);
      bool is_edited = false;
      for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner = cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
        is_edited |= world.grid().solid(corner) != match.grid.solid(corner);
      }
      const bool has_plane = !expected.empty();
      if (is_edited) expected = {};
      bool is_patched = false;
      for (const auto& patch : present)
        if (patch->cells.contains(cell)) expected = patch->planes.at(cell), is_patched = true;
      ASSERT_TRUE(std::ranges::equal(field.planes()(cell), expected)) << tick;
      patched += is_patched;
      dropped += !is_patched && is_edited && has_plane;
      as_loaded += !is_patched && !is_edited && has_plane;
    });
  }
  EXPECT_GT(patched, 500u);
  EXPECT_GT(dropped, 100u);
  EXPECT_GT(as_loaded, 1000u);
}

TEST(Field, AnEditThatIsUndoneLeavesNoTrace) {
  const Match match;
  const auto field_after = [&](const std::vector<sim::LevelEdit>& edits) {
    sim::World world(match.grid, {.masks = match.masks.key()});
    for (const sim::LevelEdit& edit : edits) world.append(edit).value_or_throw();
    world.append(sim::ThrowSmoke{20, at(6, 2, 4), at(6, 2, 4), {900, 30, 150, 60}}).value_or_throw();
    world.advance_to(80);
    auto field = std::make_unique<Field>(match.grid, match.planes, &match.masks);
    field->update(world.state());
    return field;
  };
  const auto plain = field_after({});
  const auto edit = match.edits();
  const auto undone = field_after({{5, edit[0].blocks}, {10, edit[2].blocks}});
  EXPECT_TRUE(undone->state().edits);
  const auto lines = segments(8, 2000);
  EXPECT_EQ(depths(*undone, {}, lines), depths(*plain, {}, lines));
  for_each_cell([&](glm::ivec3 cell) {
    ASSERT_TRUE(std::ranges::equal(undone->planes()(cell), plain->planes()(cell)));
  });
  // One that stays does.
  EXPECT_NE(depths(*field_after({{5, edit[0].blocks}}), {}, lines), depths(*plain, {}, lines));
}

TEST(Field, IsWithoutSmokeAtFirst) {
  const Match match;
  const Field field(match.grid, match.planes, &match.masks);
  EXPECT_EQ(field.masks(), match.masks.key());
  EXPECT_EQ(field.state().masks, match.masks.key());
  EXPECT_TRUE(field.holes().empty());
  EXPECT_EQ(&field.solids().smoke, &match.grid);
  const auto lines = segments(2, 100);
  for (const float depth : depths(field, {}, lines)) EXPECT_EQ(depth, 0);
}

TEST(Field, KeepsSightsUntilTheNextUpdate) {
  const Match match;
  sim::World world = match.world();
  world.advance_to(130);
  Field field(match.grid, match.planes, &match.masks);
  field.update(world);
  EXPECT_EQ(field.holes().size(), world.state().holes.size());
  const auto plain = field.sight({}), noisy = field.sight(drawn());
  EXPECT_NE(plain, noisy);
  EXPECT_EQ(field.sight({}), plain);
  EXPECT_EQ(field.sight(drawn()), noisy);
  SightLook other = drawn();
  other.drawn->smoke.erosion = 0;
  EXPECT_NE(field.sight(other), noisy);
  EXPECT_NE(field.sight({.extinction = 1}), plain);

  // They depend on the look alone, not on which came before, nor on the thread.
  const auto lines = segments(3, 40);
  const auto expected = depths(field, {}, lines), with_noise = depths(field, drawn(), lines);
  EXPECT_NE(expected, with_noise);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(depths(field, {}, lines), expected);
        EXPECT_EQ(depths(field, i == 0 ? other : drawn(), lines) == with_noise, i != 0);
      }
    });
  threads.clear();

  // What a world changes shows after forget_sights, or an update.
  const auto before = field.sight({});
  field.forget_sights();
  EXPECT_NE(field.sight({}), before);
  EXPECT_EQ(depths(field, {}, lines), expected);
  world.advance_to(20);
  field.update(world);
  EXPECT_TRUE(field.holes().empty());
  EXPECT_NE(depths(field, {}, lines), expected);
}

}  // namespace
}  // namespace brume::smoke
