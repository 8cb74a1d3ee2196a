// Values of half floats in bricks, filtered as a texture unit does, in full precision.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "core/box.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::reference {

/// The value of each half float.
const std::array<float, 65536>& half_values();

/// The first channel of a sparse volume, `Components` half floats a texel. The volume must outlive it.
template <int Components>
class BrickField {
 public:
  using Value = glm::vec<Components, float>;

  BrickField() = default;
  explicit BrickField(const volume::SparseVolume& volume);

  /// Trilinear at a point of the voxel space; 0 outside of the bricks.
  Value at(const glm::vec3& p_voxel) const;
  /// The box around all bricks [voxels].
  Box<int> voxels() const { return {8 * low_, 8 * (low_ + size_)}; }
  /// Calls visit(voxels, low, high) for parts of every brick with the least and the largest of all values
  /// that `at` filters there.
  template <typename Visit>
  void for_each_part(const Visit& visit) const;
  /// The least and the largest of all values that `at` filters in a box within one brick.
  std::pair<Value, Value> range_in(const Box<int>& voxels) const;

 private:
  static constexpr int kPart = 4;  // [voxels]
  struct Brick {
    const std::uint16_t* texels = nullptr;  // null: none, or uniform
    std::uint16_t uniform = 0;
  };
  const Brick* find(const glm::ivec3& brick) const {
    const glm::ivec3 at = brick - low_;
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, size_)))
      return nullptr;
    return &bricks_[index(at)];
  }
  std::size_t index(const glm::ivec3& at) const {
    const glm::u64vec3 p(at), size(size_);
    return p.x + size.x * (p.y + size.y * p.z);
  }

  glm::ivec3 low_{0}, size_{0};  // [bricks]
  std::vector<Brick> bricks_;
};

template <int Components>
typename BrickField<Components>::Value BrickField<Components>::at(const glm::vec3& p_voxel) const {
  const std::array<float, 65536>& halves = half_values();
  const glm::ivec3 brick(glm::floor(p_voxel * 0.125f));
  const Brick* const found = find(brick);
  if (!found) return Value(0);
  if (!found->texels) return Value(halves[found->uniform]);
  // Texel (1, 1, 1) of a brick is its first voxel.
  const glm::vec3 p = p_voxel - glm::vec3(8 * brick) + 0.5f, low = glm::min(glm::floor(p), glm::vec3(8)),
                  f = p - low;
  const std::uint16_t* const texel =
      found->texels +
      Components * (static_cast<int>(low.x) + 10 * (static_cast<int>(low.y) + 10 * static_cast<int>(low.z)));
  Value value;
  for (int c = 0; c < Components; ++c) {
    const auto row = [&](int offset) {
      const float a = halves[texel[Components * offset + c]],
                  b = halves[texel[Components * (offset + 1) + c]];
      return a + (b - a) * f.x;
    };
    const float near = row(0) + (row(10) - row(0)) * f.y, far = row(100) + (row(110) - row(100)) * f.y;
    value[c] = near + (far - near) * f.z;
  }
  return value;
}

template <int Components>
std::pair<typename BrickField<Components>::Value, typename BrickField<Components>::Value>
BrickField<Components>::range_in(const Box<int>& voxels) const {
  const std::array<float, 65536>& halves = half_values();
  const glm::ivec3 number(glm::floor(glm::vec3(voxels.low) * 0.125f));
  const Brick* const brick = find(number);
  if (!brick) return {Value(0), Value(0)};
  if (!brick->texels) return {Value(halves[brick->uniform]), Value(halves[brick->uniform])};
  Value low(1e30f), high(-1e30f);
  for_each_in(Box<int>{voxels.low - 8 * number, voxels.high - 8 * number + 2}, [&](glm::ivec3 t) {
    for (int c = 0; c < Components; ++c) {
      const float value = halves[brick->texels[Components * (t.x + 10 * (t.y + 10 * t.z)) + c]];
      low[c] = glm::min(low[c], value);
      high[c] = glm::max(high[c], value);
    }
  });
  return {low, high};
}

template <int Components>
template <typename Visit>
void BrickField<Components>::for_each_part(const Visit& visit) const {
  const std::array<float, 65536>& halves = half_values();
  for_each_in(Box<int>{glm::ivec3(0), size_}, [&](glm::ivec3 at) {
    const Brick& brick = bricks_[index(at)];
    const glm::ivec3 first = 8 * (low_ + at);
    if (!brick.texels) {
      if (brick.uniform != 0)
        visit(Box<int>{first, first + 8}, Value(halves[brick.uniform]), Value(halves[brick.uniform]));
      return;
    }
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(8 / kPart)}, [&](glm::ivec3 part) {
      const Box<int> voxels{first + kPart * part, first + kPart * part + kPart};
      const auto [low, high] = range_in(voxels);
      visit(voxels, low, high);
    });
  });
}

}  // namespace brume::reference
