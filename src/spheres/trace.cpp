#include "spheres/trace.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "shared/dda.h"
#include "spheres/color.hpp"

namespace brume::spheres {
namespace {

// The t of a plane has three roundings: difference, inverse and product, 3.01 * 2^-24 of it. Two planes whose
// order rounding may change are at most 6.1 * 2^-24 of t apart. 8 * 2^-24, for the rounding of the
// comparison.
constexpr float kAbove = 1 + 0x1p-21f, kBelow = 1 - 0x1p-21f;

bool is_finite_ray(const glm::vec3& origin, const glm::vec3& direction) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(origin[axis]) || !std::isfinite(direction[axis])) return false;
    largest = std::max(largest, std::abs(direction[axis]));
  }
  return largest > 0;
}

// Spheres tested last: most are in several voxels in a row.
class Mailbox {
 public:
  // Whether a sphere was tested lately; remembers it.
  bool knows(std::uint32_t sphere) {
    for (const std::uint32_t other : last_)
      if (other == sphere) return true;
    last_[next_] = sphere;
    next_ = (next_ + 1) % last_.size();
    return false;
  }

 private:
  std::array<std::uint32_t, 8> last_ = [] {
    std::array<std::uint32_t, 8> none{};
    none.fill(UINT32_MAX);
    return none;
  }();
  std::size_t next_ = 0;
};

// Bit `axis`: whether t of a plane is at most `limit`, or at least.
unsigned axes_below(const glm::vec3& t, float limit) {
  return unsigned{t.x <= limit} | unsigned{t.y <= limit} << 1 | unsigned{t.z <= limit} << 2;
}
unsigned axes_above(const glm::vec3& t, float limit) {
  return unsigned{t.x >= limit} | unsigned{t.y >= limit} << 1 | unsigned{t.z >= limit} << 2;
}

// Calls test(sphere) for the spheres of the voxels along a ray, some of them more than once, and
// covered(t) -> bool in between: all spheres that the ray enters before t were tested; whether to go on.
template <typename Test, typename Covered>
class CandidateWalk {
 public:
  CandidateWalk(const TankView& view, const Test& test, const Covered& covered)
      : view_(view), test_(test), covered_(covered) {}

  void walk(const glm::vec3& origin, const glm::vec3& direction, float t_max) {
    if (!is_finite_ray(origin, direction) || !(t_max > 0)) return;
    // Empty bricks around the tank: where a ray enters or leaves their box, rounding has no effect. A little
    // beyond t_max, so that no voxel before it is missed.
    shared::Dda outer = shared::dda_begin(origin, direction, glm::ivec3(-1), view_.bricks.bricks + 1,
                                          shared::kSphereBrick, 0, t_max * kAbove);
    while (outer.t < outer.t_end) {
      const glm::vec3 leave = shared::dda_leave(outer);
      const float first = shared::dda_min(leave);
      // At an edge the ray may be in a third brick, of which voxels next to this one tell.
      const bool at_edge = std::popcount(axes_below(leave, first * kAbove)) > 1;
      if (at_edge || !is_empty(outer.cell)) {
        const glm::ivec3 low = shared::kSphereBrick * outer.cell;
        const float end = std::min(first, outer.t_end);
        if (!walk_voxels(
                shared::dda_begin(origin, direction, low, low + shared::kSphereBrick, 1, outer.t, end)))
          return;
      } else if (!covered_(first * kBelow)) {
        return;
      }
      outer = shared::dda_step(outer);
    }
  }

 private:
  bool is_empty(const glm::ivec3& brick) const {
    if (glm::any(glm::lessThan(brick, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(brick, view_.bricks.bricks)))
      return true;
    return view_.bricks.ranges[view_.bricks.index(brick)].count == 0;
  }

  bool walk_voxels(shared::Dda d) {
    if (!(d.t < d.t_end)) return true;
    // Voxels that the ray may have crossed just before the first, where the brick before was skipped.
    const glm::vec3 enter = shared::dda_plane_t(d, d.cell + glm::ivec3(1) - d.leaving);
    test_subsets(d.cell, -d.stride, axes_above(enter, d.t * kBelow));
    for (; d.t < d.t_end; d = shared::dda_step(d)) {
      test_voxel(d.cell);
      const glm::vec3 leave = shared::dda_leave(d);
      const float first = shared::dda_min(leave);
      const unsigned axes = axes_below(leave, first * kAbove);
      if (std::popcount(axes) > 1) test_subsets(d.cell, d.stride, axes);
      if (!covered_(first * kBelow)) return false;
    }
    return true;
  }

  // The voxels that differ from a cell by a step along some of the axes.
  void test_subsets(const glm::ivec3& cell, const glm::ivec3& stride, unsigned axes) {
    for (unsigned subset = 1; subset < 8; ++subset)
      if ((subset & ~axes) == 0)
        test_voxel(cell + stride * glm::ivec3(subset & 1, subset >> 1 & 1, subset >> 2));
  }

  void test_voxel(const glm::ivec3& voxel) {
    if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(voxel, glm::ivec3(view_.tank.size))))
      return;
    const glm::uvec4 ids = view_.ids.at(voxel);
    if (shared::ids_overflow(ids)) {
      const glm::ivec3 brick = voxel / shared::kSphereBrick;
      const shared::SphereBrick range = view_.bricks.ranges[view_.bricks.index(brick)];
      for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
        test_sphere(view_.bricks.spheres[i]);
      return;
    }
    for (int i = 0; i < 4 && ids[i] != 0; ++i) test_sphere(ids[i] - 1);
  }

  void test_sphere(std::uint32_t sphere) {
    if (!mailbox_.knows(sphere)) test_(sphere);
  }

  const TankView& view_;
  const Test& test_;
  const Covered& covered_;
  Mailbox mailbox_;
};

