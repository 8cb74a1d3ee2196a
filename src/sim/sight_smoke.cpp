#include "sim/sight_smoke.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "shared/dda.h"

namespace brume::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "densities are read four bytes at once");

constexpr float kHuge = 1e30f;
constexpr std::size_t kRow = shared::kBrickTexels, kLayer = kRow * shared::kBrickTexels;

/// Densities [0, 255] of a cell's corners: lane y + 2 z, for the lower and the higher x.
struct Corners {
  Float4 low_x, high_x;
};

/// `texel` is that of the cell's lowest corner.
Corners plain_corners(const Texel* texel) {
  const auto row = [&](std::size_t offset) {
    std::uint32_t two;  // density, free, density, free
    std::memcpy(&two, texel + offset, 4);
    return two;
  };
  const Uint4 rows{row(0), row(kRow), row(kLayer), row(kLayer + kRow)};
  return {to_float(rows & 255u), to_float(rows >> 16 & 255u)};
}

Corners corners_of_set(glm::uvec2 set) {
  const Uint4 rows{set.x, set.x >> 16, set.y, set.y >> 16};
  return {to_float(rows & 255u), to_float(rows >> 8 & 255u)};
}

/// Density at f in [0, 1]^3 between the corners, as four parts to be summed.
Float4 parts_at(const Corners& c, Float4 f) {
  constexpr Float4 kOnesY{1, 0, 1, 0}, kSignsY{-1, 1, -1, 1}, kOnesZ{1, 1, 0, 0}, kSignsZ{-1, -1, 1, 1};
  const Float4 weights = (kOnesY + kSignsY * splat(f[1])) * (kOnesZ + kSignsZ * splat(f[2]));
  return weights * (c.low_x + (c.high_x - c.low_x) * splat(f[0]));
}

