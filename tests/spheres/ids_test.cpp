// Ids and colours of voxels against all spheres at each voxel.
#include "spheres/ids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/tasks.hpp"
#include "spheres/paint.hpp"
#include "tests/sanitized.hpp"
#include "tests/spheres/test_tanks.hpp"

namespace brume::spheres {
namespace {

// As the header of VoxelIds says it: all that touch, sorted.
glm::uvec4 ids_by_all(const Tank& tank, const glm::ivec3& voxel) {
  struct Candidate {
    float power;
    std::uint32_t id;
  };
  std::vector<Candidate> touching;
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const glm::vec4 sphere = packed(tank.spheres[i]);
    if (!shared::sphere_touches(sphere, glm::vec3(voxel), glm::vec3(voxel) + 1.0f)) continue;
    touching.push_back(
        {shared::sphere_power(sphere, glm::vec3(voxel) + 0.5f), static_cast<std::uint32_t>(i + 1)});
  }
  if (touching.size() > 4) return {0, 1, 0, 0};
  std::stable_sort(touching.begin(), touching.end(),
                   [](const Candidate& a, const Candidate& b) { return a.power < b.power; });
  glm::uvec4 ids(0);
  for (std::size_t i = 0; i < touching.size(); ++i) ids[static_cast<int>(i)] = touching[i].id;
  return ids;
}

Color color_by_all(const Tank& tank, const glm::ivec3& voxel) {
  for (std::size_t i = 0; i < tank.spheres.size(); ++i)
    if (shared::sphere_power(packed(tank.spheres[i]), glm::vec3(voxel) + 0.5f) < 0) return tank.colors[i];
  return 0;
}

glm::ivec3 random_voxel(Random& random, const glm::uvec3& size) {
  return {int(random() % size.x), int(random() % size.y), int(random() % size.z)};
}

std::size_t index_of(const glm::uvec3& size, const glm::ivec3& v) {
  return (std::size_t(v.z) * size.y + std::size_t(v.y)) * size.x + std::size_t(v.x);
}

// Touching spheres of equal power between them, and one sphere twice: ties.
Tank tank_of_ties() {
  Tank tank;
  tank.size = {33, 17, 5};
  for (int i = 0; i < 8; ++i) tank.spheres.push_back({{2.0f + 4.0f * static_cast<float>(i), 8, 2.5f}, 2});
  tank.spheres.push_back(tank.spheres[0]);
  tank.spheres.push_back({{16, 12, 2.5f}, 2});
  for (std::uint32_t i = 0; i < 10; ++i) tank.colors.push_back(i + 1);
  return tank;
}

std::vector<Tank> tanks_of_tests(Random& random) {
  std::vector<Tank> tanks{tank_of_ties()};
  for (const glm::uvec3 size :
       {glm::uvec3(1), glm::uvec3(7), glm::uvec3(33, 17, 5), glm::uvec3(64, 40, 24)}) {
    const auto shortest = static_cast<float>(std::min({size.x, size.y, size.z}));
    // Many per voxel, where that is not too many to compare with.
    if (size.x < 64) tanks.push_back(jittered_tank(size, 0.45f * std::min(shortest, 2.0f), 0.2f, random));
    tanks.push_back(thrown_tank(size, kSanitized ? 200 : 800, std::min(0.2f, shortest / 4),
                                std::min(8.0f, shortest / 2), random));
    tanks.emplace_back().size = size;  // none
  }
  return tanks;
}

TEST(VoxelIds, EqualAllSpheresAtSampledVoxels) {
  Random random(1);
  std::size_t overflows = 0, full = 0, samples = 0;
  for (const Tank& tank : tanks_of_tests(random)) {
    const VoxelIds ids = make_ids(tank, list_bricks(tank));
    const std::size_t voxels = std::size_t{tank.size.x} * tank.size.y * tank.size.z;
    const std::size_t count = std::min<std::size_t>(4 * voxels, kSanitized ? 300 : 30000);
    for (std::size_t i = 0; i < count; ++i, ++samples) {
      const glm::ivec3 voxel = random_voxel(random, tank.size);
      const glm::uvec4 expected = ids_by_all(tank, voxel);
      ASSERT_EQ(ids.at(voxel), expected) << voxel.x << " " << voxel.y << " " << voxel.z;
      overflows += shared::ids_overflow(expected);
      full += expected.w != 0;
    }
  }
  EXPECT_GT(samples, kSanitized ? 1000u : 100000u);
  EXPECT_GT(overflows, samples / 100);
  EXPECT_GT(full, samples / 1000);
}

TEST(VoxelIds, TakeFourWordsBeyond65535Spheres) {
  Random random(2);
  Tank tank = jittered_tank({96, 96, 80}, 2.2f, 0.3f, random);
  ASSERT_GT(tank.spheres.size(), 65535u);
  const VoxelIds wide = make_ids(tank, list_bricks(tank));
  EXPECT_EQ(wide.words().size(), std::size_t{4} * 96 * 96 * 80);
  const auto at_word = [&](const glm::ivec3& v) { return wide.words()[index_of(tank.size, v) * 4]; };
  for (int i = 0; i < 20; ++i) {
    const glm::ivec3 voxel = random_voxel(random, tank.size);
    const glm::uvec4 expected = ids_by_all(tank, voxel);
    ASSERT_EQ(wide.at(voxel), expected);
    ASSERT_EQ(at_word(voxel), expected.x);
  }
  tank.spheres.resize(65535);
  const VoxelIds narrow = make_ids(tank, list_bricks(tank));
  EXPECT_EQ(narrow.words().size(), std::size_t{2} * 96 * 96 * 80);
  const glm::ivec3 last(tank.spheres.back().center);
  const glm::uvec4 expected = ids_by_all(tank, last);
  EXPECT_EQ(narrow.at(last), expected);
  EXPECT_EQ(narrow.words()[index_of(tank.size, last) * 2], expected.x | expected.y << 16);
  EXPECT_EQ(narrow.words()[index_of(tank.size, last) * 2 + 1], expected.z | expected.w << 16);
}

TEST(VoxelIds, NearestAddTakesAnyOrder) {
  Random random(3);
  for (int round = 0; round < 1000; ++round) {
    const std::uint32_t count = static_cast<std::uint32_t>(random() % 7);
    std::vector<std::pair<float, std::uint32_t>> all;
    for (std::uint32_t id = 1; id <= count; ++id) all.emplace_back(float(random() % 4), id);
    std::vector<std::pair<float, std::uint32_t>> shuffled = all;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    shared::NearestIds nearest = shared::nearest_none();
    for (const auto& [power, id] : shuffled) nearest = shared::nearest_add(nearest, id, power);
    std::sort(all.begin(), all.end());
    for (int i = 0; i < 4; ++i)
      ASSERT_EQ(nearest.ids[i], std::size_t(i) < all.size() ? all[std::size_t(i)].second : 0u);
    ASSERT_EQ(nearest.count, count);
    ASSERT_EQ(shared::ids_overflow(shared::ids_to_store(nearest)), count > 4);
  }
}

TEST(Paint, EqualsAllSpheresAtSampledVoxels) {
  Random random(4);
  std::size_t painted = 0;
  std::vector<Tank> tanks = tanks_of_tests(random);
  tanks.push_back(jittered_tank({300, 200, 150}, 50, 20, random));
  for (const Tank& tank : tanks) {
    const std::vector<Color> colors = paint(tank);
    ASSERT_EQ(colors.size(), std::size_t{tank.size.x} * tank.size.y * tank.size.z);
    const std::size_t count = std::min<std::size_t>(4 * colors.size(), kSanitized ? 300 : 30000);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::ivec3 voxel = random_voxel(random, tank.size);
      const Color expected = color_by_all(tank, voxel);
      ASSERT_EQ(colors[index_of(tank.size, voxel)], expected);
      painted += expected != 0;
    }
  }
  EXPECT_GT(painted, kSanitized ? 300u : 10000u);
}

