#include "smoke/growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace brume::smoke {
namespace {

constexpr std::uint64_t kMaxVoxelsInBox = std::uint64_t{1} << 26;

/// Ranks of a cloud's voxels by their position in the box around them.
class RankBox {
 public:
  explicit RankBox(const sim::Cloud& cloud)
      : low_(cloud.low()), size_(cloud.high() - cloud.low() + 1), voxels_(cloud.voxels().size()) {
    ranks_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                      static_cast<std::size_t>(size_.z),
                  sim::BlockSet::kNone);
    cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
      ranks_[index(voxel)] = rank;
      voxels_[rank] = voxel;
    });
  }
  glm::ivec3 voxel(std::uint32_t rank) const { return voxels_[rank]; }
  std::uint32_t rank(glm::ivec3 voxel) const {
    const glm::ivec3 at = voxel - low_;
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, size_)))
      return sim::BlockSet::kNone;
    return ranks_[index(voxel)];
  }
  /// Whether the straight line between two voxels' centres stays in the cloud, sampled twice a voxel.
  bool connected(glm::ivec3 a, glm::ivec3 b) const {
    const glm::vec3 from(a), path(b - a);
    const int steps = static_cast<int>(std::ceil(2 * glm::length(path)));
    for (int i = 1; i < steps; ++i) {
      const glm::vec3 p = from + path * (static_cast<float>(i) / static_cast<float>(steps));
      if (rank(glm::ivec3(glm::floor(p + 0.5f))) == sim::BlockSet::kNone) return false;
    }
    return true;
  }

 private:
  std::size_t index(glm::ivec3 voxel) const {
    const glm::ivec3 at = voxel - low_;
    return static_cast<std::size_t>(at.x) +
           static_cast<std::size_t>(size_.x) *
               (static_cast<std::size_t>(at.y) +
                static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(at.z));
  }

  glm::ivec3 low_, size_;
  std::vector<glm::ivec3> voxels_;
  std::vector<std::uint32_t> ranks_;
};

std::vector<std::uint32_t> by_distance(std::span<const std::uint32_t> distances) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t rank = 0; rank < distances.size(); ++rank)
    if (distances[rank] != sim::Cloud::kNoDistance) order.push_back(rank);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return distances[a] != distances[b] ? distances[a] < distances[b] : a < b;
  });
  return order;
}

/// Short paths from the source, voxel by voxel outwards.
class Paths {
 public:
  explicit Paths(const sim::Cloud& cloud)
      : box_(cloud),
        distances_(cloud.distances()),
        corners_(distances_.size(), sim::BlockSet::kNone),
        lengths_(distances_.size(), 0.0f) {
    for (const std::uint32_t rank : by_distance(distances_)) find(rank);
  }
  glm::vec3 growth(std::uint32_t rank) const {
    const std::uint32_t corner = corners_[rank];
    if (corner == sim::BlockSet::kNone || corner == rank) return glm::vec3(0);
    const glm::vec3 last(box_.voxel(rank) - box_.voxel(corner));
    return last * (lengths_[rank] / glm::length(last));
  }

 private:
  float length_by(std::uint32_t corner, glm::ivec3 voxel) const {
    return lengths_[corner] + glm::length(glm::vec3(voxel - box_.voxel(corner)));
  }

  /// The path to a voxel: straight on from the last corner of a neighbour's, or with a corner there.
  void find(std::uint32_t rank) {
    const glm::ivec3 voxel = box_.voxel(rank);
    std::array<std::pair<float, std::uint32_t>, 52>
        corners;  // the path's length, and where its last segment may begin
    std::size_t count = 0;
    // Neighbours one step nearer to the source.
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const std::uint32_t before = box_.rank(voxel + step);
      if (before == sim::BlockSet::kNone || corners_[before] == sim::BlockSet::kNone) continue;
      constexpr std::uint32_t kSteps[] = {0, sim::kFaceStep, sim::kEdgeStep, sim::kCornerStep};
      if (distances_[before] + kSteps[std::abs(step.x) + std::abs(step.y) + std::abs(step.z)] !=
          distances_[rank])
        continue;
      for (const std::uint32_t corner : {corners_[before], before})
        corners[count++] = {length_by(corner, voxel), corner};
    }
    // The shortest that stays in the cloud; one with a corner at the neighbour always does.
    std::sort(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count));
    corners_[rank] = rank;  // the source's
    for (std::size_t i = 0; i < count && corners_[rank] == rank; ++i) {
      if (i > 0 && corners[i] == corners[i - 1]) continue;
      if (!box_.connected(voxel, box_.voxel(corners[i].second))) continue;
      corners_[rank] = corners[i].second;
      lengths_[rank] = corners[i].first;
    }
  }

  RankBox box_;
  std::span<const std::uint32_t> distances_;
  std::vector<std::uint32_t> corners_;
  std::vector<float> lengths_;
};

}  // namespace

std::vector<glm::vec3> growth_of(const sim::Cloud& cloud) {
  std::vector<glm::vec3> growth(cloud.voxels().size(), glm::vec3(0));
  if (growth.empty()) return growth;
  const glm::u64vec3 size(cloud.high() - cloud.low() + 1);
  if (size.x * size.y * size.z > kMaxVoxelsInBox) {
    cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
      if (cloud.distances()[rank] != sim::Cloud::kNoDistance)
        growth[rank] = glm::vec3(voxel - cloud.origin().source);
    });
    return growth;
  }
  const Paths paths(cloud);
  for (std::uint32_t rank = 0; rank < growth.size(); ++rank) growth[rank] = paths.growth(rank);
  return growth;
}

}  // namespace brume::smoke
