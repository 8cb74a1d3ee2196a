// The smoke along a straight line within one cell, and the sum over cells.
#pragma once

#include <bit>
#include <cstring>

#include "core/float4.hpp"
#include "smoke/sight_holes.hpp"
#include "smoke/sight_smoke.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

static_assert(std::endian::native == std::endian::little, "densities are read four bytes at once");

inline constexpr float kHuge = 1e30f;
inline constexpr int kRow = shared::kBrickTexels, kLayer = kRow * kRow;
inline constexpr int kEntryRow = kRow - 1;  // of the cells of a brick

/// Densities [0, 255] of a cell's corners: lane y + 2 z, for the lower and the higher x.
struct Corners {
  Float4 low_x, high_x;
};

/// The densities of the texels of a cell, two each: density, free, density, free. `texel` is that of the
/// cell's lowest corner.
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
  std::size_t next_ = 0;     // of the holes' pieces: the first that ends beyond here
  float next_hole_ = kHuge;  // where it begins
};

}  // namespace brume::smoke
