#include "smoke/sight_smoke.hpp"

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

/// Walks a ray through the cells of the smoke's bricks.
class Walk {
 public:
  Walk(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes)
      : volume_(volume), length_(ray.length), bricks_(ray), sum_(volume, ray, holes) {
    const Int4 stride = bricks_.stride();
    for (int axes = 0; axes < 8; ++axes) {
      const auto step = [&](int row) {
        return (axes & 1 ? stride[0] : 0) + (axes & 2 ? stride[1] * row : 0) +
               (axes & 4 ? stride[2] * row * row : 0);
      };
      texel_steps_[static_cast<std::size_t>(axes)] = step(kRow);
      entry_steps_[static_cast<std::size_t>(axes)] = step(kEntryRow);
    }
  }

  float run(float enough) {
    while (bricks_.find_brick(volume_)) {
      through_brick();
      if (sum4(sum_.total) > enough * 255) break;
    }
    return sum4(sum_.total) * (1.0f / 255);
  }

 private:
  void through_brick() {
    const Texel* texels = volume_.texels(bricks_.slot).data();
    const std::uint32_t* entries = volume_.entries(bricks_.slot);
    Int4 cell = bricks_.cell;
    const auto first_of = [&](int row) { return cell[0] + row * (cell[1] + row * cell[2]); };
    int texel = first_of(kRow), entry = first_of(kEntryRow);
    float t = bricks_.t;
    Float4 exits = bricks_.exits();
    const Int4 per_cell = reinterpret_cast<Int4>(bricks_.exits_per_cell());
    while (t < length_ && bits_of((cell & ~7) != 0) == 0) {
      // Find where the ray leaves the cell, and move on to the next one.
      const Float4 first = least3(exits);
      const float out = std::min(first[0], length_);
      const Int4 crossed = exits <= first, here = cell;
      const Texel* texel_here = texels + texel;
      const auto number_here = static_cast<std::uint32_t>(entry);
      const std::uint32_t entry_here = entries[entry];
      const std::uint32_t axes = bits_of(crossed);
      cell += bricks_.stride() & crossed;
      texel += texel_steps_[axes];
      entry += entry_steps_[axes];
      exits += reinterpret_cast<Float4>(per_cell & crossed);
      // Add the smoke on the part of the ray in the cell that it left.
      if (!(out > t)) continue;
      if (entry_here != 0) {
        sum_.add_boundary(volume_.boundary_cell(bricks_.slot, number_here, entry_here),
                          bricks_.at - to_float(here), t, out);
      } else {
        const TexelRows rows(texel_here);
        if (!rows.empty()) sum_.add(rows.corners(), bricks_.at - to_float(here), t, out);
      }
      t = out;
    }
    bricks_.t = t;
    bricks_.cell = cell;
  }

  const SmokeVolume& volume_;
  float length_;
  BrickWalk bricks_;
  SmokeSum sum_;
  /// From one cell to the next, by the axes along which the ray leaves it.
  std::array<int, 8> texel_steps_{}, entry_steps_{};
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
    const glm::uvec2 set = volume_->corner_set(cell.first_set + side);
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
  const glm::dvec3 start = a + begin * direction + 0.5;
  const auto floor = [](double x) { return static_cast<int>(x) - (x < static_cast<int>(x)); };
  ray.cell = {floor(start.x), floor(start.y), floor(start.z)};
  const auto vector = [](glm::dvec3 v) {
    return Float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
  };
  ray.at = vector(start - glm::dvec3(ray.cell));
  ray.direction = vector(direction);
  return ray;
}

float smoke_on_ray(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes, float enough) {
  return Walk(volume, ray, holes).run(enough);
}

}  // namespace brume::smoke
