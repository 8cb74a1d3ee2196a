#include "smoke/sight_smoke.hpp"

#include <algorithm>
#include <array>

#include "smoke/sight_walk.hpp"

namespace brume::smoke {
namespace {

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
    const std::uint32_t* entries = volume_.cells(bricks_.slot).data();
    Int4 cell = bricks_.cell;
    const auto first_of = [&](int row) { return cell[0] + row * (cell[1] + row * cell[2]); };
    int texel = first_of(kRow), entry = first_of(kEntryRow);
    float t = bricks_.t;
    Float4 exits = bricks_.exits();
    const Int4 per_cell = reinterpret_cast<Int4>(bricks_.exits_per_cell());
    while (t < length_ && bits_of((cell & ~7) != 0) == 0) {
      const Float4 first = least3(exits);
      const float out = std::min(first[0], length_);
      const Int4 crossed = exits <= first, here = cell;
      const Texel* texel_here = texels + texel;
      const std::uint32_t entry_here = entries[entry];
      const std::uint32_t axes = bits_of(crossed);
      cell += bricks_.stride() & crossed;
      texel += texel_steps_[axes];
      entry += entry_steps_[axes];
      exits += reinterpret_cast<Float4>(per_cell & crossed);
      if (!(out > t)) continue;
      if (entry_here != 0) {
        sum_.add_boundary(volume_.boundary_cells()[entry_here - 1], bricks_.at - to_float(here), t, out);
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
