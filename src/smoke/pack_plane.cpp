#include "smoke/pack_plane.hpp"

#include <algorithm>
#include <cmath>

namespace brume::smoke {

std::uint32_t pack_plane(const voxel::Plane& plane) {
  // The octahedron's lower half folds over its diagonals.
  const glm::vec3 n =
      plane.normal / (std::abs(plane.normal.x) + std::abs(plane.normal.y) + std::abs(plane.normal.z));
  glm::vec2 e(n.x, n.y);
  if (n.z < 0)
    e = glm::vec2((1 - std::abs(n.y)) * (n.x >= 0 ? 1.0f : -1.0f),
                  (1 - std::abs(n.x)) * (n.y >= 0 ? 1.0f : -1.0f));

  const glm::ivec2 below(glm::floor((e + 1.0f) * 511.0f));
  std::uint32_t normal_bits = 0;
  float best = -2;
  for (int i = 0; i < 4; ++i) {
    const glm::ivec2 q = glm::clamp(below + glm::ivec2(i & 1, i >> 1), glm::ivec2(0), glm::ivec2(1022));
    const auto bits = static_cast<std::uint32_t>(q.x | q.y << 10);
    const float cosine = glm::dot(shared::plane_normal(bits), plane.normal);
    if (cosine > best) {
      best = cosine;
      normal_bits = bits;
    }
  }
  // All four tips of the octahedron's lower half are the normal (0, 0, -1); the one that is not 0 keeps the
  // word from being 0 with the lowest offset.
  if (normal_bits == 0) normal_bits = 1022u | 1022u << 10;

  const float offset = std::clamp((plane.offset + 1) * 2047.0f, 0.0f, 4094.0f);
  return normal_bits | static_cast<std::uint32_t>(std::lround(offset)) << 20;
}

}  // namespace brume::smoke
