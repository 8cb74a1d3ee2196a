#include "smoke/sight_smoke.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "shared/dda.h"

namespace brume::smoke {
namespace {

static_assert(std::endian::native == std::endian::little, "densities are read four bytes at once");

constexpr float kHuge = 1e30f;
constexpr int kRow = shared::kBrickTexels, kLayer = kRow * kRow;
constexpr int kEntryRow = kRow - 1;  // of the cells of a brick

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

Corners corners_of_set(glm::uvec2 set) {
  const Uint4 rows{set.x, set.x >> 16, set.y, set.y >> 16};
  return {to_float(rows & 255u), to_float(rows >> 8 & 255u)};
}

constexpr Float4 kOnesY{1, 0, 1, 0}, kSignsY{-1, 1, -1, 1}, kOnesZ{1, 1, 0, 0}, kSignsZ{-1, -1, 1, 1};

/// Integrates density along a direction. It is a cubic c0 + c1 t + c2 t^2 + c3 t^3 of the distance t from the
/// middle of a part that is 2 h long; the odd terms cancel, 2 h (c0 + h^2 c2 / 3) stays: no error.
struct CellIntegral {
  Float4 yz, xy, xz;  ///< Products of the direction's axes, with the signs of the corners.

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

/// Walks a ray through the cells of the smoke's bricks.
class Walk {
 public:
  Walk(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes)
      : volume_(volume), ray_(ray), holes_(holes), integral_(ray.direction) {
    if (holes && !holes->pieces.empty()) next_hole_ = holes->pieces[0].begin;
    for (int axis = 0; axis < 3; ++axis) {
      inverse_[axis] = shared::dda_inverse(ray.direction[axis]);
      leaving_[axis] = inverse_[axis] > 0;
    }
    inverse_[3] = 100 * kHuge;  // beyond the exits of axes along which the ray does not move
    leaving_[3] = 1;
    stride_ = 2 * leaving_ - 1;
    for (int axes = 0; axes < 8; ++axes) {
      const auto step = [&](int row) {
        return (axes & 1 ? stride_[0] : 0) + (axes & 2 ? stride_[1] * row : 0) +
               (axes & 4 ? stride_[2] * row * row : 0);
      };
      texel_steps_[static_cast<std::size_t>(axes)] = step(kRow);
      entry_steps_[static_cast<std::size_t>(axes)] = step(kEntryRow);
    }
  }

  float run(float enough) {
    const Int4 start{ray_.cell.x, ray_.cell.y, ray_.cell.z, 0};
    Int4 cell{};  // from the start
    for (float t = 0; t < ray_.length;) {
      const Int4 brick = (start + cell) >> 3;
      const Int4 low = brick * 8 - start;
      at_ = ray_.at - to_float(low);
      cell -= low;
      const std::uint32_t slot = volume_.slot_at({brick[0], brick[1], brick[2]});
      if (slot == SmokeVolume::kNoSlot) {
        t = skip(t, cell);
      } else {
        t = through_brick(slot, t, cell);
        if (sum4(total_) > enough * 255) break;
      }
      cell += low;
    }
    return sum4(total_) * (1.0f / 255);
  }

 private:
  Float4 leave(Int4 cell) const { return (to_float(cell + leaving_) - at_) * inverse_; }

  /// On to the brick after an empty one.
  float skip(float t, Int4& cell) const {
    const Float4 exits = (to_float(8 * leaving_) - at_) * inverse_;
    const float out = std::max(t, least3(exits)[0]);
    const Int4 crossed = exits <= splat(out);
    const Int4 inside = floor_to_int(at_ + ray_.direction * splat(std::min(out, ray_.length)));
    const Int4 beyond = 9 * leaving_ - 1;
    cell = crossed ? beyond : inside;
    for (int axis = 0; axis < 3; ++axis) {
      if (!crossed[axis]) cell[axis] = std::clamp(cell[axis], 0, 7);
    }
    cell[3] = 0;
    return out;
  }

  float through_brick(std::uint32_t slot, float t, Int4& cell) {
    const auto first_of = [&](int row) { return cell[0] + row * (cell[1] + row * cell[2]); };
    const Texel* texels = volume_.texels(slot).data();
    const std::uint32_t* entries = volume_.cells(slot).data();
    int texel = first_of(kRow), entry = first_of(kEntryRow);
    // Within a brick, exits are counted on from cell to cell: at most seven sums an axis.
    Float4 exits = leave(cell);
    const Int4 per_cell = reinterpret_cast<Int4>(abs4(inverse_));
    while (t < ray_.length && bits_of((cell & ~7) != 0) == 0) {
      const Float4 first = least3(exits);
      const float out = std::min(first[0], ray_.length);
      const Int4 crossed = exits <= first, here = cell;
      const Texel* texel_here = texels + texel;
      const std::uint32_t entry_here = entries[entry];
      const std::uint32_t axes = bits_of(crossed);
      cell += stride_ & crossed;
      texel += texel_steps_[axes];
      entry += entry_steps_[axes];
      exits += reinterpret_cast<Float4>(per_cell & crossed);
      if (!(out > t)) continue;
      if (entry_here != 0) {
        through_boundary(volume_.boundary_cells()[entry_here - 1], at_ - to_float(here), t, out);
      } else {
        const TexelRows rows(texel_here);
        if (!rows.empty()) add(rows.corners(), at_ - to_float(here), t, out);
      }
      t = out;
    }
    return t;
  }

