#include "sim/cell_block.hpp"

#include <algorithm>
#include <bit>

#include "sim/pack_plane.hpp"

namespace brume::sim {
namespace {

/// Planes of neighbouring cells on a curved surface do not quite meet: they are made this much larger.
constexpr float kOverlap = 0.1f;  // [voxels]

/// Points per axis that stand for a cell: its corners are among them, where slivers of a side end.
constexpr int kSamples = 3;

/// Whether b is a continued within the given bounds, whichever way it faces.
bool continues(glm::vec3 normal_a, float offset_a, glm::vec3 normal_b, float offset_b, float cosine,
               float apart) {
  const float along = glm::dot(normal_a, normal_b);
  return std::abs(along) > cosine && std::abs(offset_b - (along > 0 ? offset_a : -offset_a)) < apart;
}

}  // namespace

void CellSight::look_at(glm::ivec3 cell) {
  sheets_.clear();
  const std::span<const voxel::Plane> own = planes_(cell);
  std::array<std::uint32_t, voxel::kMaxPlanes> packed{};
  for (std::size_t k = 0; k < own.size(); ++k) {
    packed[k] = pack_plane(own[k]);
    add_sheet(own[k], glm::ivec3(0));
  }
  record_ = {packed[0], packed[1], packed[2], 0};
  side_count_ = 1 << own.size();

  flat_ = true;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 step = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (step == glm::ivec3(0)) continue;
    for (const voxel::Plane& plane : planes_(cell + step)) {
      const float offset = plane.offset + glm::dot(plane.normal, glm::vec3(step));
      flat_ = flat_ && std::any_of(own.begin(), own.end(), [&](const voxel::Plane& mine) {
                return continues(mine.normal, mine.offset, plane.normal, offset, 0.9995f, 0.02f);
              });
      add_sheet(plane, step);
    }
  }
  for (std::vector<glm::vec3>& points : viewpoints_) points.clear();
  if (flat_) return;
  measure_voxels();
  find_viewpoints();
}

void CellSight::add_sheet(const voxel::Plane& plane, glm::ivec3 step) {
  const float offset = plane.offset + glm::dot(plane.normal, glm::vec3(step));
  const std::uint32_t bit = 1u << (step.x + 3 * step.y + 9 * step.z + 13);
  for (Sheet& sheet : sheets_) {
    if (!continues(sheet.normal, sheet.offset, plane.normal, offset, 0.99999f, 1e-3f)) continue;
    sheet.cells |= bit;
    return;
  }
  sheets_.push_back({plane.normal, offset, bit});
}

void CellSight::measure_voxels() {
  for (Sheet& sheet : sheets_) {
    sheet.positive = 0;
    for (int bit = 0; bit < 64; ++bit) {
      const float distance = glm::dot(sheet.normal, from_cell_centre(bit)) - sheet.offset;
      sheet.distance[static_cast<std::size_t>(bit)] = distance;
      sheet.positive |= Block{distance > 0} << bit;
    }
  }
}

void CellSight::find_viewpoints() {
  for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
    const glm::vec3 p =
        glm::vec3(i % kSamples, i / kSamples % kSamples, i / (kSamples * kSamples)) / float{kSamples - 1} -
        0.5f;
    viewpoints_[shared::boundary_side(record_, p)].push_back(p);
  }
  for (std::vector<glm::vec3>& points : viewpoints_) {
    if (points.empty()) continue;
    glm::vec3 middle(0);
    for (const glm::vec3 p : points) middle += p;
    points.insert(points.begin(), middle / static_cast<float>(points.size()));
  }
}

Block CellSight::on_side(int side, Block among) const {
  Block result = 0;
  for (Block left = among; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    if (shared::boundary_side(record_, from_cell_centre(bit)) == static_cast<std::uint32_t>(side))
      result |= Block{1} << bit;
  }
  return result;
}

Block CellSight::seen_from(glm::vec3 viewpoint, Block among) const {
  for (const Sheet& sheet : sheets_) {
    const float here = glm::dot(sheet.normal, viewpoint) - sheet.offset;
    // Only voxels beyond the plane can be hidden by it.
    for (Block beyond = among & (here > 0 ? ~sheet.positive : sheet.positive); beyond != 0;
         beyond &= beyond - 1) {
      const int bit = std::countr_zero(beyond);
      const float there = sheet.distance[static_cast<std::size_t>(bit)];
      const glm::vec3 crossing = viewpoint + (from_cell_centre(bit) - viewpoint) * (here / (here - there));
      const glm::ivec3 low = glm::clamp(glm::ivec3(glm::floor(crossing + (1.5f - kOverlap))), 0, 2);
      const glm::ivec3 high = glm::clamp(glm::ivec3(glm::floor(crossing + (1.5f + kOverlap))), 0, 2);
      bool hit = false;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 c(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                           corner & 4 ? high.z : low.z);
        hit |= (sheet.cells >> (c.x + 3 * c.y + 9 * c.z) & 1) != 0;
      }
      if (hit) among &= ~(Block{1} << bit);
    }
  }
  return among;
}

Block CellSight::seen(int side, Block among) {
  if (flat_) return on_side(side, among);
  // The middle of the side speaks for all of it; where it sees nothing, any other point may.
  for (const glm::vec3 viewpoint : viewpoints_[static_cast<std::size_t>(side)]) {
    const Block result = seen_from(viewpoint, among);
    if (result != 0) return result;
  }
  return 0;
}

}  // namespace brume::sim
