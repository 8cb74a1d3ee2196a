#include "smoke/sight_holes.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace brume::smoke {
namespace {

constexpr float kLeastSpeed = 1e-20f;  // below, a ray runs along the axis
constexpr float kLeastTime = 1e-6f;    // as shared/hole.h bounds times and depths

/// Largest distance of a point of the hole from its axis: of a box, that of its corners.
float reach_of(const shared::Hole& hole) {
  return hole.shape == shared::kHoleCylinder ? hole.radius : 1.41422f * hole.radius;
}

/// Where q2 t^2 + q1 t + q0 = 0: appends the t within (low, high), counted from `zero`.
void add_roots(float q2, float q1, float q0, float zero, float low, float high, std::vector<float>& out) {
  const auto add = [&](float root) {
    if (const float t = zero + root; t > low && t < high) out.push_back(t);
  };
  const float discriminant = q1 * q1 - 4 * q2 * q0;
  if (discriminant < 0) return;
  // The form that does not cancel, also for q2 = 0.
  const float root = std::sqrt(discriminant);
  const float q = -0.5f * (q1 < 0 ? q1 - root : q1 + root);
  if (q2 != 0) add(q / q2);
  if (q != 0) add(q0 / q);
}

/// A part of a ray in which a hole's radius runs from r0 at t0 to r1 at t1, linearly.
struct RadiusSpan {
  float t0, r0, t1, r1;
};

/// Adds where the distance from the axis becomes `fraction` of the radius.
void add_edges(const RayHole& h, float fraction, const RadiusSpan& span, std::vector<float>& out) {
  const auto [t0, r0, t1, r1] = span;
  const float slope = fraction * (r1 - r0) / (t1 - t0);
  const float at_nearest = fraction * r0 + slope * (h.nearest - t0);
  if (h.box) {
    for (const float sign : {-1.0f, 1.0f}) {
      add_roots(0, h.x_step - sign * slope, h.x - sign * at_nearest, h.nearest, t0, t1, out);
      add_roots(0, h.y_step - sign * slope, h.y - sign * at_nearest, h.nearest, t0, t1, out);
    }
    return;
  }
  add_roots(h.x_step * h.x_step + h.y_step * h.y_step - slope * slope,
            2 * (h.x * h.x_step + h.y * h.y_step - at_nearest * slope),
            h.x * h.x + h.y * h.y - at_nearest * at_nearest, h.nearest, t0, t1, out);
}

/// Where a point of the cross-section lies across a mask: 0 at its one side, 1 at the other.
float fraction_across(float from_axis, float radius) {
  if (!(radius > 1e-12f)) return from_axis < 0 ? 0.0f : 1.0f;
  return std::clamp(0.5f + 0.5f * from_axis / radius, 0.0f, 1.0f);
}

/// A ray across one axis of a mask: at x + x_step (t - nearest) from the hole's axis.
struct MaskAxis {
  float x, x_step, nearest;
  int texels;
};

/// Adds where the ray passes the centres of the mask's texels along the axis: the distance from the hole's
/// axis is then a fixed fraction of the radius.
void add_texels(const MaskAxis& axis, const RadiusSpan& span, std::vector<float>& out) {
  const auto [x, x_step, nearest, texels] = axis;
  const auto [t0, r0, t1, r1] = span;
  const float slope = (r1 - r0) / (t1 - t0), at_nearest = r0 + slope * (nearest - t0);

  // The texels between the ends of the part, and where the ray passes each.
  const float a = fraction_across(x + x_step * (t0 - nearest), r0),
              b = fraction_across(x + x_step * (t1 - nearest), r1);
  const auto count = static_cast<float>(texels);
  const int first = static_cast<int>(std::ceil(std::min(a, b) * count - 0.5f));
  const int last = static_cast<int>(std::floor(std::max(a, b) * count - 0.5f));
  for (int i = first; i <= last; ++i) {
    const float fraction = 2 * (static_cast<float>(i) + 0.5f) / count - 1;
    add_roots(0, x_step - fraction * slope, x - fraction * at_nearest, nearest, t0, t1, out);
  }
}

/// Sorts the breaks from `first` on, which lie between t0 and t1, and drops those between texels that are all
/// black, or all white, as most of a letter is.
void drop_even(const RayHole& h, float t0, float t1, std::size_t first, std::vector<float>& breaks) {
  std::sort(breaks.begin() + static_cast<std::ptrdiff_t>(first), breaks.end());
  const std::size_t count = breaks.size();
  std::size_t end = first;
  float from = t0;
  RayHole::Takes before = RayHole::Takes::part;
  for (std::size_t i = first; i <= count; ++i) {
    const float to = i < count ? breaks[i] : t1;
    const RayHole::Takes here = from < to ? h.takes(0.5f * (from + to)) : before;
    // `from` is the break before this part.
    if (i > first && (here != before || here == RayHole::Takes::part)) breaks[end++] = from;
    before = here;
    from = to;
  }
  breaks.resize(end);
}

/// Adds every t at which the strength of the hole has a kink.
void add_breaks(const RayHole& h, std::vector<float>& out) {
  if (h.steady && !h.box) {  // its edge begins where the hole does
    out.insert(out.end(), {h.begin, h.end});
    const float core = (1 - shared::kHoleSoftFraction) * h.radius,
                speed = h.x_step * h.x_step + h.y_step * h.y_step;
    const float inside = core * core - h.x * h.x - h.y * h.y;
    if (inside <= 0 || !(speed > kLeastSpeed)) return;
    const float half = std::sqrt(inside / speed);
    for (const float t : {h.nearest - half, h.nearest + half})
      if (t > h.begin && t < h.end) out.push_back(t);
    return;
  }
  // The parts with a linear radius: they end where it has opened wide, and where it begins to close.
  std::array<float, 4> times{h.begin, h.end, h.end, h.end};
  std::size_t count = 1;
  if (h.age_step != 0) {
    for (const float age : {h.expand, h.stay_end}) {
      const float t = (age - h.age) / h.age_step;
      if (t > h.begin && t < h.end) times[count++] = t;
    }
  }
  if (count == 3 && times[1] > times[2]) std::swap(times[1], times[2]);
  times[count++] = h.end;

  // The kinks in each: its edge, and the core or the texels of its mask.
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const float t0 = times[i], t1 = times[i + 1];
    if (!(t0 < t1)) continue;
    out.push_back(t0);
    const RadiusSpan span{t0, h.radius_at(t0), t1, h.radius_at(t1)};
    const std::size_t first = out.size();
    add_edges(h, 1, span, out);
    if (h.mask.first) {
      add_texels({h.x, h.x_step, h.nearest, h.mask.width}, span, out);
      add_texels({-h.y, -h.y_step, h.nearest, h.mask.height}, span, out);
      drop_even(h, t0, t1, first, out);
    } else {
      add_edges(h, 1 - shared::kHoleSoftFraction, span, out);
    }
  }
  out.push_back(h.end);
  if (h.box && !h.mask.first) {  // where the nearest face changes
    add_roots(0, h.x_step - h.y_step, h.x - h.y, h.nearest, h.begin, h.end, out);
    add_roots(0, h.x_step + h.y_step, h.x + h.y, h.nearest, h.begin, h.end, out);
  }
}

