#include "smoke/sight_holes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace brume::smoke {
namespace {

constexpr float kLeastSpeed = 1e-20f;  // below, a ray runs along the axis
constexpr float kLeastTime = 1e-6f;    // as shared/hole.h bounds times and depths

/// A part of a ray in which a hole's radius runs from r0 at t0 to r1 at t1, linearly.
struct RadiusSpan {
  float t0, r0, t1, r1;
};

/// Number by number: made elsewhere and copied as a whole, the numbers would wait in the processor for one
/// another.
void append_segment(std::vector<HoleSegment>& out, float begin, float end, std::uint32_t hole, bool all,
                    glm::ivec2 cell = glm::ivec2(0)) {
  HoleSegment& segment = out.emplace_back();
  segment.begin = begin;
  segment.end = end;
  segment.hole = hole;
  segment.all = all;
  segment.cell.x = cell.x;
  segment.cell.y = cell.y;
}

constexpr float kNever = 1e30f;

/// A ray along one axis of a mask. Its coordinate counts cells: cell i is [i, i + 1).
class MaskAxis {
 public:
  /// It is at x + x_step (t - nearest) from the hole's axis.
  MaskAxis(float x, float x_step, float nearest, int texels, const RadiusSpan& span)
      : x_(x), x_step_(x_step), nearest_(nearest), texels_(texels), count_(static_cast<float>(texels)) {
    slope_ = (span.r1 - span.r0) / (span.t1 - span.t0);
    at_nearest_ = span.r0 + slope_ * (nearest - span.t0);
    if (slope_ == 0 && x_step != 0) {
      per_plane_ = 2 * span.r0 / (count_ * x_step);
      planes_per_t_ = count_ * x_step / (2 * span.r0);
      plane0_ = nearest - (x + span.r0) / x_step - 0.5f * per_plane_;
    }
  }

  float from_axis(float t) const { return x_ + x_step_ * (t - nearest_); }
  int cell_at(float t) const {
    if (per_plane_ != 0) return static_cast<int>(std::clamp((t - plane0_) * planes_per_t_, 0.0f, count_));
    const float radius = at_nearest_ + slope_ * (t - nearest_);
    if (!(radius > 1e-12f)) return from_axis(t) < 0 ? 0 : texels_;
    const float across = (0.5f + 0.5f * from_axis(t) / radius) * count_ + 0.5f;
    return static_cast<int>(std::clamp(across, 0.0f, count_));
  }
  /// Where the ray crosses the plane between two cells: its distance from the hole's axis is then a fixed
  /// fraction of the radius.
  float crossing(int plane) const {
    if (slope_ == 0) return x_step_ != 0 ? plane0_ + per_plane_ * static_cast<float>(plane) : kNever;
    const float fraction = (2 * static_cast<float>(plane) - 1) / count_ - 1;
    const float speed = x_step_ - fraction * slope_;
    return speed != 0 ? nearest_ + (fraction * at_nearest_ - x_) / speed : kNever;
  }

 private:
  float x_, x_step_, nearest_;
  int texels_;
  float count_, slope_, at_nearest_;
  float plane0_ = 0, per_plane_ = 0,
        planes_per_t_ = 0;  // where the radius is constant: t of plane 0, and from one to the next
};

/// The cells of one axis in the order of the ray: it never turns around, as the radius is linear.
class AxisWalk {
 public:
  AxisWalk(const MaskAxis& axis, float from, float to)
      : axis_(axis), cell_(axis.cell_at(from)), last_(axis.cell_at(to)), up_(last_ > cell_) {}
  int cell() const { return cell_; }

  /// Where the ray leaves the cells within `radius` of this one.
  float find_exit(int radius) {
    plane_ = up_ ? cell_ + radius + 1 : cell_ - radius;
    // Beyond the last cell is no crossing.
    return exit_ = (up_ ? plane_ > last_ : plane_ <= last_) ? kNever : axis_.crossing(plane_);
  }
  /// Moves on to t, at most that exit.
  void move_to(float t, int radius) {
    if (exit_ <= t)
      cell_ = up_ ? plane_ : plane_ - 1;
    else if (radius > 0)
      cell_ = up_ ? std::clamp(axis_.cell_at(t), cell_, std::min(plane_ - 1, last_))
                  : std::clamp(axis_.cell_at(t), std::max(plane_, last_), cell_);
  }

