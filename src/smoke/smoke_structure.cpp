#include "smoke/smoke_structure.hpp"

#include <algorithm>
#include <bit>

namespace brume::smoke {
namespace {

constexpr int kCorners =
    shared::kBrickVoxels + 1;  // voxels per axis that are a corner of one of the brick's cells

/// The 3x3x3 voxels around each corner of the cell.
std::array<Neighbourhood64, 8> neighbourhoods_of_corners() {
  std::array<Neighbourhood64, 8> around{};
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 27; ++i)
      around[static_cast<std::size_t>(corner)] |=
          neighbour_bit(corner_offset(corner) + glm::ivec3(i % 3, i / 3 % 3, i / 9));
  return around;
}

/// Weight of a voxel by its distance: 144 / distance^2, whole numbers that fit 8 bits.
std::uint32_t weight_of(glm::ivec3 offset) {
  const int square = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
  return static_cast<std::uint32_t>(144 / square);
}

/// The side that a side takes its densities from: itself when any air is visible from it. Else it is inside
/// of something solid and never on screen; it continues the side fewest planes away from which most smoke is
/// visible, so that smoke reaches a curved surface also where that bulges through its plane.
int side_to_follow(int side, int side_count, const std::array<Neighbourhood64, 8>& visible,
                   Neighbourhood64 smoke) {
  int best = side;
  int best_rank = -1;
  for (int other = 0; other < side_count; ++other) {
    const Neighbourhood64 from_side = visible[static_cast<std::size_t>(other)];
    if (from_side == 0) continue;
    const int planes_between = std::popcount(static_cast<unsigned>(side ^ other));
    const int rank = 65 * (3 - planes_between) + std::popcount(from_side & smoke);
    if (other == side || rank > best_rank) {
      best = other;
      best_rank = other == side ? 1000 : rank;
    }
  }
  return best;
}

/// A cell's surroundings.
struct CellSurroundings {
  glm::ivec3 local{0};       // cell - 8 brick
  Neighbourhood64 free = 0;  // outside the grid too: smoke may end there
  Neighbourhood64 smoke = 0;
};

/// The 4x4x4 voxels around a cell.
Neighbourhood64 neighbourhood_of(const VoxelWindow& window, glm::ivec3 local) {
  Neighbourhood64 voxels = 0;
  const auto x = static_cast<unsigned>(local.x);
  const auto y = static_cast<std::size_t>(local.y), z = static_cast<std::size_t>(local.z);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      voxels |= static_cast<Neighbourhood64>(window[z + k][y + j] >> x & 15) << (4 * j + 16 * k);
  return voxels;
}

/// For each row of a brick's cells, those with any bit set among the 2^3 voxels of their corners, or the 4^3
/// around them.
template <std::size_t kFirst, std::size_t kCount>
std::array<std::array<std::uint8_t, 8>, 8> cells_with_any(const VoxelWindow& window) {
  std::array<std::array<std::uint8_t, 8>, 8> cells;
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; ++y) {
      unsigned row = 0;
      for (std::size_t k = kFirst; k < kFirst + kCount; ++k)
        for (std::size_t j = kFirst; j < kFirst + kCount; ++j) row |= window[z + k][y + j];
      unsigned any = 0;
      for (std::size_t i = kFirst; i < kFirst + kCount; ++i) any |= row >> i;
      cells[z][y] = static_cast<std::uint8_t>(any);
    }
  return cells;
}

}  // namespace

VoxelWindow make_window(const std::array<const BrickBits*, 27>& around) {
  VoxelWindow window;
  const auto byte = [&](std::size_t i, int y, int z) -> unsigned {
    if (!around[i]) return 0;
    return static_cast<std::uint8_t>((*around[i])[static_cast<std::size_t>(z & 7)] >> (8 * (y & 7)));
  };
  for (int z = -1; z < 10; ++z)
    for (int y = -1; y < 10; ++y) {
      const auto i = static_cast<std::size_t>(3 * ((y >> 3) + 1) + 9 * ((z >> 3) + 1));
      window[static_cast<std::size_t>(z + 1)][static_cast<std::size_t>(y + 1)] = static_cast<std::uint16_t>(
          byte(i, y, z) >> 7 | byte(i + 1, y, z) << 1 | (byte(i + 2, y, z) & 3) << 9);
    }
  return window;
}