/// Cuts the ray where a strength has a kink.
void make_pieces(HolesOnRay& on_ray) {
  std::vector<float>& breaks = on_ray.breaks;
  breaks.clear();
  for (const RayHole& hole : on_ray.holes) add_breaks(hole, breaks);
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const float begin = breaks[i], end = breaks[i + 1], middle = 0.5f * (begin + end);
    if (!(begin < end)) continue;
    bool met = false, gone = false;
    for (const RayHole& hole : on_ray.holes) {
      if (hole.begin > middle || hole.end < middle) continue;
      const RayHole::Takes takes = hole.takes(middle);
      met |= takes != RayHole::Takes::nothing;
      gone |= takes == RayHole::Takes::all;
    }
    if (met) on_ray.pieces.push_back({begin, end, gone});
  }
}

}  // namespace

float RayHole::radius_at(float t) const {
  const float now = age + age_step * t;
  const float opened = std::clamp(now / expand, 0.0f, 1.0f);
  const float closed = std::clamp((now - stay_end) / fade, 0.0f, 1.0f);
  return radius * opened * (1 - closed);
}

RayHole::Takes RayHole::takes(float t) const {
  const float from_nearest = t - nearest, px = x + x_step * from_nearest, py = y + y_step * from_nearest;
  const float wide = steady ? radius : radius_at(t), core = (1 - shared::kHoleSoftFraction) * wide;
  const bool closing = !steady && age + age_step * t > stay_end;
  if (mask.first) {
    if (std::max(std::abs(px), std::abs(py)) > wide) return Takes::nothing;
    const auto [least, most] =
        mask.range_around(glm::vec2(fraction_across(px, wide), fraction_across(-py, wide)));
    if (most == 0) return Takes::nothing;
    return least == 255 && !closing ? Takes::all : Takes::part;
  }
  const bool within = box ? std::max(std::abs(px), std::abs(py)) <= core : px * px + py * py <= core * core;
  return within && !closing ? Takes::all : Takes::part;
}