 private:
  const MaskAxis& axis_;
  int cell_, last_, plane_ = 0;
  bool up_;
  float exit_ = kNever;
};

/// The part of [from, to] where the linear function through the values there is above 0.
void clip(float at_from, float at_to, float from, float to, float& begin, float& end) {
  if (at_from >= 0 && at_to >= 0) return;
  if (at_from < 0 && at_to < 0) {
    end = begin;
    return;
  }
  const float zero = from + (to - from) * (at_from / (at_from - at_to));
  (at_from < 0 ? begin : end) = at_from < 0 ? std::max(begin, zero) : std::min(end, zero);
}

/// Appends the segments of a hole with a mask within the span, in order of t: none where the mask is black,
/// one for all white cells in a row, one for each other cell.
void add_mask_segments(const RayHole& h, std::uint32_t number, const RadiusSpan& span,
                       std::vector<HoleSegment>& out) {
  // Within the square.
  const auto [t0, r0, t1, r1] = span;
  const MaskAxis across(h.x, h.x_step, h.nearest, h.mask.width, span),
      down(-h.y, -h.y_step, h.nearest, h.mask.height, span);
  float t = t0, end = t1;
  for (const MaskAxis* axis : {&across, &down}) {
    const float p0 = axis->from_axis(t0), p1 = axis->from_axis(t1);
    clip(r0 - p0, r1 - p1, t0, t1, t, end);
    clip(r0 + p0, r1 + p1, t0, t1, t, end);
  }
  if (!(t < end)) return;

  // Cell by cell; those around it that are as even in one step.
  const bool closing = h.closing_at(0.5f * (t0 + t1));
  AxisWalk x(across, t, end), y(down, t, end);
  const MaskView mask = h.mask;
  const std::size_t first = out.size();
  bool white_before = false;
  while (t < end) {
    const glm::ivec2 cell(x.cell(), y.cell());
    const MaskCell here = mask.cell(cell);
    const float to = std::max(t, std::min({x.find_exit(here.radius), y.find_exit(here.radius), end}));
    if (t < to) {
      const bool white = here.kind == MaskCell::white;
      if (white && white_before && out.size() > first)
        out.back().end = to;
      else if (here.kind != MaskCell::black)
        append_segment(out, t, to, number, white && !closing, cell);
      white_before = white;
    }
    x.move_to(to, here.radius);
    y.move_to(to, here.radius);
    t = to;
  }
}

/// What the cell of a mask removes, [0, 1], at four points of its cross-section; `wide` is the hole's radius.
Float4 mask_strength(const MaskView& mask, glm::ivec2 cell, Float4 x, Float4 y, Float4 wide) {
  const auto within = [&](Float4 from_axis, int texels, int of_cell) {
    const auto count = static_cast<float>(texels);
    return clamp4((splat(0.5f) + splat(0.5f) * from_axis / wide) * splat(count) +
                      splat(0.5f - static_cast<float>(of_cell)),
                  0, 1);
  };
  const Float4 fx = within(x, mask.width, cell.x), fy = within(-y, mask.height, cell.y);
  const auto corners = mask.corners(cell);
  const auto texel = [&](std::size_t i) { return static_cast<float>(corners[i]) * (1.0f / 255); };
  const Float4 top = splat(texel(0)) + splat(texel(1) - texel(0)) * fx,
               bottom = splat(texel(2)) + splat(texel(3) - texel(2)) * fx;
  return top + (bottom - top) * fy;
}

/// Largest distance of a point of the hole from its axis; a box is widest at its corners.
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

/// The parts of a hole with a linear radius: they end where it has opened wide, and where it begins to close.
struct RadiusSpans {
  std::array<float, 4> times;
  std::size_t count = 1;  // number of times