BrickBits cells_at_solid(const VoxelWindow& solid) {
  const auto with_solid = cells_with_any<1, 2>(solid);
  BrickBits cells{};
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; ++y) cells[z] |= std::uint64_t{with_solid[z][y]} << (8 * y);
  return cells;
}

std::array<const BrickBits*, 27> solid_around(const voxel::BitGrid& grid, glm::ivec3 brick) {
  std::array<const BrickBits*, 27> around{};
  const glm::ivec3 bricks = (grid.size() + 7) >> 3;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 b = brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (glm::all(glm::greaterThanEqual(b, glm::ivec3(0))) && glm::all(glm::lessThan(b, bricks)))
      around[static_cast<std::size_t>(i)] = grid.find_brick(b);
  }
  return around;
}

class CellBuilder::Work {
 public:
  explicit Work(const PlaneSource& planes) : planes_(planes), sight_(planes_) {}
  std::unique_ptr<BrickCells> build(const BrickScene& scene, const Sealed& sealed);

 private:
  void add_cell(const CellSurroundings& cell);
  Neighbourhood64 sealed_voxels(const CellSurroundings& cell, Neighbourhood64 among) const;
  float distance_to_surface(int plane, const std::array<Neighbourhood64, 8>& visible, Neighbourhood64 smoke,
                            Neighbourhood64 sealed) const;
  void reach_bent_surfaces(const CellSurroundings& cell, std::array<Neighbourhood64, 8>& visible,
                           shared::BoundaryCell& record);
  void add_set(const CellSurroundings& cell, int like, std::uint8_t sides, Neighbourhood64 visible);
  std::uint32_t corner(const CellSurroundings& cell, int corner, Neighbourhood64 own_side,
                       Neighbourhood64 visible);
  std::uint32_t mean(const CellSurroundings& cell, int corner, Neighbourhood64 from, bool around_corner);
  std::uint32_t voxel_number(glm::ivec3 local) const;

  PlaneWindow planes_;
  CellSight sight_;
  const std::array<Neighbourhood64, 8> around_corner_ = neighbourhoods_of_corners();
  const BrickScene* scene_ = nullptr;
  const Sealed* sealed_ = nullptr;
  std::unique_ptr<BrickCells> out_;
  /// Means of the voxels around a corner are the same for all cells that share the corner and what is
  /// visible: a list of them per corner voxel.
  struct KnownMean {
    Neighbourhood64 from;  // relative to the corner voxel - 1
    std::uint32_t number, next;
  };
  std::vector<KnownMean> known_;
  std::array<std::uint32_t, kCorners * kCorners * kCorners> first_known_;
};

/// The number of a smoke voxel, from its place in the brick.
std::uint32_t CellBuilder::Work::voxel_number(glm::ivec3 local) const {
  const glm::ivec3 brick = (local >> 3) + 1;
  return scene_->slots[static_cast<std::size_t>(brick.x + 3 * brick.y + 9 * brick.z)] * kVoxelsPerBrick +
         local_voxel(local);
}

/// The mean of voxels of the neighbourhood, weighted by distance; 0 where none of them holds smoke.
std::uint32_t CellBuilder::Work::mean(const CellSurroundings& cell, int corner, Neighbourhood64 from,
                                      bool around_corner) {
  if ((from & cell.smoke) == 0) return kMeanBit;
  const glm::ivec3 at = corner_offset(corner) + 1;
  std::uint32_t* list = nullptr;
  // The same voxels around one corner give one mean, whichever cell asks.
  if (around_corner) {
    const glm::ivec3 voxel = cell.local + corner_offset(corner);
    list = &first_known_[static_cast<std::size_t>(voxel.x + kCorners * (voxel.y + kCorners * voxel.z))];
    const Neighbourhood64 relative = from >> std::countr_zero(neighbour_bit(corner_offset(corner)));
    for (std::uint32_t i = *list; i != 0; i = known_[i - 1].next)
      if (known_[i - 1].from == relative) return known_[i - 1].number;
    known_.push_back({relative, kMeanBit | static_cast<std::uint32_t>(out_->means.size() + 1), *list});
    *list = static_cast<std::uint32_t>(known_.size());
  }
  // Voxels that smoke never reaches count in the total only.
  SmokeMean mean{static_cast<std::uint32_t>(out_->mean_voxels.size()), 0, 0,
                 static_cast<std::uint16_t>(local_voxel(cell.local))};
  for (; from != 0; from &= from - 1) {
    const int bit = std::countr_zero(from);
    const glm::ivec3 offset = neighbour_offset(bit) - at;
    const std::uint32_t weight = offset == glm::ivec3(0) ? 1 : weight_of(offset);
    mean.total = static_cast<std::uint16_t>(mean.total + weight);
    if ((cell.smoke >> bit & 1) == 0) continue;
    out_->mean_voxels.push_back(voxel_number(cell.local - 1 + neighbour_offset(bit)));
    out_->mean_weights.push_back(static_cast<std::uint8_t>(weight));
    ++mean.count;
  }
  out_->means.push_back(mean);
  ++out_->means_of_row[mean.cell / 8u];
  return kMeanBit | static_cast<std::uint32_t>(out_->means.size());
}