Float4 RayHole::strength(Float4 t) const {
  const Float4 from_nearest = t - splat(nearest);
  const Float4 px = splat(x) + splat(x_step) * from_nearest, py = splat(y) + splat(y_step) * from_nearest;
  const Float4 from_axis = box ? max4(abs4(px), abs4(py)) : sqrt4(px * px + py * py);
  Float4 wide = splat(radius), open = splat(1);
  if (!steady) {
    const Float4 ages = splat(age) + splat(age_step) * t;
    open = splat(1) - clamp4((ages - splat(stay_end)) / splat(fade), 0, 1);
    wide = max4(wide * clamp4(ages / splat(expand), 0, 1) * open, splat(1e-12f));
  }
  if (mask.first) return mask_strength(px, py, wide, open);
  const Float4 edge = clamp4((wide - from_axis) / (wide * splat(shared::kHoleSoftFraction)), 0, 1);
  return edge * edge * (splat(3) - splat(2) * edge) * open;
}

Float4 RayHole::mask_strength(Float4 px, Float4 py, Float4 wide, Float4 open) const {
  Float4 result{};
  for (int i = 0; i < 4; ++i) {
    if (std::max(std::abs(px[i]), std::abs(py[i])) >= wide[i]) continue;
    const glm::vec2 across(fraction_across(px[i], wide[i]), fraction_across(-py[i], wide[i]));
    result[i] = mask.at(across) * (1.0f / 255) * open[i];
  }
  return result;
}

Float4 HolesOnRay::remaining(const HolePiece& piece, Float4 t) const {
  Float4 remaining = splat(1.0f);
  for (const RayHole& hole : holes) {
    if (hole.begin < piece.end && hole.end > piece.begin) remaining *= splat(1.0f) - hole.strength(t);
  }
  return remaining;
}

HoleSet::HoleSet(std::span<const shared::Hole> holes, float time, const MaskAtlas* masks) {
  for (const shared::Hole& hole : holes) {
    const float age = time - hole.time_start;
    const float per_metre = hole.time_to_reach_far / std::max(hole.distance_to_far, kLeastTime);
    const float life = std::max(hole.time_to_expand, kLeastTime) + hole.time_to_stay_open +
                       std::max(hole.time_to_fade, kLeastTime);
    // Open where the front has been, and not yet closed again: 0 < age - per_metre z < life.
    const float over = age - life, to_far = per_metre * hole.distance_to_far;
    if (!(age > 0) || over >= to_far) continue;
    holes_.push_back({hole, age, per_metre, over > 0 ? over / per_metre : 0,
                      age < to_far ? age / per_metre : hole.distance_to_far,
                      hole.shape == shared::kHoleMask ? view_of(*masks, hole) : MaskView{}});
  }
  if (holes_.empty()) return;

  // Their axes as lines, four to a group.
  reference_ = holes_[0].hole.origin_world;
  groups_.resize((holes_.size() + 3) / 4, Group{});
  for (std::size_t i = 0; i < holes_.size(); ++i) {
    Group& group = groups_[i / 4];
    const shared::Hole& hole = holes_[i].hole;
    const glm::vec3 from = hole.origin_world - reference_, moment = glm::cross(from, hole.forward);
    farthest_ = std::max(farthest_, std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)}));
    group.forward_x[i % 4] = hole.forward.x;
    group.forward_y[i % 4] = hole.forward.y;
    group.forward_z[i % 4] = hole.forward.z;
    group.moment_x[i % 4] = moment.x;
    group.moment_y[i % 4] = moment.y;
    group.moment_z[i % 4] = moment.z;
    group.reach_squared[i % 4] = reach_of(hole) * reach_of(hole);
  }
}

