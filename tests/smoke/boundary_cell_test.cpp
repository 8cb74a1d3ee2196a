// Boundary cells against their definition, and read in any order, by any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <thread>

#include "smoke/cell_sight.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/smoke/random_level.hpp"

namespace brume::smoke {
namespace {

/// docs/how/smoke.md, "Smoke at walls", voxel by voxel; for cells whose planes do not move.
class CellByDefinition {
 public:
  CellByDefinition(const sim::World& world, CellSight& sight, glm::ivec3 cell) : sight_(sight) {
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const glm::ivec3 voxel = cell - 1 + neighbour_offset(static_cast<int>(bit));
      free_ |= Neighbourhood64{!world.grid().solid(voxel)} << bit;
      density_[bit] = world.state().density(voxel);
      bool smoky = false;
      for (const sim::LiveCloud& live : world.state().clouds) smoky |= live.cloud->voxels().contains(voxel);
      smoke_ |= Neighbourhood64{smoky} << bit;
    }
    sight_.look_at(cell);
    for (int side = 0; side < sight_.side_count(); ++side)
      visible_[static_cast<std::size_t>(side)] = sight_.visible(side, free_);
  }
  bool any_smoke() const { return smoke_ != 0; }
  bool any_solid_corner() const {
    bool any = false;
    for (int corner = 0; corner < 8; ++corner) any |= (free_ & neighbour_bit(corner_offset(corner) + 1)) == 0;
    return any;
  }
  bool bent() const {
    bool any = false;
    for (int plane = 0; plane < sight_.plane_count(); ++plane) any |= sight_.deviation(plane) > 0;
    return any;
  }
  /// The density of a corner for the points on a side.
  int density(int side, int corner) const {
    const int like = followed(side);
    const glm::ivec3 at = corner_offset(corner) + 1;
    if ((sight_.on_side(like, free_) & neighbour_bit(at)) != 0) return density_at(at);
    const Neighbourhood64 visible = visible_[static_cast<std::size_t>(like)];
    const int near = mean(at, visible, 1);
    return near >= 0 ? near : std::max(0, mean(at, visible, 3));
  }

 private:
  int density_at(glm::ivec3 at) const {
    return density_[static_cast<std::size_t>(at.x + 4 * at.y + 16 * at.z)];
  }
  /// Weighted by 144 / distance^2, of the voxels at most `reach` away along each axis; -1: there is none.
  int mean(glm::ivec3 from, Neighbourhood64 among, int reach) const {
    int sum = 0, total = 0;
    for (int bit = 0; bit < 64; ++bit) {
      const glm::ivec3 apart = glm::abs(neighbour_offset(bit) - from);
      if ((among >> bit & 1) == 0 || std::max({apart.x, apart.y, apart.z}) > reach) continue;
      const int square = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
      const int weight = square == 0 ? 1 : 144 / square;
      total += weight;
      sum += weight * density_at(neighbour_offset(bit));
    }
    return total == 0 ? -1 : (sum + total / 2) / total;
  }
  int followed(int side) const {
    if (visible_[static_cast<std::size_t>(side)] != 0) return side;
    int best = side, best_rank = -1;
    for (int other = 0; other < sight_.side_count(); ++other) {
      const Neighbourhood64 visible = visible_[static_cast<std::size_t>(other)];
      const int planes = std::popcount(static_cast<unsigned>(side ^ other));
      const int rank = 100 * (3 - planes) + std::popcount(visible & smoke_);
      if (visible == 0 || rank <= best_rank) continue;
      best = other;
      best_rank = rank;
    }
    return best;
  }

