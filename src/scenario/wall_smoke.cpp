#include "scenario/wall_smoke.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/box.hpp"
#include "core/tasks.hpp"

namespace brume::scenario {
namespace {

/// Samples per axis of a cell: a surface is off by at most half the distance between them, a twelfth of a
/// voxel.
constexpr int kSamples = 6;
constexpr int kSamplesOfCell = kSamples * kSamples * kSamples;

/// A change of a voxel's density.
struct Deposit {
  glm::ivec3 voxel;
  float density;
};

/// The voxels around a cell, as smoke::CellSight counts them, and their densities.
struct Neighbours {
  std::array<float, 64> density{};
  smoke::Neighbourhood64 smoky = 0;

  Neighbours(const sim::State& state, glm::ivec3 cell) {
    for (int bit = 0; bit < 64; ++bit) {
      const std::uint8_t steps = state.density(cell - 1 + smoke::neighbour_offset(bit));
      if (steps == 0) continue;
      density[static_cast<std::size_t>(bit)] = static_cast<float>(steps) / 255;
      smoky |= smoke::Neighbourhood64{1} << bit;
    }
  }
};

constexpr smoke::Neighbourhood64 kCorners = [] {
  smoke::Neighbourhood64 corners = 0;
  for (int corner = 0; corner < 8; ++corner)
    corners |= smoke::neighbour_bit({1 + (corner & 1), 1 + (corner >> 1 & 1), 1 + (corner >> 2)});
  return corners;
}();

/// What the samples of a cell give to the voxels around it.
class CellShares {
 public:
  CellShares(const smoke::SmokeVolume& volume, const Neighbours& around, smoke::CellSight& sight,
             glm::ivec3 cell, const shared::BoundaryCell& boundary)
      : around_(around) {
    for (int side = 0; side < sight.side_count(); ++side)
      visible_[static_cast<std::size_t>(side)] = sight.visible(side, around.smoky);
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(kSamples)}, [&](glm::ivec3 sample) {
      const glm::vec3 place = (glm::vec3(sample) + 0.5f) / float{kSamples};
      // A side from which no smoke is visible is the inside of a solid.
      const smoke::Neighbourhood64 visible = visible_[shared::boundary_side(boundary, place - 0.5f)];
      if (visible == 0) return;
      const float density = smoke::sample_density(volume, glm::vec3(cell) + 0.5f + place);
      if (density > 0) give(density / kSamplesOfCell, place, visible);
    });
  }
  float share(int bit) const { return shares_[static_cast<std::size_t>(bit)]; }

 private:
  /// To the visible corners, those nearest to the place first; without any, to the voxels nearest to it.
  void give(float amount, const glm::vec3& place, smoke::Neighbourhood64 visible) {
    const bool to_corners = (visible & kCorners) != 0;
    std::array<float, 64> weight{};
    float sum = 0;
    for (smoke::Neighbourhood64 rest = to_corners ? visible & kCorners : visible; rest != 0;
         rest &= rest - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
      const glm::vec3 apart = glm::abs(smoke::from_cell_centre(static_cast<int>(bit)) + 0.5f - place);
      weight[bit] = around_.density[bit] * (to_corners ? (1 - apart.x) * (1 - apart.y) * (1 - apart.z)
                                                       : std::pow(glm::dot(apart, apart), -4.0f));
      sum += weight[bit];
    }
    for (smoke::Neighbourhood64 rest = visible; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
      shares_[bit] += amount * weight[bit] / sum;
    }
  }

  const Neighbours& around_;
  std::array<smoke::Neighbourhood64, 8> visible_{};  // by side
  std::array<float, 64> shares_{};
};

bool touches_solid(std::span<const smoke::Texel> texels, glm::ivec3 local) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 t = local + 1 + smoke::corner_offset(corner);
    if (texels[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))].free == 0) return true;
  }
  return false;
}

/// What the drawn smoke of a brick's cells at walls has beyond linear interpolation between voxels.
std::vector<Deposit> deposits_of(const smoke::Field& field, std::uint32_t slot) {
  std::vector<Deposit> deposits;
  const smoke::SmokeVolume& volume = field.volume();
  smoke::PlaneWindow window(field.planes());
  window.move_to(8 * volume.brick_of(slot));
  smoke::CellSight sight(window);
  for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(8)}, [&](glm::ivec3 local) {
    const glm::ivec3 i = local + 1;
    const std::uint32_t entry = volume.cells(slot)[static_cast<std::size_t>(i.x + 9 * (i.y + 9 * i.z))];
    if (entry == 0 || !touches_solid(volume.texels(slot), local)) return;
    const glm::ivec3 cell = 8 * volume.brick_of(slot) + local;
    const Neighbours around(field.state(), cell);
    if (around.smoky == 0) return;
    sight.look_at(cell);
    const CellShares shares(volume, around, sight, cell, volume.boundary_cells()[entry - 1]);
    for (smoke::Neighbourhood64 rest = around.smoky; rest != 0; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      const bool is_corner = (kCorners >> bit & 1) != 0;
      const float interpolated = is_corner ? around.density[static_cast<std::size_t>(bit)] / 8 : 0;
      if (shares.share(bit) != interpolated)
        deposits.push_back({cell - 1 + smoke::neighbour_offset(bit), shares.share(bit) - interpolated});
    }
  });
  return deposits;
}

}  // namespace

grids::Grid smoke_grid_up_to_walls(const smoke::Field& field, const SmokeGridOptions& options) {
  const smoke::SmokeVolume& volume = field.volume();
  grids::Grid grid = smoke_grid(field.state(), options);

  // In the order of places, so that sums have the same bits whatever the slots.
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.in_use(slot)) slots.push_back(slot);
  std::ranges::sort(slots, [&](std::uint32_t a, std::uint32_t b) {
    return grids::goes_before(volume.brick_of(a), volume.brick_of(b));
  });
  std::vector<std::vector<Deposit>> deposits(slots.size());
  parallel_for(slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) deposits[i] = deposits_of(field, slots[i]);
  });

  for (const std::vector<Deposit>& of_brick : deposits)
    for (const Deposit& deposit : of_brick) {
      const auto brick = grids::find_brick(grid, deposit.voxel & ~(grids::kBrickEdge - 1));
      BRUME_ASSERT(brick, "a voxel with smoke that is in no brick");
      const std::size_t at =
          (*brick * grids::kBrickVoxels + smoke::local_voxel(deposit.voxel)) * sizeof(float);
      float density = 0;
      std::memcpy(&density, grid.values.data() + at, sizeof density);
      density = std::max(density + deposit.density, std::numeric_limits<float>::min());
      std::memcpy(grid.values.data() + at, &density, sizeof density);
    }
  return grid;
}

FollowedSmoke::FollowedSmoke(const Scenario& scenario)
    : level_events_(level_events(scenario).value_or_throw()),
      field_(scenario.voxels.solids(), scenario.voxels.planes, &scenario.masks) {}

grids::Grid FollowedSmoke::grid(const sim::World& world, const SmokeGridOptions& options) {
  field_.set_patches(patches_of(std::span(level_events_).first(count_in_effect(level_events_, world))));
  field_.update(world);
  return smoke_grid_up_to_walls(field_, options);
}

}  // namespace brume::scenario
