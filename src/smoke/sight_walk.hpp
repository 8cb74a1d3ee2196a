// A ray's way through the smoke, from brick to brick.
#pragma once

#include <algorithm>

#include "core/float4.hpp"
#include "shared/dda.h"
#include "smoke/sight_cell.hpp"
#include "smoke/sight_smoke.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

/// The bricks with smoke that a ray enters, in order. Within one, whoever walks its cells moves `t` and
/// `cell`.
class BrickWalk {
 public:
  BrickWalk() = default;
  explicit BrickWalk(const SmokeRay& ray)
      : direction_(ray.direction),
        ray_at_(ray.at),
        start_{ray.cell.x, ray.cell.y, ray.cell.z, 0},
        length_(ray.length) {
    // Lane 3 is beyond the exits of axes along which the ray does not move.
    inverse_ = Float4{shared::dda_inverse(direction_[0]), shared::dda_inverse(direction_[1]),
                      shared::dda_inverse(direction_[2]), 100 * kHuge};
    leaving_ = (inverse_ > splat(0)) & 1;
    stride_ = 2 * leaving_ - 1;
  }

  float t = 0;  ///< Where the ray enters `cell`.
  Int4 cell{};  ///< In the brick.
  Float4 at{};  ///< The ray's start, from the low corner of the brick.
  std::uint32_t slot = SmokeVolume::kNoSlot;

  /// On to the next brick with smoke from a cell next to the last one; false where there is none.
  bool find_brick(const SmokeVolume& volume) {
    cell += low_;
    while (t < length_) {
      const Int4 brick = (start_ + cell) >> 3;
      low_ = brick * 8 - start_;
      at = ray_at_ - to_float(low_);
      cell -= low_;
      slot = volume.slot_at({brick[0], brick[1], brick[2]});
      if (slot != SmokeVolume::kNoSlot) return true;
      skip();
      cell += low_;
    }
    return false;
  }
  /// Where the ray leaves the cell, by axis; lane 3: never. Within a brick, exits are counted on from cell to
  /// cell: at most seven sums an axis.
  Float4 exits() const { return (to_float(cell + leaving_) - at) * inverse_; }
  Float4 exits_per_cell() const { return abs4(inverse_); }
  Int4 stride() const { return stride_; }

 private:
  /// To the end of an empty brick.
  void skip() {
    const Float4 exits = (to_float(8 * leaving_) - at) * inverse_;
    const float out = std::max(t, least3(exits)[0]);
    const Int4 crossed = exits <= splat(out);
    Int4 inside = floor_to_int(at + direction_ * splat(std::min(out, length_)));
    inside = inside < 0 ? Int4{} : inside;
    inside = inside > 7 ? Int4{} + 7 : inside;
    cell = (crossed ? 9 * leaving_ - 1 : inside) & Int4{-1, -1, -1, 0};
    t = out;
  }

  Float4 direction_{}, ray_at_{}, inverse_{};
  Int4 start_{}, leaving_{}, stride_{};
  Int4 low_{};  // cell of the brick's low corner, from the ray's first cell
  float length_ = 0;
};

}  // namespace brume::smoke
