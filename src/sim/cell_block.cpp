#include "sim/cell_block.hpp"

#include <algorithm>
#include <bit>

#include "sim/pack_plane.hpp"

namespace brume::sim {
namespace {

/// Squares of neighbouring cells on a curved surface do not quite meet: they are made this much larger.
constexpr float kOverlap = 0.1f;  // [voxels]

/// Points per axis that stand for a cell, those on its faces included.
constexpr int kSamples = 5;

}  // namespace

void CellSight::look_at(glm::ivec3 cell) {
  squares_.clear();
  const std::span<const voxel::Plane> own = planes_(cell);
  std::array<std::uint32_t, voxel::kMaxPlanes> packed{};
  for (std::size_t k = 0; k < own.size(); ++k) {
    packed[k] = pack_plane(own[k]);
    squares_.push_back({own[k].normal, own[k].offset, glm::vec3(0)});
  }
  record_ = {packed[0], packed[1], packed[2], 0};
  side_count_ = 1 << own.size();

  flat_ = true;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 step = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (step == glm::ivec3(0)) continue;
    for (const voxel::Plane& plane : planes_(cell + step)) {
      const glm::vec3 centre(step);
      const float offset = plane.offset + glm::dot(plane.normal, centre);
      flat_ = flat_ && std::any_of(squares_.begin(), squares_.begin() + static_cast<long>(own.size()),
                                   [&](const Square& s) {
                                     const float along = glm::dot(s.normal, plane.normal);
                                     return std::abs(along) > 0.9995f &&
                                            std::abs(offset - (along > 0 ? s.offset : -s.offset)) < 0.02f;
                                   });
      squares_.push_back({plane.normal, offset, centre});
    }
  }
  for (std::vector<glm::vec3>& points : viewpoints_) points.clear();
  if (!flat_) find_viewpoints();
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

bool CellSight::hidden(glm::vec3 from, glm::vec3 to) const {
  for (const Square& square : squares_) {
    const float a = glm::dot(square.normal, from) - square.offset;
    const float b = glm::dot(square.normal, to) - square.offset;
    if ((a > 0) == (b > 0)) continue;
    const glm::vec3 crossing = from + (to - from) * (a / (a - b)) - square.cell;
    if (glm::all(glm::lessThanEqual(glm::abs(crossing), glm::vec3(0.5f + kOverlap)))) return true;
  }
  return false;
}

Block CellSight::seen(int side, Block among) {
  if (flat_) return on_side(side, among);
  // The middle of the side speaks for all of it; where it sees nothing, any other point may.
  for (const glm::vec3 viewpoint : viewpoints_[static_cast<std::size_t>(side)]) {
    Block result = 0;
    for (Block left = among; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      if (!hidden(viewpoint, from_cell_centre(bit))) result |= Block{1} << bit;
    }
    if (result != 0) return result;
  }
  return 0;
}

}  // namespace brume::sim