// Before another: by entering, then by id.
bool enters_before(const Chord& a, const Chord& b) {
  return a.enter < b.enter || (a.enter == b.enter && a.id < b.id);
}

}  // namespace

std::optional<glm::dvec2> chord_of(const Sphere& sphere, const glm::dvec3& origin,
                                   const glm::dvec3& direction) {
  const glm::dvec3 f = origin - glm::dvec3(sphere.center);
  const double radius = sphere.radius;
  const double a = glm::dot(direction, direction);
  const double b = -glm::dot(f, direction);
  const glm::dvec3 nearest = f + direction * (b / a);
  const double discriminant = radius * radius - glm::dot(nearest, nearest);
  if (!(discriminant > 0)) return std::nullopt;
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  const double near_end = (glm::dot(f, f) - radius * radius) / q, far_end = q / a;
  const glm::dvec2 chord(std::min(near_end, far_end), std::max(near_end, far_end));
  return chord.x < chord.y ? std::optional(chord) : std::nullopt;
}

std::optional<SphereHit> first_hit(const TankView& view, const glm::vec3& origin_voxel,
                                   const glm::vec3& direction, float t_max) {
  const glm::dvec3 origin(origin_voxel), along(direction);
  Chord best{std::numeric_limits<double>::infinity(), 0, UINT32_MAX};
  const auto test = [&](std::uint32_t sphere) {
    const auto chord = chord_of(view.tank.spheres[sphere], origin, along);
    if (!chord || chord->x < 0 || chord->x > double{t_max}) return;
    const Chord found{chord->x, chord->y, sphere + 1};
    if (enters_before(found, best)) best = found;
  };
  const auto covered = [&](float t) { return best.enter > double{t}; };
  CandidateWalk(view, test, covered).walk(origin_voxel, direction, t_max);
  if (best.id == UINT32_MAX) return std::nullopt;
  const glm::dvec3 outwards = origin + best.enter * along - glm::dvec3(view.tank.spheres[best.id - 1].center);
  return SphereHit{best.enter, best.id, glm::normalize(outwards)};
}

void visit_chords(const TankView& view, const glm::vec3& origin_voxel, const glm::vec3& direction,
                  float t_max, const std::function<bool(const Chord&)>& visit) {
  const glm::dvec3 origin(origin_voxel), along(direction);
  const double end = t_max;
  std::vector<Chord> pending;  // not visited yet, unclamped
  Chord last{-std::numeric_limits<double>::infinity(), 0, 0};
  bool stopped = false;
  const auto test = [&](std::uint32_t sphere) {
    const auto chord = chord_of(view.tank.spheres[sphere], origin, along);
    if (!chord || chord->y <= 0 || chord->x >= end) return;
    const Chord found{chord->x, chord->y, sphere + 1};
    // Found again: those visited do not go after the last.
    if (!enters_before(last, found)) return;
    const auto same = [&](const Chord& other) { return other.id == found.id; };
    if (std::none_of(pending.begin(), pending.end(), same)) pending.push_back(found);
  };
  const auto visit_until = [&](double t) {
    if (pending.empty()) return true;
    std::sort(pending.begin(), pending.end(), enters_before);
    auto next = pending.begin();
    for (; next != pending.end() && next->enter <= t && !stopped; ++next) {
      last = *next;
      stopped = !visit({std::max(next->enter, 0.0), std::min(next->leave, end), next->id});
    }
    pending.erase(pending.begin(), next);
    return !stopped;
  };
  const auto covered = [&](float t) { return visit_until(double{t}); };
  CandidateWalk(view, test, covered).walk(origin_voxel, direction, t_max);
  if (!stopped) visit_until(end);
}

double transmittance(const TankView& view, const glm::vec3& origin_voxel, const glm::vec3& direction,
                     float t_max) {
  double depth = 0;
  const double length = glm::length(glm::dvec3(direction));
  visit_chords(view, origin_voxel, direction, t_max, [&](const Chord& chord) {
    const Color color = view.tank.colors[chord.id - 1];
    if (color >> 24 != 0) depth += extinction_of(color) * length * (chord.leave - chord.enter);
    return std::isfinite(depth);
  });
  return std::exp(-depth);
}

}  // namespace brume::spheres