/// What a corner takes from: itself where it is on the side in question, else the nearest voxels that are
/// visible from this side of the cell.
std::uint32_t CellBuilder::Work::corner(const CellSurroundings& cell, int corner, Neighbourhood64 own_side,
                                        Neighbourhood64 visible) {
  const glm::ivec3 at = corner_offset(corner) + 1;
  if (const Neighbourhood64 own = neighbour_bit(at) & own_side; own != 0)
    return (own & cell.smoke) != 0 ? voxel_number(cell.local + corner_offset(corner)) : kMeanBit;
  const Neighbourhood64 near = visible & around_corner_[static_cast<std::size_t>(corner)];
  return near != 0 ? mean(cell, corner, near, true) : mean(cell, corner, visible, false);
}

/// The voxels of `among` in pockets that smoke never enters.
Neighbourhood64 CellBuilder::Work::sealed_voxels(const CellSurroundings& cell, Neighbourhood64 among) const {
  Neighbourhood64 sealed = 0;
  for (Neighbourhood64 bits = among; bits != 0; bits &= bits - 1) {
    const int bit = std::countr_zero(bits);
    if ((*sealed_)(8 * scene_->brick + cell.local - 1 + neighbour_offset(bit)))
      sealed |= Neighbourhood64{1} << bit;
  }
  return sealed;
}

/// How far to move a plane along its normal so that smoke on one side of it reaches the surface everywhere in
/// the cell [voxels]. Only where there are nothing but sealed pockets behind it: the excess ends inside of
/// them. 0 where there is air on both sides.
float CellBuilder::Work::distance_to_surface(int plane, const std::array<Neighbourhood64, 8>& visible,
                                             Neighbourhood64 smoke, Neighbourhood64 sealed) const {
  const float deviation = sight_.deviation(plane);
  for (const int behind : {0, 1}) {
    bool fits = true, any_smoke = false, any_sealed = false;
    for (int side = 0; side < sight_.side_count(); ++side) {
      if ((side >> plane & 1) != behind) continue;
      const Neighbourhood64 from_side = visible[static_cast<std::size_t>(side)];
      const Neighbourhood64 smoke_before = visible[static_cast<std::size_t>(side ^ 1 << plane)] & smoke;
      any_smoke |= smoke_before != 0;
      any_sealed |= (from_side & ~sealed) == 0;
      // Air on both sides may only be the same air: the plane ends there.
      if ((from_side & ~sealed) != 0) fits &= smoke_before == 0 || (smoke_before & from_side) != 0;
    }
    if (fits && any_smoke && any_sealed) return behind == 1 ? deviation : -deviation;
  }
  return 0;
}

/// Where a surface bends, a piece of it that barely enters the cell, and the pieces of the cells around it,
/// may hide all smoke from the sliver before it: then the planes of the cell alone decide. And smoke has to
/// reach the surface though that lies off its plane.
void CellBuilder::Work::reach_bent_surfaces(const CellSurroundings& cell,
                                            std::array<Neighbourhood64, 8>& visible,
                                            shared::BoundaryCell& record) {
  bool bent = false;
  for (int plane = 0; plane < sight_.plane_count(); ++plane) bent |= sight_.deviation(plane) > 0;
  if (!bent) return;

  // Slivers from which nothing is visible but sealed pockets.
  Neighbourhood64 all = 0;
  for (const Neighbourhood64 from_side : visible) all |= from_side;
  const Neighbourhood64 sealed = sealed_voxels(cell, all & ~cell.smoke);
  if ((all & ~sealed) == 0)
    for (int side = 0; side < sight_.side_count(); ++side) {
      Neighbourhood64& from_side = visible[static_cast<std::size_t>(side)];
      if (from_side == 0) from_side = sight_.on_side(side, cell.smoke);
    }

  // Planes that lie off their surface.
  const std::array<std::uint32_t*, voxel::kMaxPlanes> packed{&record.plane0, &record.plane1, &record.plane2};
  for (int plane = 0; plane < sight_.plane_count(); ++plane) {
    const float distance = distance_to_surface(plane, visible, cell.smoke, sealed);
    if (distance != 0) *packed[static_cast<std::size_t>(plane)] = sight_.moved_plane(plane, distance);
  }
}

