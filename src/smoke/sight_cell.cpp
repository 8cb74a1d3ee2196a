#include "smoke/sight_cell.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace brume::smoke {
namespace {

Corners corners_of_set(glm::uvec2 set) {
  const Uint4 rows{set.x, set.x >> 16, set.y, set.y >> 16};
  return {to_float(rows & 255u), to_float(rows >> 8 & 255u)};
}

/// Densities at four t.
Float4 densities_at(const Corners& c, Float4 at, Float4 direction, Float4 t) {
  const Float4 x = splat(at[0]) + splat(direction[0]) * t, y = splat(at[1]) + splat(direction[1]) * t,
               z = splat(at[2]) + splat(direction[2]) * t;
  std::array<Float4, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) rows[i] = splat(c.low_x[i]) + splat(c.high_x[i] - c.low_x[i]) * x;
  const Float4 low = rows[0] + (rows[1] - rows[0]) * y, high = rows[2] + (rows[3] - rows[2]) * y;
  return low + (high - low) * z;
}

/// The same integral times the fraction that the holes leave, within one piece: four points.
Float4 holed_integral(const Corners& c, Float4 at, Float4 direction, float t0, float t1,
                      const HolesOnRay& holes, const HolePiece& piece) {
  constexpr Float4 kNodes{-0.861136312f, -0.339981044f, 0.339981044f, 0.861136312f};
  constexpr Float4 kWeights{0.347854845f, 0.652145155f, 0.652145155f, 0.347854845f};
  const float half = 0.5f * (t1 - t0);
  const Float4 t = splat(0.5f * (t0 + t1)) + kNodes * splat(half);
  return densities_at(c, at, direction, t) * holes.remaining(piece, t) * (kWeights * splat(half));
}

/// The planes of a boundary cell along a ray, a lane each; equal to shared::boundary_side but for rounding.
struct PlanesOnRay {
  Float4 height, slope;  ///< Over the plane, up to a factor above 0: height + slope t.
  Int4 there;

  PlanesOnRay(const shared::BoundaryCell& cell, Float4 at, Float4 direction) {
    Uint4 packed;
    static_assert(sizeof(cell) == sizeof(packed));
    std::memcpy(&packed, &cell, sizeof(packed));
    there = (packed != 0u) & Int4{-1, -1, -1, 0};
    // shared::plane_normal and plane_offset, times 511 and the length of the raw normal.
    const Int4 bits = reinterpret_cast<Int4>(packed);
    Float4 x = to_float((bits & 1023) - 511), y = to_float((bits >> 10 & 1023) - 511);
    const Float4 z = splat(511) - abs4(x) - abs4(y), fold = max4(-z, splat(0));
    x -= with_sign_of(fold, x);
    y -= with_sign_of(fold, y);
    const Float4 offset = to_float(reinterpret_cast<Int4>(packed >> 20) - 2047) * splat(1.0f / 2047);
    height = x * splat(at[0] - 0.5f) + y * splat(at[1] - 0.5f) + z * splat(at[2] - 0.5f) -
             offset * sqrt4(x * x + y * y + z * z);
    slope = x * splat(direction[0]) + y * splat(direction[1]) + z * splat(direction[2]);
  }

  std::uint32_t side(float t) const { return bits_of((height + slope * splat(t) > splat(0)) & there); }
};

}  // namespace

void SmokeSum::add_boundary(const shared::BoundaryCell& cell, Float4 at, float from, float to) {
  const PlanesOnRay planes(cell, at, direction_);
  // Where the ray crosses the planes, in order.
  std::array<float, 5> cuts{from};
  std::size_t count = 1;
  const Float4 crossings = -planes.height / planes.slope;
  const Int4 cut_here = (crossings > splat(from)) & (crossings < splat(to)) & planes.there;
  for (std::uint32_t bits = bits_of(cut_here); bits != 0; bits &= bits - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(bits));
    std::size_t place = count++;
    for (; cuts[place - 1] > crossings[k]; --place) cuts[place] = cuts[place - 1];
    cuts[place] = crossings[k];
  }
  cuts[count] = to;

  // Each part with the corner set of its side.
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t side = planes.side(0.5f * (cuts[i] + cuts[i + 1]));
    const glm::uvec2 set = volume_->corner_sets()[cell.first_set + side];
    if (set != glm::uvec2(0)) add(corners_of_set(set), at, cuts[i], cuts[i + 1]);
  }
}

void SmokeSum::add_holed(const Corners& corners, Float4 at, float from, float to) {
  const std::vector<HolePiece>& pieces = holes_->pieces;
  for (std::size_t i = next_; i < pieces.size() && pieces[i].begin < to; ++i) {
    const HolePiece& piece = pieces[i];
    if (from < piece.begin) {
      total += plain(corners, at, from, piece.begin);
      from = piece.begin;
    }
    const float end = std::min(to, piece.end);
    if (from < end && !piece.gone)
      total += holed_integral(corners, at, direction_, from, end, *holes_, piece);
    from = std::max(from, end);
  }
  if (from < to) total += plain(corners, at, from, to);
  while (next_ < pieces.size() && pieces[next_].end <= to) ++next_;
  next_hole_ = next_ < pieces.size() ? pieces[next_].begin : kHuge;
}

}  // namespace brume::smoke