  explicit RadiusSpans(const RayHole& h) : times{h.begin, h.end, h.end, h.end} {
    if (h.age_step != 0 && !h.steady) {
      for (const float age : {h.expand, h.stay_end}) {
        const float t = (age - h.age) / h.age_step;
        if (t > h.begin && t < h.end) times[count++] = t;
      }
    }
    if (count == 3 && times[1] > times[2]) std::swap(times[1], times[2]);
    times[count++] = h.end;
  }
  /// Calls visit(span) for each.
  template <typename Visit>
  void for_each(const RayHole& h, Visit visit) const {
    for (std::size_t i = 0; i + 1 < count; ++i)
      if (times[i] < times[i + 1])
        visit(RadiusSpan{times[i], h.radius_at(times[i]), times[i + 1], h.radius_at(times[i + 1])});
  }
};

/// Whether it removes all of the smoke around t, within its core.
bool takes_all(const RayHole& h, float t) {
  const float from_nearest = t - h.nearest, x = h.x + h.x_step * from_nearest,
              y = h.y + h.y_step * from_nearest;
  const float core = (1 - shared::kHoleSoftFraction) * h.radius_at(t);
  const bool within = h.box ? std::max(std::abs(x), std::abs(y)) <= core : x * x + y * y <= core * core;
  return within && !h.closing_at(t);
}

/// Adds the segments of a wide open cylinder: its edge begins where the hole does.
void add_steady_segments(const RayHole& h, std::uint32_t number, std::vector<HoleSegment>& out) {
  // The part in its core.
  const float core = (1 - shared::kHoleSoftFraction) * h.radius,
              speed = h.x_step * h.x_step + h.y_step * h.y_step;
  const float inside = core * core - h.x * h.x - h.y * h.y;
  float begin = h.begin, end = inside > 0 ? h.end : h.begin;
  if (inside > 0 && speed > kLeastSpeed) {
    const float half = std::sqrt(inside / speed);
    begin = std::max(begin, h.nearest - half);
    end = std::min(end, h.nearest + half);
  }
  if (!(begin < end)) begin = end = h.end;

  if (h.begin < begin) append_segment(out, h.begin, begin, number, false);
  if (begin < end) append_segment(out, begin, end, number, true);
  if (end < h.end) append_segment(out, end, h.end, number, false);
}

/// Adds the segments of any other hole without a mask: cut at every t at which its strength has a kink.
void add_soft_segments(const RayHole& h, std::uint32_t number, std::vector<float>& breaks,
                       std::vector<HoleSegment>& out) {
  breaks.assign({h.begin, h.end});
  RadiusSpans(h).for_each(h, [&](const RadiusSpan& span) {
    breaks.push_back(span.t0);
    add_edges(h, 1, span, breaks);
    add_edges(h, 1 - shared::kHoleSoftFraction, span, breaks);
  });
  if (h.box) {  // where the nearest face changes
    add_roots(0, h.x_step - h.y_step, h.x - h.y, h.nearest, h.begin, h.end, breaks);
    add_roots(0, h.x_step + h.y_step, h.x + h.y, h.nearest, h.begin, h.end, breaks);
  }
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    if (breaks[i] < breaks[i + 1])
      out.push_back({breaks[i], breaks[i + 1], number, takes_all(h, 0.5f * (breaks[i] + breaks[i + 1]))});
}

constexpr float kNoChange = std::numeric_limits<float>::infinity();  // a cursor at its end

/// The segments of every hole, and a cursor for each hole that has any.
void make_segments(HolesOnRay& on_ray) {
  for (const RayHole& hole : on_ray.holes) {
    const auto number = static_cast<std::uint32_t>(&hole - on_ray.holes.data());
    const auto first = static_cast<std::uint32_t>(on_ray.segments.size());
    if (hole.mask.atlas)
      RadiusSpans(hole).for_each(
          hole, [&](const RadiusSpan& span) { add_mask_segments(hole, number, span, on_ray.segments); });
    else if (hole.steady && !hole.box)
      add_steady_segments(hole, number, on_ray.segments);
    else
      add_soft_segments(hole, number, on_ray.breaks, on_ray.segments);
    if (on_ray.segments.size() > first)
      on_ray.cursors.push_back({on_ray.segments[first].begin, first,
                                static_cast<std::uint32_t>(on_ray.segments.size()), false, false});
  }
}

/// Cuts a ray where the strength of a hole has a kink: from each begin or end of a segment to the next one.
class PieceMaker {
 public:
  explicit PieceMaker(HolesOnRay& on_ray) : out_(on_ray), segments_(on_ray.segments.data()) {}

