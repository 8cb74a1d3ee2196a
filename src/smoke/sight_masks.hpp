// A ray across the cells of a hole's mask.
#pragma once

#include <vector>

#include "core/float4.hpp"
#include "smoke/sight_holes.hpp"

namespace brume::smoke {

/// A part of a ray in which a hole's radius runs from r0 at t0 to r1 at t1, linearly.
struct RadiusSpan {
  float t0, r0, t1, r1;
};

/// Number by number: made elsewhere and copied as a whole, the numbers would wait in the processor for one
/// another.
inline void append_segment(std::vector<HoleSegment>& out, float begin, float end, std::uint32_t hole,
                           bool all, glm::ivec2 cell = glm::ivec2(0)) {
  HoleSegment& segment = out.emplace_back();
  segment.begin = begin;
  segment.end = end;
  segment.hole = hole;
  segment.all = all;
  segment.cell.x = cell.x;
  segment.cell.y = cell.y;
}

/// Appends the segments of a hole with a mask within the span, in order of t: none where the mask is black,
/// one for all white cells in a row, one for each other cell.
void add_mask_segments(const RayHole& hole, std::uint32_t number, const RadiusSpan& span,
                       std::vector<HoleSegment>& out);

/// What the cell of a mask removes, [0, 1], at four points of its cross-section; `wide` is the hole's radius.
Float4 mask_strength(const MaskView& mask, glm::ivec2 cell, Float4 x, Float4 y, Float4 wide);

}  // namespace brume::smoke
