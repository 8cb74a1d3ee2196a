// The images that holes may have as their cross-sections, side by side in one atlas (shared/hole.h,
// kHoleMask).
//
// Atlas: each image with its edge texels repeated once around it, so that reading between texels anywhere in
// its rectangle never meets a neighbour:
//
//   +-+-----------+-+  +-+-----+-+
//   | |  image 0  | |  | |  1  | |     sides: powers of two, so that rectangles are exact
//   +-+-----------+-+  +-+-----+-+
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "shared/hole.h"
#include "sim/mask_key.hpp"

namespace brume::smoke {

/// One byte a texel, rows from the top, width * height of them: 255 removes all smoke, 0 none.
struct Mask {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> texels;
};

/// Where a mask lies in the atlas, (0, 0) to (1, 1).
struct MaskRectangle {
  glm::vec2 uv_min{0}, uv_max{0};
};

/// What a mask removes between the centres of four texels.
struct MaskCell {
  enum Kind : std::uint8_t { black, mixed, white };  ///< Nothing, anything, or all.
  Kind kind = mixed;
  /// All cells within so many of this one, along both axes, are of its kind: 0, 1, 3, 7 or kMaxMaskRadius.
  std::uint8_t radius = 0;
};
/// Largest MaskCell::radius.
constexpr int kMaxMaskRadius = 15;

/// Most texels per axis of an atlas.
constexpr std::uint32_t kMaxMaskAtlasAxis = 4096;

/// Most texels per axis of a mask.
constexpr std::uint32_t kMaxMaskAxis = kMaxMaskAtlasAxis - 2;
class MaskAtlas {
 public:
  /// No mask; one texel, 0.
  MaskAtlas() = default;
  /// The masks in their order: mask i is the number i of shots. The same atlas for the same masks. Fails with
  /// bad_input for one without texels, and with resource_limit when they are more than kMaxMasks or do
  /// not fit into an atlas of kMaxMaskAtlasAxis^2.
  static Result<MaskAtlas> pack(std::span<const Mask> masks);

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  /// Rows from the top, width() * height() of them.
  std::span<const std::uint8_t> texels() const { return texels_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(rectangles_.size()); }
  /// Where a mask below count() lies.
  const MaskRectangle& rectangle(std::uint32_t mask) const { return rectangles_[mask]; }
  /// {0, 0} for an atlas without masks.
  sim::MaskKey key() const { return key_; }

  /// The atlas at a point, [0, 1], linear between the centres of texels: as lib/hole_mask.glsl reads it, but
  /// for rounding.
  float at(glm::vec2 uv) const;

  /// Between the centres of texels (x, y) and (x + 1, y + 1).
  MaskCell cell(int x, int y) const {
    return cells_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
  }

 private:
  void find_cells();

  std::uint32_t width_ = 1, height_ = 1;
  std::vector<std::uint8_t> texels_{0};
  std::vector<MaskCell> cells_{MaskCell{}};  // as texels_; the last column and row are mixed
  std::vector<MaskRectangle> rectangles_;
  sim::MaskKey key_;
};

/// One mask of an atlas, for many lookups, which must outlive it. Its cells are counted from 0, before the
/// first texel's centre, to width and height, after the last one's.
struct MaskView {
  const MaskAtlas* atlas = nullptr;  ///< Null: no mask.
  glm::ivec2 first{0};               ///< Its first cell in the atlas.
  int width = 0, height = 0;         ///< In texels.

  MaskCell cell(glm::ivec2 at) const { return atlas->cell(first.x + at.x, first.y + at.y); }
  /// The texels around a cell: (0, 0), (1, 0), (0, 1), (1, 1).
  std::array<std::uint8_t, 4> corners(glm::ivec2 cell) const;
};
/// The mask of a hole whose rectangle is one of the atlas.
MaskView view_of(const MaskAtlas& masks, const shared::Hole& hole);

/// shared::hole_strength, masks through their images: the twin of lib/hole_mask.glsl's function of this name.
float hole_strength_masked(const shared::Hole& hole, glm::vec3 p_world, float time, float rim_noise_metres,
                           const MaskAtlas& masks);

}  // namespace brume::smoke
