#include "smoke/texel_set.hpp"

#include <array>

namespace brume::smoke {
namespace {

constexpr std::size_t kEdge = shared::kBrickTexels;
constexpr std::array<std::size_t, 3> kStrides{1, kEdge, kEdge* kEdge};

/// Per axis the texels that have one before them, and those that have one behind them.
struct Inner {
  std::array<TexelSet, 3> not_first, not_last;
  Inner() {
    for (std::size_t i = 0; i < shared::kTexelsPerBrick; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        not_first[a][i] = texel_at(i)[axis] > 0;
        not_last[a][i] = texel_at(i)[axis] < shared::kBrickTexels - 1;
      }
  }
};

}  // namespace

TexelSet smoky_texels(std::span<const Texel> texels) {
  TexelSet set;
  for (std::size_t i = 0; i < texels.size(); ++i) set[i] = texels[i].density > 0;
  return set;
}

TexelSet dilated(const TexelSet& set) {
  static const Inner kInner;
  TexelSet wider = set;
  for (std::size_t axis = 0; axis < 3; ++axis)
    wider |= (wider & kInner.not_last[axis]) << kStrides[axis] |
             (wider & kInner.not_first[axis]) >> kStrides[axis];
  return wider;
}

}  // namespace brume::smoke