/// Integral from t0 to t1 along at + t direction within a cell: exact.
Float4 integral(const Corners& c, Float4 at, Float4 direction, float t0, float t1) {
  constexpr float kPoint = 0.577350269f;
  const float half = 0.5f * (t1 - t0);
  const Float4 middle = at + direction * splat(0.5f * (t0 + t1)), apart = direction * splat(kPoint * half);
  return (parts_at(c, middle - apart) + parts_at(c, middle + apart)) * splat(half);
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

/// The same integral times what the holes leave of it, within one piece: four points.
Float4 holed_integral(const Corners& c, Float4 at, Float4 direction, float t0, float t1,
                      const HolesOnRay& holes, const HolePiece& piece) {
  constexpr Float4 kPoints{-0.861136312f, -0.339981044f, 0.339981044f, 0.861136312f};
  constexpr Float4 kWeights{0.347854845f, 0.652145155f, 0.652145155f, 0.347854845f};
  const float half = 0.5f * (t1 - t0);
  const Float4 t = splat(0.5f * (t0 + t1)) + kPoints * splat(half);
  return densities_at(c, at, direction, t) * holes.left(piece, t) * (kWeights * splat(half));
}

/// Walks a ray through the cells of the smoke's bricks.
class Walk {
 public:
  Walk(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes)
      : volume_(volume), ray_(ray), holes_(holes && !holes->pieces.empty() ? holes : nullptr) {
    for (int axis = 0; axis < 3; ++axis) {
      inverse_[axis] = shared::dda_inverse(ray.direction[axis]);
      leaving_[axis] = inverse_[axis] > 0;
    }
    inverse_[3] = kHuge;
    leaving_[3] = 1;
    stride_ = 2 * leaving_ - 1;
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
    const float out = std::max(t, min3(exits));
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
    const Texel* texels = volume_.texels(slot).data();
    const std::uint32_t* entries = volume_.cells(slot).data();
    while (t < ray_.length) {
      const auto x = static_cast<std::uint32_t>(cell[0]), y = static_cast<std::uint32_t>(cell[1]),
                 z = static_cast<std::uint32_t>(cell[2]);
      if ((x | y | z) > 7) break;
      const Float4 exits = leave(cell);
      const float first = min3(exits);
      const float out = std::min(first, ray_.length);
      if (out > t) {
        const Float4 at = at_ - to_float(cell);
        const std::uint32_t entry = entries[x + 9 * (y + 9 * z)];
        if (entry != 0) {
          through_boundary(entry - 1, at, t, out);
        } else {
          add(plain_corners(texels + x + kRow * y + kLayer * z), at, t, out);
        }
        t = out;
      }
      cell += stride_ & (exits <= splat(first));
    }
    return t;
  }

  /// A cell with surfaces: one part for each side that the ray is on.
  void through_boundary(std::uint32_t number, Float4 at, float t, float out) {
    const shared::BoundaryCell& cell = volume_.boundary_cells()[number];
    const std::array planes{cell.plane0, cell.plane1, cell.plane2};
    std::array<float, 3> height, slope;  // of the ray over each plane: height + slope t
    std::array<float, 5> cuts;
    std::size_t plane_count = 0, cut_count = 1;
    cuts[0] = t;
    for (; plane_count < 3 && planes[plane_count] != 0; ++plane_count) {
      const glm::vec3 n = shared::plane_normal(planes[plane_count]);
      const float h = n.x * (at[0] - 0.5f) + n.y * (at[1] - 0.5f) + n.z * (at[2] - 0.5f) -
                      shared::plane_offset(planes[plane_count]);
      const float s = n.x * ray_.direction[0] + n.y * ray_.direction[1] + n.z * ray_.direction[2];
      height[plane_count] = h;
      slope[plane_count] = s;
      if (const float cut = -h / s; cut > t && cut < out) {
        std::size_t place = cut_count++;
        for (; cuts[place - 1] > cut; --place) cuts[place] = cuts[place - 1];
        cuts[place] = cut;
      }
    }
    cuts[cut_count] = out;
    for (std::size_t i = 0; i < cut_count; ++i) {
      const float middle = 0.5f * (cuts[i] + cuts[i + 1]);
      std::uint32_t side = 0;
      for (std::size_t k = 0; k < plane_count; ++k)
        side |= std::uint32_t{height[k] + slope[k] * middle > 0} << k;
      const glm::uvec2 set = volume_.corner_sets()[cell.first_set + side];
      if (set != glm::uvec2(0)) add(corners_of_set(set), at, cuts[i], cuts[i + 1]);
    }
  }

  /// Adds a part of a cell.
  void add(const Corners& corners, Float4 at, float from, float to) {
    if (!holes_) {
      total_ += integral(corners, at, ray_.direction, from, to);
      return;
    }
    const std::vector<HolePiece>& pieces = holes_->pieces;
    while (next_ < pieces.size() && pieces[next_].end <= from) ++next_;
    for (std::size_t i = next_; i < pieces.size() && pieces[i].begin < to; ++i) {
      const HolePiece& piece = pieces[i];
      if (from < piece.begin) total_ += integral(corners, at, ray_.direction, from, piece.begin);
      from = std::max(from, piece.begin);
      const float end = std::min(to, piece.end);
      if (!piece.gone) total_ += holed_integral(corners, at, ray_.direction, from, end, *holes_, piece);
      from = end;
    }
    if (from < to) total_ += integral(corners, at, ray_.direction, from, to);
  }

  const SmokeVolume& volume_;
  const SmokeRay& ray_;
  const HolesOnRay* holes_;
  std::size_t next_ = 0;
  Int4 stride_{}, leaving_{};
  Float4 inverse_{};
  Float4 at_{};  // of the ray's start, from the low corner of the brick
  Float4 total_{};
};

}  // namespace

std::optional<SmokeRay> clip_to_smoke(const shared::SmokeVolumeFrame& frame, glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 way = b - a;
  const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
  if (!(length > 0)) return std::nullopt;
  const glm::dvec3 direction = way / length;
  double begin = 0, end = length;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double{frame.bounds_min[axis]} - a[axis],
                 high = double{frame.bounds_max[axis]} - a[axis];
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

}  // namespace brume::sim
