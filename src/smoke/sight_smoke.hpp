// The smoke along a straight line, integrated cell by cell.
//
// Between the centres of eight voxels density is trilinear, so that along a line it is a polynomial of degree
// three: two points of Gauss and Legendre integrate it exactly. Where planes run through a cell, the line is
// cut at them, and each part takes the corner set of its side (docs/how/smoke.md).
//
// smoke_on_ray walks one ray. A packet of rays (sight_packet.hpp) walks with the same classes: BrickWalk from
// brick to brick, SmokeSum over the cells.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/glm.hpp>
#include <optional>

#include "core/float4.hpp"
#include "shared/dda.h"
#include "smoke/sight_holes.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

/// The part of a line in which there can be smoke. Its points are cell + at + t direction for t in [0,
/// length], in voxels, counted so that the cell between the centres of voxels v - 1 and v is v.
struct SmokeRay {
  glm::ivec3 cell{0};
  Float4 at{};         ///< In [0, 1); lane 3: 0.
  Float4 direction{};  ///< Unit length; lane 3: 0.
  float length = 0;
  double skipped = 0;  ///< How far from the line's first point it begins [voxels].
};

/// None when the line from `a` to `b` (voxel space, finite) passes no smoke.
std::optional<SmokeRay> clip_to_smoke(const shared::VolumeLayout& layout, glm::dvec3 a, glm::dvec3 b);

/// Integral over the ray of density [0, 1] times the fraction that the holes leave [voxels]. `holes` in the
/// ray's t, null for none. Once the integral is above `enough` it may stop: the result is then only known to
/// be above `enough`.
float smoke_on_ray(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes, float enough);

static_assert(std::endian::native == std::endian::little, "densities are read four bytes at once");

inline constexpr float kHuge = 1e30f;
inline constexpr int kRow = shared::kBrickTexels, kLayer = kRow * kRow;
inline constexpr int kEntryRow = shared::kBrickVoxels;  // cells that rays pass in a brick along an axis

/// Densities [0, 255] of a cell's corners: lane y + 2 z, for the lower and the higher x.
struct Corners {
  Float4 low_x, high_x;
};

/// The densities of the texels of a cell, two each: density, free, density, free. `texel` is the cell's
/// lowest corner.
struct TexelRows {
  std::uint32_t rows[4];
  explicit TexelRows(const Texel* texel) {
    std::memcpy(&rows[0], texel, 4);
    std::memcpy(&rows[1], texel + kRow, 4);
    std::memcpy(&rows[2], texel + kLayer, 4);
    std::memcpy(&rows[3], texel + kLayer + kRow, 4);
  }
  bool empty() const { return ((rows[0] | rows[1] | rows[2] | rows[3]) & 0x00ff00ffu) == 0; }
  Corners corners() const {
    const Uint4 all{rows[0], rows[1], rows[2], rows[3]};
    return {to_float(all & 255u), to_float(all >> 16 & 255u)};
  }
};

inline constexpr Float4 kOnesY{1, 0, 1, 0}, kSignsY{-1, 1, -1, 1}, kOnesZ{1, 1, 0, 0}, kSignsZ{-1, -1, 1, 1};

/// Integrates density along a direction. It is a cubic c0 + c1 t + c2 t^2 + c3 t^3 of the distance t from the
/// middle of a part that is 2 h long; the odd terms cancel, 2 h (c0 + h^2 c2 / 3) stays: no error.
struct CellIntegral {
  Float4 yz{}, xy{}, xz{};  ///< Products of the direction's axes, with the signs of the corners.

  CellIntegral() = default;
  explicit CellIntegral(Float4 d)
      : yz(splat(d[1] * d[2]) * kSignsY * kSignsZ),
        xy(splat(d[0] * d[1]) * kSignsY),
        xz(splat(d[0] * d[2]) * kSignsZ) {}

  /// Over a length, `middle` in [0, 1]^3 between the corners; in four parts to be summed.
  Float4 operator()(const Corners& c, Float4 middle, float length) const {
    const Float4 third = splat(length * length * (1.0f / 12));  // h^2 / 3
    const Float4 y = kOnesY + kSignsY * splat(middle[1]), z = kOnesZ + kSignsZ * splat(middle[2]);
    const Float4 along_x = c.high_x - c.low_x;
    const Float4 at_x = c.low_x + along_x * splat(middle[0]);
    return (at_x * (y * z + third * yz) + along_x * (third * (xy * z + xz * y))) * splat(length);
  }
};

/// The smoke that a ray has passed, cell by cell.
class SmokeSum {
 public:
  SmokeSum() = default;
  SmokeSum(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes)
      : volume_(&volume), holes_(holes), direction_(ray.direction), integral_(ray.direction) {
    if (holes && !holes->pieces.empty()) next_hole_ = holes->pieces[0].begin;
  }

  Float4 total{};  ///< [255 voxels], in four parts to be summed.
  /// Where the next hole begins: cells that end up to there have none.
  float next_hole() const { return next_hole_; }

  /// Adds the part of a cell between two t. `at` is the ray's start, from the cell's low corner.
  void add(const Corners& corners, Float4 at, float from, float to) {
    if (to <= next_hole_) {
      total += plain(corners, at, from, to);
    } else {
      add_holed(corners, at, from, to);
    }
  }
  /// The same of a cell with surfaces: one part for each side that the ray is on.
  void add_boundary(const shared::BoundaryCell& cell, Float4 at, float from, float to);

 private:
  Float4 plain(const Corners& corners, Float4 at, float from, float to) const {
    return integral_(corners, at + direction_ * splat(0.5f * (from + to)), to - from);
  }
  void add_holed(const Corners& corners, Float4 at, float from, float to);

  const SmokeVolume* volume_ = nullptr;
  const HolesOnRay* holes_ = nullptr;
  Float4 direction_{};
  CellIntegral integral_;
  std::size_t next_ = 0;     // the first of the holes' pieces that ends beyond here
  float next_hole_ = kHuge;  // where it begins
};

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