void HoleSet::find(glm::vec3 origin_world, glm::vec3 step_world, float t_end, HolesOnRay& out) const {
  out.holes.clear();
  out.pieces.clear();
  // How far apart the lines of ray and axis are, by their Pluecker coordinates, |forward . moment of the ray
  // + step . moment of the axis| is the distance times |step x forward|. Rounding makes it wider, never
  // narrower.
  const glm::vec3 from = origin_world - reference_, moment = glm::cross(from, step_world);
  const float speed_squared = glm::dot(step_world, step_world);
  const float far = std::max({farthest_, std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  const Float4 blur = splat(4e-6f * far * std::sqrt(speed_squared));
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const Float4 apart = group.forward_x * splat(moment.x) + group.forward_y * splat(moment.y) +
                         group.forward_z * splat(moment.z) + group.moment_x * splat(step_world.x) +
                         group.moment_y * splat(step_world.y) + group.moment_z * splat(step_world.z);
    const Float4 along = group.forward_x * splat(step_world.x) + group.forward_y * splat(step_world.y) +
                         group.forward_z * splat(step_world.z);
    const Float4 least = max4(abs4(apart) - blur, splat(0));
    const Float4 slant = splat(speed_squared) * splat(1.000001f) - along * along;
    std::uint32_t near = bits_of(least * least <= group.reach_squared * slant);
    for (; near != 0; near &= near - 1) {
      const std::size_t i = 4 * g + static_cast<std::size_t>(std::countr_zero(near));
      if (i < holes_.size()) add(holes_[i], origin_world, step_world, t_end, out);
    }
  }
  if (!out.holes.empty()) make_pieces(out);
}

void HoleSet::add(const ActiveHole& open, glm::vec3 origin_world, glm::vec3 step_world, float t_end,
                  HolesOnRay& out) const {
  const shared::Hole& hole = open.hole;
  const glm::vec3 from = origin_world - hole.origin_world;
  const float z = glm::dot(from, hole.forward), z_step = glm::dot(step_world, hole.forward);
  const float x = glm::dot(from, hole.right), x_step = glm::dot(step_world, hole.right);
  const float y = glm::dot(from, hole.up), y_step = glm::dot(step_world, hole.up);
  float begin = 0, end = t_end;

  // Between the depths at which it is open.
  if (z_step != 0) {
    const float ta = (open.near - z) / z_step, tb = (open.far - z) / z_step;
    begin = std::max(begin, std::min(ta, tb));
    end = std::min(end, std::max(ta, tb));
  } else if (z < open.near || z > open.far) {
    return;
  }

  // Within its widest cross-section.
  const float speed = x_step * x_step + y_step * y_step;
  const float nearest = speed > kLeastSpeed ? -(x * x_step + y * y_step) / speed : 0;
  const float nx = x + x_step * nearest, ny = y + y_step * nearest;
  const float reach = reach_of(hole), inside = reach * reach - nx * nx - ny * ny;
  if (inside <= 0) return;
  if (speed > kLeastSpeed) {
    const float half = std::sqrt(inside / speed);
    begin = std::max(begin, nearest - half);
    end = std::min(end, nearest + half);
  }
  if (!(begin < end)) return;

  // What changes along the ray there.
  RayHole met{};
  met.begin = begin;
  met.end = end;
  met.nearest = nearest;
  met.x = nx;
  met.x_step = x_step;
  met.y = ny;
  met.y_step = y_step;
  met.age = open.age - open.age_per_metre * z;
  met.age_step = -open.age_per_metre * z_step;
  met.radius = hole.radius;
  met.expand = std::max(hole.time_to_expand, kLeastTime);
  met.stay_end = hole.time_to_expand + hole.time_to_stay_open;
  met.fade = std::max(hole.time_to_fade, kLeastTime);
  met.mask = open.mask;
  met.box = hole.shape != shared::kHoleCylinder;
  const float age0 = met.age + met.age_step * begin, age1 = met.age + met.age_step * end;
  met.steady = std::min(age0, age1) >= met.expand && std::max(age0, age1) <= met.stay_end;
  out.holes.push_back(met);
}

}  // namespace brume::smoke