/// The set of the sides that take the densities of side `like`.
void CellBuilder::Work::add_set(const CellSurroundings& cell, int like, std::uint8_t sides,
                                Neighbourhood64 visible) {
  CornerSource source{{}, out_->set_count, static_cast<std::uint16_t>(local_voxel(cell.local)), sides};
  const Neighbourhood64 own_side = sight_.on_side(like, cell.free);
  std::uint32_t all = kMeanBit;
  for (int i = 0; i < 8; ++i) {
    const std::uint32_t from = corner(cell, i, own_side, visible);
    source.corners[static_cast<std::size_t>(i)] = from;
    if (from != kMeanBit) all = from;
  }
  if (all == kMeanBit) return;
  out_->sources.push_back(source);
  ++out_->sources_of_row[source.cell / 8u];
}

void CellBuilder::Work::add_cell(const CellSurroundings& cell) {
  // What is visible from each side of the cell's planes.
  sight_.look_at(8 * scene_->brick + cell.local);
  shared::BoundaryCell record = sight_.record();
  record.first_set = out_->set_count;
  std::array<Neighbourhood64, 8> visible{};
  for (int side = 0; side < sight_.side_count(); ++side)
    visible[static_cast<std::size_t>(side)] = sight_.visible(side, cell.free);
  reach_bent_surfaces(cell, visible, record);

  // One set for all sides that follow the same one.
  std::array<std::uint8_t, 8> followers{};
  for (int side = 0; side < sight_.side_count(); ++side) {
    std::uint8_t& sides =
        followers[static_cast<std::size_t>(side_to_follow(side, sight_.side_count(), visible, cell.smoke))];
    sides = static_cast<std::uint8_t>(sides | 1u << side);
  }
  for (int side = 0; side < sight_.side_count(); ++side)
    if (const std::uint8_t sides = followers[static_cast<std::size_t>(side)]; sides != 0)
      add_set(cell, side, sides, visible[static_cast<std::size_t>(side)]);

  out_->cells.push_back(static_cast<std::uint16_t>(local_voxel(cell.local)));
  out_->records.push_back(record);
  out_->set_count += static_cast<std::uint32_t>(sight_.side_count());
}

std::unique_ptr<BrickCells> CellBuilder::Work::build(const BrickScene& scene, const Sealed& sealed) {
  const auto with_solid = cells_with_any<1, 2>(scene.solid);
  const auto with_smoke = cells_with_any<0, 4>(scene.smoke);
  out_ = nullptr;
  for (int i = 0; i < 512; i += 8) {
    const auto y = static_cast<std::size_t>(i >> 3 & 7), z = static_cast<std::size_t>(i >> 6);
    unsigned row = static_cast<unsigned>(with_solid[z][y] & with_smoke[z][y]);
    if (row == 0) continue;
    if (!out_) {
      out_ = std::make_unique<BrickCells>();
      known_.clear();
      first_known_.fill(0);
      scene_ = &scene;
      sealed_ = &sealed;
      planes_.move_to(scene.brick);
    }
    for (; row != 0; row &= row - 1) {
      const glm::ivec3 local(std::countr_zero(row), i >> 3 & 7, i >> 6);
      add_cell({local, ~neighbourhood_of(scene.solid, local), neighbourhood_of(scene.smoke, local)});
    }
  }
  if (out_) out_->mean_values.assign(out_->means.size() + 1, 0);
  return std::move(out_);
}

CellBuilder::CellBuilder(const PlaneSource& planes) : work_(std::make_unique<Work>(planes)) {}
CellBuilder::~CellBuilder() = default;
std::unique_ptr<BrickCells> CellBuilder::build(const BrickScene& scene, const Sealed& sealed) {
  return work_->build(scene, sealed);
}

}  // namespace brume::smoke