  void run() {
    if (out_.cursors.size() == 1) {
      pieces_of_one(out_.cursors[0]);
      return;
    }
    auto& waiting = out_.waiting;
    waiting.resize(out_.cursors.size());
    for (std::uint32_t i = 0; i < waiting.size(); ++i) waiting[i] = i;
    std::sort(waiting.begin(), waiting.end(),
              [&](auto a, auto b) { return out_.cursors[a].change < out_.cursors[b].change; });
    while (next_ < waiting.size() || !out_.active.empty()) {
      if (out_.active.empty()) t_ = next_begin();
      for (; next_begin() <= t_; ++next_) add_active(waiting[next_]);
      const HolesOnRay::Cursor& first = out_.cursors[out_.active[0]];
      if (out_.active.size() == 1 && segments_[first.last - 1].end <= next_begin())
        pieces_of_one(first);
      else
        next_piece();
    }
  }

 private:
  float next_begin() const {
    return next_ < out_.waiting.size() ? out_.cursors[out_.waiting[next_]].change : kNoChange;
  }
  /// In the order of the holes.
  void add_active(std::uint32_t cursor) {
    out_.active.insert(std::upper_bound(out_.active.begin(), out_.active.end(), cursor), cursor);
  }
  /// All others begin only after this hole: each of its segments is a piece.
  void pieces_of_one(const HolesOnRay::Cursor& cursor) {
    for (std::uint32_t i = cursor.segment; i < cursor.last; ++i) {
      const HoleSegment& segment = segments_[i];
      if (segment.end <= t_) continue;
      add_piece(std::max(segment.begin, t_), segment.end, segment.all, [&] { out_.members.push_back(i); });
    }
    out_.active.clear();
  }
  void next_piece() {
    float end = next_begin();
    bool gone = false, any = false;
    std::erase_if(out_.active, [&](std::uint32_t i) {
      HolesOnRay::Cursor& cursor = out_.cursors[i];
      while (cursor.change <= t_) cursor.advance(segments_);
      end = std::min(end, cursor.change);
      any |= cursor.inside;
      gone |= cursor.all;
      return cursor.change == kNoChange;
    });
    if (any) {
      add_piece(t_, end, gone, [&] {
        for (const std::uint32_t i : out_.active)
          if (out_.cursors[i].inside) out_.members.push_back(out_.cursors[i].segment);
      });
    }
    t_ = end;
  }
  template <typename AddMembers>
  void add_piece(float begin, float end, bool gone, const AddMembers& add_members) {
    const auto first = static_cast<std::uint32_t>(out_.members.size());
    if (!gone) add_members();
    const auto count = static_cast<std::uint32_t>(out_.members.size()) - first;
    HolePiece& piece = out_.pieces.emplace_back();
    piece.begin = begin;
    piece.end = end;
    piece.gone = gone;
    piece.first = first;
    piece.count = count;
  }

  HolesOnRay& out_;
  const HoleSegment* segments_;
  std::size_t next_ = 0;  // the first cursor that still waits
  float t_ = -kNoChange;
};

/// Strength of a hole at four t of one of its segments.
Float4 strength(const RayHole& h, const HoleSegment& segment, Float4 t) {
  const Float4 from_nearest = t - splat(h.nearest);
  const Float4 x = splat(h.x) + splat(h.x_step) * from_nearest,
               y = splat(h.y) + splat(h.y_step) * from_nearest;
  Float4 wide = splat(h.radius), open = splat(1);
  if (!h.steady) {
    const Float4 ages = splat(h.age) + splat(h.age_step) * t;
    open = splat(1) - clamp4((ages - splat(h.stay_end)) / splat(h.fade), 0, 1);
    wide = max4(wide * clamp4(ages / splat(h.expand), 0, 1) * open, splat(1e-12f));
  }
  if (h.mask.atlas) return mask_strength(h.mask, segment.cell, x, y, wide) * open;
  const Float4 from_axis = h.box ? max4(abs4(x), abs4(y)) : sqrt4(x * x + y * y);
  const Float4 edge = clamp4((wide - from_axis) / (wide * splat(shared::kHoleSoftFraction)), 0, 1);
  return edge * edge * (splat(3) - splat(2) * edge) * open;
}

}  // namespace