TEST(Paint, OfBricksIsThatOfAllVoxels) {
  Random random(6);
  for (const Tank& tank : tanks_of_tests(random)) {
    const std::vector<Color> colors = paint(tank);
    const PaintedBricks bricks = paint_bricks(tank);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const glm::uvec3 n = tank.size;
      const glm::ivec3 voxel(i % n.x, i / n.x % n.y, i / (std::size_t{n.x} * n.y));
      ASSERT_EQ(bricks.at(voxel), colors[i]);
    }
  }
  // Two spheres of radius 2 touch at most 2^3 bricks each, however large the tank is.
  const Tank wide{{2048, 2048, 64}, 1, {{{9, 9, 9}, 2}, {{2000, 2000, 60}, 2}}, {0xff0000ff, 0xff00ff00}};
  const PaintedBricks few = paint_bricks(wide);
  EXPECT_LE(few.colors.size(), 16u * 512);
  EXPECT_EQ(few.at({9, 9, 9}), 0xff0000ffu);
  EXPECT_EQ(few.at({2000, 2000, 60}), 0xff00ff00u);
  EXPECT_EQ(few.at({1000, 1000, 30}), 0u);
}

TEST(VoxelIds, AndPaintAreTheSameForAnyNumberOfThreads) {
  Random random(5);
  const Tank tank = thrown_tank({120, 90, 70}, 1000, 0.2f, 12, random);
  std::vector<std::uint32_t> first_ids;
  std::vector<Color> first_colors;
  for (const unsigned threads : {1u, 2u, 8u}) {
    set_thread_count(threads);
    const VoxelIds ids = make_ids(tank, list_bricks(tank));
    const std::vector<Color> colors = paint(tank);
    const std::vector<std::uint32_t> words(ids.words().begin(), ids.words().end());
    if (threads == 1) {
      first_ids = words;
      first_colors = colors;
    }
    EXPECT_TRUE(words == first_ids) << threads;
    EXPECT_TRUE(colors == first_colors) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace brume::spheres
