#include "sim/smoke_volume.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace brume::sim {
namespace {

/// Bricks per axis of an atlas: as near to a cube as doublings get.
constexpr int kMaxAtlasBricks = 2048 / shared::kBrickTexels;

glm::ivec3 grown_atlas(glm::ivec3 bricks, std::uint64_t slots) {
  if (bricks.x == 0) bricks = glm::ivec3(4);
  while (static_cast<std::uint64_t>(bricks.x) * static_cast<std::uint64_t>(bricks.y) *
             static_cast<std::uint64_t>(bricks.z) <
         slots) {
    const int axis = bricks.x <= bricks.y && bricks.x <= bricks.z ? 0 : bricks.y <= bricks.z ? 1 : 2;
    if (bricks[axis] == kMaxAtlasBricks)
      throw Error(ErrorCode::resource_limit,
                  "smoke in " + std::to_string(slots) +
                      " bricks: a 3D texture holds at most 204^3; use larger voxels");
    bricks[axis] = std::min(2 * bricks[axis], kMaxAtlasBricks);
  }
  return bricks;
}

std::size_t texel_index(std::uint32_t slot, glm::ivec3 t) {
  return std::size_t{slot} * shared::kTexelsPerBrick + static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z));
}

}  // namespace

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes)
    : grid_(grid), planes_(std::move(planes)) {
  frame_.origin_world = grid.frame().origin_world;
  frame_.voxel_size = grid.frame().voxel_size;
}

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes)
    : SmokeVolume(grid, [&planes](glm::ivec3 cell) { return planes.at(cell); }) {}

std::uint32_t SmokeVolume::slot_at(glm::ivec3 brick) const {
  const glm::ivec3 b = brick - frame_.window_origin;
  if (glm::any(glm::lessThan(b, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(b, frame_.window_size)))
    return kNoSlot;
  const glm::u64vec3 at(b), size(frame_.window_size);
  return page_table()[at.x + size.x * (at.y + size.y * at.z)] - 1;  // 0 wraps to kNoSlot
}

std::span<const Texel> SmokeVolume::texels(std::uint32_t slot) const {
  return std::span(texels_).subspan(texel_index(slot, {0, 0, 0}), shared::kTexelsPerBrick);
}

std::span<const std::uint32_t> SmokeVolume::cells(std::uint32_t slot) const {
  return std::span(structure_.cells)
      .subspan(std::size_t{slot} * shared::kCellsPerBrick, shared::kCellsPerBrick);
}

void SmokeVolume::update(const World& world) {
  BRUME_ASSERT(world.grid().frame() == grid_.frame(), "the world stands on another grid");
  const std::span<const LiveCloud> clouds = world.state().clouds;
  const bool same =
      std::equal(clouds.begin(), clouds.end(), cloud_hashes_.begin(), cloud_hashes_.end(),
                 [](const LiveCloud& live, std::uint64_t hash) { return live.cloud->hash() == hash; });
  if (!same) rebuild(clouds);

  // Densities add up where clouds overlap.
  std::vector<std::uint8_t> densities(structure_.voxels.size());
  for (std::size_t c = 0; c < clouds.size(); ++c) {
    const std::span<const std::uint32_t> numbers = structure_.cloud_voxels[c];
    const Cloud& cloud = *clouds[c].cloud;
    const CloudMoment moment = cloud.moment(world.tick());
    for (std::uint32_t rank = 0; rank < numbers.size(); ++rank) {
      std::uint8_t& sum = densities[numbers[rank]];
      sum = static_cast<std::uint8_t>(std::min(255, sum + cloud.density(rank, moment)));
    }
  }
  refresh(std::move(densities), !same);
  ++revision_;
}

void SmokeVolume::rebuild(std::span<const LiveCloud> clouds) {
  cloud_hashes_.clear();
  for (const LiveCloud& live : clouds) cloud_hashes_.push_back(live.cloud->hash());
  structure_ = SmokeStructure(grid_, planes_, clouds);
  ++generation_;

  frame_.window_origin = structure_.window_origin;
  frame_.window_size = structure_.window_size;
  frame_.atlas_bricks = grown_atlas(frame_.atlas_bricks, slot_count());
  const bool any = !structure_.voxels.empty();
  // The cells that take from voxel v are v - 2 to v + 1; their points lie in [v - 1.5, v + 2.5].
  frame_.bounds_min = any ? glm::vec3(structure_.low) - 1.5f : glm::vec3(0);
  frame_.bounds_max = any ? glm::vec3(structure_.high) + 2.5f : glm::vec3(0);

  densities_.assign(structure_.voxels.size(), 0);
  corner_sets_.assign(structure_.corners.size() / 8, glm::uvec2(0));
  texels_.assign(structure_.bricks.size() * shared::kTexelsPerBrick, {});
  for (std::uint32_t slot = 0; slot < slot_count(); ++slot) {
    const glm::ivec3 low = 8 * structure_.bricks[slot] - 1;
    glm::ivec3 t;
    for (t.z = 0; t.z < 10; ++t.z)
      for (t.y = 0; t.y < 10; ++t.y)
        for (t.x = 0; t.x < 10; ++t.x) texels_[texel_index(slot, t)].free = grid_.solid(low + t) ? 0 : 255;
  }
}

/// The eight densities of a set as the shader's eight bytes.
glm::uvec2 SmokeVolume::evaluate_set(std::size_t set) const {
  glm::uvec2 packed(0);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const CornerSource& source = structure_.corners[8 * set + corner];
    if (source.count == 0) continue;
    std::uint32_t sum = source.total_weight / 2;
    for (std::uint32_t i = source.first; i < source.first + source.count; ++i)
      sum += structure_.contributions[i].weight * densities_[structure_.contributions[i].voxel];
    packed[corner < 4 ? 0 : 1] |= sum / source.total_weight << (8 * (corner & 3));
  }
  return packed;
}