float RayHole::radius_at(float t) const {
  const float now = age + age_step * t;
  const float opened = std::clamp(now / expand, 0.0f, 1.0f);
  const float closed = std::clamp((now - stay_end) / fade, 0.0f, 1.0f);
  return radius * opened * (1 - closed);
}

/// Into the segment, or on to the next one.
void HolesOnRay::Cursor::advance(const HoleSegment* of_rays) {
  if (!inside) {
    inside = true;
    all = of_rays[segment].all;
    change = of_rays[segment].end;
    return;
  }
  inside = all = false;
  change = ++segment < last ? of_rays[segment].begin : kNoChange;
}

Float4 HolesOnRay::remaining(const HolePiece& piece, Float4 t) const {
  Float4 remaining = splat(1.0f);
  for (const std::uint32_t number : std::span(members).subspan(piece.first, piece.count)) {
    const HoleSegment& segment = segments[number];
    remaining *= splat(1.0f) - strength(holes[segment.hole], segment, t);
  }
  return remaining;
}

void HolesOnRay::reserve() {
  constexpr std::size_t kUsual = 16;
  holes.reserve(kUsual);
  segments.reserve(kUsual);
  pieces.reserve(kUsual);
  members.reserve(kUsual);
  cursors.reserve(kUsual);
  waiting.reserve(kUsual);
  active.reserve(kUsual);
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
  out.segments.clear();
  out.pieces.clear();
  out.members.clear();
  out.cursors.clear();
  out.active.clear();
  // How far apart the lines of ray and axis are, by their Pluecker coordinates, |forward . moment of the ray
  // + step . moment of the axis| is the distance times |step x forward|. Rounding makes it wider, never
  // narrower.
  const glm::vec3 from = origin_world - reference_, moment = glm::cross(from, step_world);
  const float speed_squared = glm::dot(step_world, step_world);
  const float far = std::max({farthest_, std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  const Float4 blur = splat(4e-6f * far * std::sqrt(speed_squared));
  for (std::size_t first = 0; first < groups_.size(); first += 16) {
    // Candidates first, then one loop over them: whether a group has any cannot be predicted.
    std::uint64_t near = 0;
    const std::size_t last = std::min(first + 16, groups_.size());
    for (std::size_t g = first; g < last; ++g) {
      const Group& group = groups_[g];
      const Float4 apart = group.forward_x * splat(moment.x) + group.forward_y * splat(moment.y) +
                           group.forward_z * splat(moment.z) + group.moment_x * splat(step_world.x) +
                           group.moment_y * splat(step_world.y) + group.moment_z * splat(step_world.z);
      const Float4 along = group.forward_x * splat(step_world.x) + group.forward_y * splat(step_world.y) +
                           group.forward_z * splat(step_world.z);
      const Float4 least = max4(abs4(apart) - blur, splat(0));
      const Float4 slant = splat(speed_squared) * splat(1.000001f) - along * along;
      near |= std::uint64_t{bits_of(least * least <= group.reach_squared * slant)} << 4 * (g - first);
    }
    for (; near != 0; near &= near - 1) {
      const std::size_t i = 4 * first + static_cast<std::size_t>(std::countr_zero(near));
      if (i < holes_.size()) add(holes_[i], origin_world, step_world, t_end, out);
    }
  }
  if (out.holes.empty()) return;
  make_segments(out);
  PieceMaker(out).run();
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
  RayHole& met = out.holes.emplace_back();
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
}

}  // namespace brume::smoke