  CellSight& sight_;
  Neighbourhood64 free_ = 0, smoke_ = 0;
  std::array<std::uint8_t, 64> density_{};
  std::array<Neighbourhood64, 8> visible_{};
};

TEST(BoundaryCell, IsWhatItIsDefinedToBe) {
  std::size_t cells = 0, with_smoke = 0, bent = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    RandomLevel level(seed);
    sim::World world = level.world();
    SmokeVolume volume(level.grid(), level.planes());
    for (const std::uint32_t tick : {40u, 75u, 120u, 160u}) {
      world.advance_to(tick);
      volume.update(world);
      const PlaneSource planes = [&](glm::ivec3 cell) { return level.planes().at(cell); };
      PlaneWindow window(planes);
      CellSight sight(window);
      for (int i = 0; i < 7000; ++i) {
        const glm::ivec3 cell = glm::ivec3(level.below(46), level.below(20), level.below(42)) - 3;
        window.move_to(cell);
        const CellByDefinition expected(world, sight, cell);
        const std::uint32_t slot = volume.slot_at(brick_of_cell(cell)), number = cell_in_brick(cell);
        const std::uint32_t entry = slot == SmokeVolume::kNoSlot ? 0 : volume.entries(slot)[number];
        ASSERT_EQ(entry != 0, expected.any_smoke() && expected.any_solid_corner());
        if (entry == 0) continue;
        ++cells;
        const shared::BoundaryCell& boundary = volume.boundary_cell(slot, number, entry);
        if (expected.bent()) {
          ++bent;
          continue;
        }
        ASSERT_EQ(boundary.plane0, sight.record().plane0);
        for (int side = 0; side < sight.side_count(); ++side) {
          const glm::uvec2 set = volume.corner_set(boundary.first_set + static_cast<std::uint32_t>(side));
          for (int corner = 0; corner < 8; ++corner)
            ASSERT_EQ(set[corner >> 2] >> (8 * (corner & 3)) & 255u,
                      static_cast<unsigned>(expected.density(side, corner)))
                << seed << ' ' << tick << ' ' << cell.x << ' ' << cell.y << ' ' << cell.z << ' ' << side;
          with_smoke += set != glm::uvec2(0);
        }
      }
    }
  }
  EXPECT_GT(cells, 3000u);
  EXPECT_GT(with_smoke, 1500u);
  EXPECT_GT(bent, 100u);
}

std::vector<Segment> segments(RandomLevel& level, std::size_t count) {
  std::vector<Segment> lines(count);
  for (Segment& line : lines) line = {level.point(), level.point()};
  return lines;
}
bool same_floats(std::span<const float> a, std::span<const float> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(BoundaryCell, LinesSeeTheSameWhateverWasReadBefore) {
  // A volume that only a few lines a tick read, and that sometimes misses ticks; now and then all is read.
  float deepest = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    RandomLevel level(seed);
    sim::World world = level.world();
    SmokeVolume read_late(level.grid(), level.planes());
    for (int step = 0; step < 90; ++step) {
      world.advance_to(
          static_cast<std::uint32_t>(step % 5 == 4 ? level.below(RandomLevel::kTicks) : 3 * step / 2));
      read_late.update(world);
      if (step % 3 == 2) continue;
      SmokeVolume fresh(level.grid(), level.planes());
      fresh.update(world);
      ASSERT_GE(fresh.volume().slot_count(), 0u);  // computes all of it
      const Sight late(read_late, world.grid(), {}, 0), whole(fresh, world.grid(), {}, 0);
      const std::vector<Segment> lines = segments(level, step % 4 == 0 ? 300 : 6);
      std::vector<float> depths(lines.size()), expected(lines.size());
      late.optical_depths(lines, depths).value_or_throw();
      whole.optical_depths(lines, expected).value_or_throw();
      ASSERT_TRUE(same_floats(depths, expected)) << seed << ' ' << step;
      for (const float depth : depths) deepest = std::max(deepest, depth);
      const glm::vec3 point = 2.0f * level.point();
      ASSERT_EQ(sample_density(read_late, point), sample_density(fresh, point));
      if (step % 10 == 9) {
        ASSERT_EQ(read_late.volume().slot_count(), read_late.slot_count());
      }
    }
  }
  EXPECT_GT(deepest, 5);
}

TEST(BoundaryCell, ManyThreadsReadWhatOneReads) {
  RandomLevel level(7);
  sim::World world = level.world();
  SmokeVolume shared(level.grid(), level.planes()), alone(level.grid(), level.planes());
  for (std::uint32_t tick = 20; tick < 200; tick += 4) {
    world.advance_to(tick);
    shared.update(world);
    alone.update(world);
    const std::vector<Segment> lines = segments(level, 400);
    const Sight sight(shared, world.grid(), {}, 0), expected_sight(alone, world.grid(), {}, 0);
    std::vector<float> expected;
    for (const Segment& line : lines)
      expected.push_back(expected_sight.optical_depth(line.a_world, line.b_world).value_or_throw());

    // Four threads with lines of sight in other orders; one that reads everything.
    std::array<std::vector<float>, 4> depths;
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < depths.size(); ++k)
      threads.emplace_back([&, k] {
        depths[k].resize(lines.size());
        for (std::size_t n = 0; n < lines.size(); ++n) {
          const std::size_t i = (n * 7 + 100 * k) % lines.size();
          depths[k][i] = sight.optical_depth(lines[i].a_world, lines[i].b_world).value_or_throw();
        }
      });
    if (tick % 8 == 0) threads.emplace_back([&] { EXPECT_TRUE(shared.volume().revision() > 0); });
    threads.clear();
    for (const std::vector<float>& of_thread : depths) ASSERT_TRUE(same_floats(of_thread, expected)) << tick;
  }
}

}  // namespace
}  // namespace brume::smoke
