#include "sim/smoke_structure.hpp"

#include <array>
#include <bit>
#include <limits>

#include "sim/cell_block.hpp"
#include "sim/sealed_pockets.hpp"

namespace brume::sim {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The 3x3x3 voxels around each corner of the cell.
std::array<Block, 8> blocks_around_corners() {
  std::array<Block, 8> around{};
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 27; ++i)
      around[static_cast<std::size_t>(corner)] |=
          block_bit(corner_offset(corner) + glm::ivec3(i % 3, i / 3 % 3, i / 9));
  return around;
}

/// Nearer voxels say more: 144 / distance^2, whole numbers that fit 8 bits.
std::uint32_t weight_of(glm::ivec3 offset) {
  const int square = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
  return static_cast<std::uint32_t>(144 / square);
}

ListTable table_from_pairs(std::size_t lists,
                           const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  ListTable table;
  table.first.assign(lists + 1, 0);
  for (const auto& [list, value] : pairs) ++table.first[list + 1];
  for (std::size_t i = 0; i < lists; ++i) table.first[i + 1] += table.first[i];
  table.values.resize(pairs.size());
  std::vector<std::uint32_t> next(table.first.begin(), table.first.end() - 1);
  for (const auto& [list, value] : pairs) table.values[next[list]++] = value;
  return table;
}

/// The side that a side takes its densities from: itself when it sees any air. Else it is the inside of
/// something and nobody is there to see it; it goes on as the side fewest planes away that sees most smoke,
/// so that smoke reaches a curved surface also where that bulges through its plane.
int side_to_follow(int side, int side_count, const std::array<Block, 8>& seen, Block smoke) {
  int best = side;
  int best_rank = -1;
  for (int other = 0; other < side_count; ++other) {
    const Block sees = seen[static_cast<std::size_t>(other)];
    if (sees == 0) continue;
    const int planes_between = std::popcount(static_cast<unsigned>(side ^ other));
    const int rank = 65 * (3 - planes_between) + std::popcount(sees & smoke);
    if (other == side || rank > best_rank) {
      best = other;
      best_rank = other == side ? 1000 : rank;
    }
  }
  return best;
}

/// A cell's surroundings.
struct CellBlock {
  Block free = 0;  // outside the grid too: smoke may end there
  Block smoke = 0;
  std::array<std::uint32_t, 64> voxel;  // number of the smoke voxel, or kNone
};

}  // namespace

class SmokeStructure::Builder {
 public:
  Builder(const voxel::BitGrid& grid, const PlaneSource& planes, SmokeStructure& out)
      : grid_(grid),
        sight_(planes),
        pockets_(grid, [this](glm::ivec3 v) { return voxel_at(v) != kNone; }),
        out_(out) {}

  void place_bricks(std::span<const LiveCloud> clouds);
  void number_voxels(std::span<const LiveCloud> clouds);
  void list_texels();
  void build_cells();

