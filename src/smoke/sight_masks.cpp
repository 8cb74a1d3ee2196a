#include "smoke/sight_masks.hpp"

#include <algorithm>
#include <cmath>

namespace brume::smoke {
namespace {

constexpr float kNever = 1e30f;

/// A ray along one axis of a mask. Its coordinate counts cells: cell i is [i, i + 1).
struct MaskAxis {
  float x, x_step;  // from the hole's axis: x + x_step (t - nearest)
  float nearest;
  int texels;
  RadiusSpan span;

  float slope() const { return (span.r1 - span.r0) / (span.t1 - span.t0); }
  int cell_at(float t) const {
    const float from_axis = x + x_step * (t - nearest), radius = span.r0 + slope() * (t - span.t0);
    const auto count = static_cast<float>(texels);
    if (!(radius > 1e-12f)) return from_axis < 0 ? 0 : texels;
    const float across = (0.5f + 0.5f * from_axis / radius) * count + 0.5f;
    return static_cast<int>(std::clamp(across, 0.0f, count));
  }
  /// Where the ray crosses the plane between two cells: its distance from the hole's axis is then a fixed
  /// fraction of the radius.
  float crossing(int plane) const {
    const float fraction = (2 * static_cast<float>(plane) - 1) / static_cast<float>(texels) - 1;
    const float at_nearest = span.r0 + slope() * (nearest - span.t0);
    const float speed = x_step - fraction * slope();
    return speed != 0 ? nearest + (fraction * at_nearest - x) / speed : kNever;
  }
};

/// The cells of one axis in the order of the ray: it never turns around, as the radius is linear.
class AxisWalk {
 public:
  AxisWalk(const MaskAxis& axis, int first_in_atlas, float from, float to)
      : axis_(axis), first_(first_in_atlas), cell_(axis.cell_at(from)), last_(axis.cell_at(to)) {}
  int cell() const { return cell_; }

  /// Sets the end of the cell, or of its block, and returns where the ray crosses it.
  float find_exit(bool block) {
    if (cell_ == last_) return exit_ = kNever;
    const bool up = last_ > cell_;
    const int low = block ? ((first_ + cell_) & -kMaskBlock) - first_ : cell_;
    plane_ = up ? low + (block ? kMaskBlock : 1) : low;
    // Beyond the last cell is no crossing.
    return exit_ = (up ? plane_ > last_ : plane_ <= last_) ? kNever : axis_.crossing(plane_);
  }
  /// Moves on to t, at most that crossing.
  void move_to(float t, bool block) {
    if (cell_ == last_) return;
    const bool up = last_ > cell_;
    if (exit_ <= t)
      cell_ = up ? plane_ : plane_ - 1;
    else if (block)
      cell_ = up ? std::clamp(axis_.cell_at(t), cell_, std::min(plane_ - 1, last_))
                 : std::clamp(axis_.cell_at(t), std::max(plane_, last_), cell_);
  }

 private:
  const MaskAxis& axis_;
  int first_, cell_, last_, plane_ = 0;
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
  const MaskAxis across{h.x, h.x_step, h.nearest, h.mask.width, span},
      down{-h.y, -h.y_step, h.nearest, h.mask.height, span};
  float t = t0, end = t1;
  for (const MaskAxis& axis : {across, down}) {
    const float p0 = axis.x + axis.x_step * (t0 - h.nearest), p1 = axis.x + axis.x_step * (t1 - h.nearest);
    clip(r0 - p0, r1 - p1, t0, t1, t, end);
    clip(r0 + p0, r1 + p1, t0, t1, t, end);
  }
  if (!(t < end)) return;

  // Cell by cell; a block of equal ones in one step.
  const bool closing = h.closing_at(0.5f * (t0 + t1));
  AxisWalk x(across, h.mask.first.x, t, end), y(down, h.mask.first.y, t, end);
  const std::size_t first = out.size();
  bool white_before = false;
  while (t < end) {
    const glm::ivec2 cell(x.cell(), y.cell());
    MaskKind kind = h.mask.block_kind(cell);
    const bool block = kind != MaskKind::mixed;
    if (!block) kind = h.mask.kind(cell);
    const float to = std::max(t, std::min({x.find_exit(block), y.find_exit(block), end}));
    if (t < to) {
      const bool white = kind == MaskKind::white;
      if (white && white_before && out.size() > first)
        out.back().end = to;
      else if (kind != MaskKind::black)
        out.push_back({t, to, number, white && !closing, cell});
      white_before = white;
    }
    x.move_to(to, block);
    y.move_to(to, block);
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
