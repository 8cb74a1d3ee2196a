// Sets of the texels of a brick.
#pragma once

#include <bitset>
#include <span>

#include "smoke/density_channel.hpp"

namespace brume::smoke {

/// By x + 10 (y + 10 z).
using TexelSet = std::bitset<shared::kTexelsPerBrick>;

inline glm::ivec3 texel_at(std::size_t index) {
  constexpr int kEdge = shared::kBrickTexels;
  const int i = static_cast<int>(index);
  return {i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)};
}

inline std::size_t texel_index(glm::ivec3 texel) {
  constexpr int kEdge = shared::kBrickTexels;
  return static_cast<std::size_t>(texel.x + kEdge * (texel.y + kEdge * texel.z));
}

/// The texels with smoke.
TexelSet smoky_texels(std::span<const Texel> texels);
/// The texels of a set and those next to them, corners included.
TexelSet dilated(const TexelSet& set);

}  // namespace brume::smoke