 private:
  std::uint32_t slot_at(glm::ivec3 brick) const {
    const glm::ivec3 b = brick - out_.window_origin;
    if (glm::any(glm::lessThan(b, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(b, out_.window_size)))
      return kNone;
    return out_.page_table[entry_of(b)] - 1;  // 0 wraps to kNone
  }
  std::size_t entry_of(glm::ivec3 b) const {
    return static_cast<std::size_t>(b.x) +
           static_cast<std::size_t>(out_.window_size.x) *
               (static_cast<std::size_t>(b.y) +
                static_cast<std::size_t>(out_.window_size.y) * static_cast<std::size_t>(b.z));
  }
  static std::size_t local_of(glm::ivec3 v) {
    return static_cast<std::size_t>((v.x & 7) + 8 * (v.y & 7) + 64 * (v.z & 7));
  }
  std::uint32_t voxel_at(glm::ivec3 v) const {
    const std::uint32_t slot = slot_at(v >> 3);
    return slot == kNone ? kNone : number_[512 * std::size_t{slot} + local_of(v)];
  }
  bool has_solid_corner(glm::ivec3 cell) const {
    for (int corner = 0; corner < 8; ++corner)
      if (grid_.solid(cell + corner_offset(corner))) return true;
    return false;
  }

  bool look_around(glm::ivec3 cell, CellBlock& block) const;
  void add_cell(glm::ivec3 cell, const CellBlock& block);
  Block sealed_voxels(glm::ivec3 cell, Block among);
  float way_to_surface(int plane, const std::array<Block, 8>& seen, Block smoke, Block sealed) const;
  void reach_bent_surfaces(glm::ivec3 cell, const CellBlock& block, std::array<Block, 8>& seen,
                           shared::BoundaryCell& record);
  void add_corner(const CellBlock& block, int corner, Block own_side, Block seen);
  void enter_cell(glm::ivec3 cell, std::uint32_t entry);

  const voxel::BitGrid& grid_;
  CellSight sight_;
  SealedPockets pockets_;
  const std::array<Block, 8> around_corner_ = blocks_around_corners();
  SmokeStructure& out_;
  std::vector<std::uint32_t> number_;  // of the smoke voxel, 512 a slot
  std::vector<std::uint32_t> last_cell_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> voxel_cell_pairs_;
};

/// The bricks that hold the filled voxels and two voxels around them: a surface may run that far beyond.
void SmokeStructure::Builder::place_bricks(std::span<const LiveCloud> clouds) {
  bool any = false;
  for (const LiveCloud& live : clouds) {
    if (live.cloud->voxels().empty()) continue;
    out_.low = any ? glm::min(out_.low, live.cloud->low()) : live.cloud->low();
    out_.high = any ? glm::max(out_.high, live.cloud->high()) : live.cloud->high();
    any = true;
  }
  if (!any) return;
  out_.window_origin = (out_.low - 2) >> 3;
  out_.window_size = ((out_.high + 2) >> 3) - out_.window_origin + 1;
  out_.page_table.resize(entry_of(out_.window_size - 1) + 1);
  for (const LiveCloud& live : clouds)
    live.cloud->voxels().for_each([&](glm::ivec3 voxel, std::uint32_t) {
      for (int corner = 0; corner < 8; ++corner)
        out_.page_table[entry_of(((voxel - 2 + 4 * corner_offset(corner)) >> 3) - out_.window_origin)] = 1;
    });

  std::size_t entry = 0;
  for (int z = 0; z < out_.window_size.z; ++z)
    for (int y = 0; y < out_.window_size.y; ++y)
      for (int x = 0; x < out_.window_size.x; ++x, ++entry) {
        if (out_.page_table[entry] == 0) continue;
        out_.bricks.push_back(out_.window_origin + glm::ivec3(x, y, z));
        out_.page_table[entry] = static_cast<std::uint32_t>(out_.bricks.size());
      }
}

void SmokeStructure::Builder::number_voxels(std::span<const LiveCloud> clouds) {
  number_.assign(512 * out_.bricks.size(), kNone);
  out_.cloud_voxels.first.push_back(0);
  for (const LiveCloud& live : clouds) {
    live.cloud->voxels().for_each([&](glm::ivec3 voxel, std::uint32_t) {
      std::uint32_t& number = number_[512 * std::size_t{slot_at(voxel >> 3)} + local_of(voxel)];
      if (number == kNone) {
        number = static_cast<std::uint32_t>(out_.voxels.size());
        out_.voxels.push_back(voxel);
      }
      out_.cloud_voxels.values.push_back(number);
    });
    out_.cloud_voxels.first.push_back(static_cast<std::uint32_t>(out_.cloud_voxels.values.size()));
  }
}

/// A voxel is a texel of its own brick and of the aprons of up to seven others.
void SmokeStructure::Builder::list_texels() {
  ListTable& table = out_.voxel_texels;
  table.first.reserve(out_.voxels.size() + 1);
  table.first.push_back(0);
  for (const glm::ivec3 v : out_.voxels) {
    const glm::ivec3 first = (v - 1) >> 3, last = (v + 1) >> 3;
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          const std::uint32_t slot = slot_at({x, y, z});
          if (slot == kNone) continue;
          const glm::ivec3 t = v - 8 * glm::ivec3(x, y, z) + 1;
          table.values.push_back(slot * shared::kTexelsPerBrick +
                                 static_cast<std::uint32_t>(t.x + 10 * (t.y + 10 * t.z)));
        }
    table.first.push_back(static_cast<std::uint32_t>(table.values.size()));
  }
}