  /// A cell with surfaces: one part for each side that the ray is on.
  void through_boundary(const shared::BoundaryCell& cell, Float4 at, float t, float out) {
    const PlanesOnRay planes(cell, at, ray_.direction);
    // Where the ray crosses the planes, in order.
    std::array<float, 5> cuts{t};
    std::size_t count = 1;
    const Float4 crossings = -planes.height / planes.slope;
    const Int4 cut_here = (crossings > splat(t)) & (crossings < splat(out)) & planes.there;
    for (std::uint32_t bits = bits_of(cut_here); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(bits));
      std::size_t place = count++;
      for (; cuts[place - 1] > crossings[k]; --place) cuts[place] = cuts[place - 1];
      cuts[place] = crossings[k];
    }
    cuts[count] = out;

    // Each part with the corner set of its side.
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t side = planes.side(0.5f * (cuts[i] + cuts[i + 1]));
      const glm::uvec2 set = volume_.corner_sets()[cell.first_set + side];
      if (set != glm::uvec2(0)) add(corners_of_set(set), at, cuts[i], cuts[i + 1]);
    }
  }

  /// Adds a part of a cell.
  void add(const Corners& corners, Float4 at, float from, float to) {
    if (to <= next_hole_) {
      total_ += plain(corners, at, from, to);
    } else {
      add_holed(corners, at, from, to);
    }
  }

  Float4 plain(const Corners& corners, Float4 at, float from, float to) const {
    return integral_(corners, at + ray_.direction * splat(0.5f * (from + to)), to - from);
  }

  void add_holed(const Corners& corners, Float4 at, float from, float to) {
    const std::vector<HolePiece>& pieces = holes_->pieces;
    for (std::size_t i = next_; i < pieces.size() && pieces[i].begin < to; ++i) {
      const HolePiece& piece = pieces[i];
      if (from < piece.begin) {
        total_ += plain(corners, at, from, piece.begin);
        from = piece.begin;
      }
      const float end = std::min(to, piece.end);
      if (from < end && !piece.gone)
        total_ += holed_integral(corners, at, ray_.direction, from, end, *holes_, piece);
      from = std::max(from, end);
    }
    if (from < to) total_ += plain(corners, at, from, to);
    while (next_ < pieces.size() && pieces[next_].end <= to) ++next_;
    next_hole_ = next_ < pieces.size() ? pieces[next_].begin : kHuge;
  }

  const SmokeVolume& volume_;
  const SmokeRay& ray_;
  const HolesOnRay* holes_;
  CellIntegral integral_;
  std::size_t next_ = 0;     // of the holes' pieces: the first that ends beyond here
  float next_hole_ = kHuge;  // where it begins
  Int4 stride_{}, leaving_{};
  /// From one cell to the next, by the axes along which the ray leaves it.
  std::array<int, 8> texel_steps_{}, entry_steps_{};
  Float4 inverse_{};
  Float4 at_{};  // of the ray's start, from the low corner of the brick
  Float4 total_{};
};

}  // namespace

std::optional<SmokeRay> clip_to_smoke(const shared::VolumeLayout& layout, glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 line = b - a;
  const double length = std::sqrt(line.x * line.x + line.y * line.y + line.z * line.z);
  if (!(length > 0)) return std::nullopt;

  // The part within the bounds.
  const glm::dvec3 direction = line / length;
  double begin = 0, end = length;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double{layout.bounds_min[axis]} - a[axis],
                 high = double{layout.bounds_max[axis]} - a[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double inverse = 1 / direction[axis];
    const double t0 = low * inverse, t1 = high * inverse;
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  if (!(begin < end)) return std::nullopt;

  // From its first cell.
  SmokeRay ray;
  ray.skipped = begin;
  ray.length = static_cast<float>(end - begin);
  for (int axis = 0; axis < 3; ++axis) {
    const double start = a[axis] + begin * direction[axis] + 0.5;
    const auto cell = static_cast<int>(start) - (start < static_cast<int>(start));
    ray.cell[axis] = cell;
    ray.at[axis] = static_cast<float>(start - cell);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  return ray;
}

float smoke_on_ray(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes, float enough) {
  return Walk(volume, ray, holes).run(enough);
}

}  // namespace brume::smoke