void SmokeVolume::refresh(std::vector<std::uint8_t> densities, bool all) {
  std::swap(densities_, densities);
  std::vector<bool> slot_dirty(slot_count(), all);
  std::vector<bool> cell_dirty(structure_.boundary_cells.size(), false);
  for (std::size_t v = 0; v < densities_.size(); ++v) {
    if (densities_[v] == densities[v]) continue;
    for (const std::uint32_t texel : structure_.voxel_texels[v]) {
      texels_[texel].density = densities_[v];
      slot_dirty[texel / shared::kTexelsPerBrick] = true;
    }
    for (const std::uint32_t cell : structure_.voxel_cells[v]) cell_dirty[cell] = true;
  }
  dirty_slots_.clear();
  for (std::uint32_t slot = 0; slot < slot_dirty.size(); ++slot)
    if (slot_dirty[slot]) dirty_slots_.push_back(slot);

  corner_sets_dirty_ = all;
  for (std::size_t cell = 0; cell < cell_dirty.size(); ++cell) {
    if (!cell_dirty[cell]) continue;
    const bool last = cell + 1 == cell_dirty.size();
    const std::size_t end = last ? corner_sets_.size() : structure_.boundary_cells[cell + 1].first_set;
    for (std::size_t set = structure_.boundary_cells[cell].first_set; set < end; ++set) {
      const glm::uvec2 packed = evaluate_set(set);
      corner_sets_dirty_ |= packed != corner_sets_[set];
      corner_sets_[set] = packed;
    }
  }
}

float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel) {
  const glm::ivec3 brick(glm::floor(position_voxel / 8.0f));
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == SmokeVolume::kNoSlot) return 0;

  // Trilinear density and share of free corners.
  const glm::ivec3 cell(glm::floor(position_voxel - 0.5f));
  const glm::vec3 f = position_voxel - 0.5f - glm::vec3(cell);
  const glm::ivec3 in_brick = cell - 8 * brick + 1;
  const std::span<const Texel> texels = volume.texels(slot);
  glm::uvec2 densities(0), frees(0);
  for (int corner = 0; corner < 8; ++corner) {
    const Texel texel =
        texels[texel_index(0, in_brick + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))];
    densities[corner >> 2] |= std::uint32_t{texel.density} << (8 * (corner & 3));
    frees[corner >> 2] |= std::uint32_t{texel.free} << (8 * (corner & 3));
  }
  const float plain = shared::corner_set_density(densities, f);
  if (shared::corner_set_density(frees, f) >= 1.0f - 1.0f / 512.0f) return plain;

  // A solid corner: the set for the point's side of the surface.
  const std::uint32_t entry =
      volume.cells(slot)[static_cast<std::size_t>(in_brick.x + 9 * (in_brick.y + 9 * in_brick.z))];
  if (entry == 0) return 0;  // no smoke near
  const shared::BoundaryCell& boundary = volume.boundary_cells()[entry - 1];
  const std::uint32_t side = shared::boundary_side(boundary, f - 0.5f);
  return shared::corner_set_density(volume.corner_sets()[boundary.first_set + side], f);
}

}  // namespace brume::sim