/// Reads the 4x4x4 voxels around a cell; false when there is no smoke among them.
bool SmokeStructure::Builder::look_around(glm::ivec3 cell, CellBlock& block) const {
  block.smoke = 0;
  for (int bit = 0; bit < 64; ++bit) {
    const std::uint32_t number = voxel_at(cell - 1 + block_voxel(bit));
    block.voxel[static_cast<std::size_t>(bit)] = number;
    if (number != kNone) block.smoke |= Block{1} << bit;
  }
  if (block.smoke == 0) return false;
  block.free = 0;
  for (int bit = 0; bit < 64; ++bit)
    if (!grid_.solid(cell - 1 + block_voxel(bit))) block.free |= Block{1} << bit;
  return true;
}

/// Lists what a corner takes from: itself where it is on the side in question, else the nearest voxels that
/// this side of the cell sees.
void SmokeStructure::Builder::add_corner(const CellBlock& block, int corner, Block own_side, Block seen) {
  const glm::ivec3 at = corner_offset(corner) + 1;
  CornerSource source{static_cast<std::uint32_t>(out_.contributions.size()), 0, 0};
  Block from = block_bit(at) & own_side;
  if (from == 0) from = seen & around_corner_[static_cast<std::size_t>(corner)];
  if (from == 0) from = seen;
  for (; from != 0; from &= from - 1) {
    const int bit = std::countr_zero(from);
    const glm::ivec3 offset = block_voxel(bit) - at;
    const std::uint32_t weight = offset == glm::ivec3(0) ? 1 : weight_of(offset);
    source.total_weight += weight;
    const std::uint32_t number = block.voxel[static_cast<std::size_t>(bit)];
    if (number == kNone) continue;
    out_.contributions.push_back({number, weight});
    ++source.count;
    const auto cell = static_cast<std::uint32_t>(out_.boundary_cells.size());
    if (last_cell_[number] == cell) continue;
    last_cell_[number] = cell;
    voxel_cell_pairs_.emplace_back(number, cell);
  }
  out_.corners.push_back(source);
}

/// The voxels of `among` in pockets that no smoke comes into.
Block SmokeStructure::Builder::sealed_voxels(glm::ivec3 cell, Block among) {
  Block sealed = 0;
  for (Block left = among; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const glm::ivec3 v = cell - 1 + block_voxel(bit);
    if (grid_.contains(v) && pockets_.sealed(v)) sealed |= Block{1} << bit;
  }
  return sealed;
}

/// How far to move a plane along its normal so that smoke on one side of it reaches the surface all over the
/// cell, where behind it nothing is but sealed pockets: what runs over ends inside of them. 0 where there is
/// air on both sides.
float SmokeStructure::Builder::way_to_surface(int plane, const std::array<Block, 8>& seen, Block smoke,
                                              Block sealed) const {
  const float way = sight_.deviation(plane);
  for (const int behind : {0, 1}) {
    bool fits = true, any_smoke = false, any_sealed = false;
    for (int side = 0; side < sight_.side_count(); ++side) {
      if ((side >> plane & 1) != behind) continue;
      const Block sees = seen[static_cast<std::size_t>(side)];
      const Block smoke_before = seen[static_cast<std::size_t>(side ^ 1 << plane)] & smoke;
      any_smoke |= smoke_before != 0;
      any_sealed |= (sees & ~sealed) == 0;
      // Air on both sides may only be the same air: the plane ends there.
      if ((sees & ~sealed) != 0) fits &= smoke_before == 0 || (smoke_before & sees) != 0;
    }
    if (fits && any_smoke && any_sealed) return behind == 1 ? way : -way;
  }
  return 0;
}

