#include "smoke/sight_masks.hpp"

#include <algorithm>
#include <cmath>

namespace brume::smoke {
namespace {

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

}  // namespace

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

}  // namespace brume::smoke