/// Where a surface bends, a piece of it that only just comes into the cell, and the pieces of the cells
/// around it, may hide all smoke from the sliver before it: then the planes of the cell alone decide. And
/// smoke has to reach the surface though that lies off its plane.
void SmokeStructure::Builder::reach_bent_surfaces(glm::ivec3 cell, const CellBlock& block,
                                                  std::array<Block, 8>& seen, shared::BoundaryCell& record) {
  bool bent = false;
  for (int plane = 0; plane < sight_.plane_count(); ++plane) bent |= sight_.deviation(plane) > 0;
  if (!bent) return;
  Block all = 0;
  for (const Block sees : seen) all |= sees;
  const Block sealed = sealed_voxels(cell, all & ~block.smoke);
  if ((all & ~sealed) == 0)
    for (int side = 0; side < sight_.side_count(); ++side) {
      Block& sees = seen[static_cast<std::size_t>(side)];
      if (sees == 0) sees = sight_.on_side(side, block.smoke);
    }
  const std::array<std::uint32_t*, voxel::kMaxPlanes> packed{&record.plane0, &record.plane1, &record.plane2};
  for (int plane = 0; plane < sight_.plane_count(); ++plane) {
    const float way = way_to_surface(plane, seen, block.smoke, sealed);
    if (way != 0) *packed[static_cast<std::size_t>(plane)] = sight_.moved_plane(plane, way);
  }
}

void SmokeStructure::Builder::add_cell(glm::ivec3 cell, const CellBlock& block) {
  sight_.look_at(cell);
  shared::BoundaryCell record = sight_.record();
  record.first_set = static_cast<std::uint32_t>(out_.corners.size() / 8);
  std::array<Block, 8> seen{};
  for (int side = 0; side < sight_.side_count(); ++side)
    seen[static_cast<std::size_t>(side)] = sight_.seen(side, block.free);
  reach_bent_surfaces(cell, block, seen, record);
  for (int side = 0; side < sight_.side_count(); ++side) {
    const int like = side_to_follow(side, sight_.side_count(), seen, block.smoke);
    const Block own_side = sight_.on_side(like, block.free);
    for (int corner = 0; corner < 8; ++corner)
      add_corner(block, corner, own_side, seen[static_cast<std::size_t>(like)]);
  }
  out_.boundary_cells.push_back(record);
}

/// Writes the cell into every brick in which its points may lie.
void SmokeStructure::Builder::enter_cell(glm::ivec3 cell, std::uint32_t entry) {
  const glm::ivec3 first = cell >> 3, last = (cell + 1) >> 3;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const std::uint32_t slot = slot_at({x, y, z});
        if (slot == kNone) continue;
        const glm::ivec3 i = cell - 8 * glm::ivec3(x, y, z) + 1;
        out_.cells[std::size_t{slot} * shared::kCellsPerBrick +
                   static_cast<std::size_t>(i.x + 9 * (i.y + 9 * i.z))] = entry;
      }
}

void SmokeStructure::Builder::build_cells() {
  out_.cells.assign(out_.bricks.size() * shared::kCellsPerBrick, 0);
  last_cell_.assign(out_.voxels.size(), kNone);
  CellBlock block;
  for (const glm::ivec3 brick : out_.bricks)
    for (int i = 0; i < 512; ++i) {
      const glm::ivec3 cell = brick * 8 + glm::ivec3(i & 7, i >> 3 & 7, i >> 6);
      if (!has_solid_corner(cell) || !look_around(cell, block)) continue;
      add_cell(cell, block);
      enter_cell(cell, static_cast<std::uint32_t>(out_.boundary_cells.size()));
    }
  out_.voxel_cells = table_from_pairs(out_.voxels.size(), voxel_cell_pairs_);
}

SmokeStructure::SmokeStructure(const voxel::BitGrid& grid, const PlaneSource& planes,
                               std::span<const LiveCloud> clouds) {
  Builder builder(grid, planes, *this);
  builder.place_bricks(clouds);
  builder.number_voxels(clouds);
  builder.list_texels();
  builder.build_cells();
}

}  // namespace brume::sim
