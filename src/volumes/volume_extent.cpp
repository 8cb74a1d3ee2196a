#include "volumes/volume_extent.hpp"

#include <algorithm>

#include "grids/density_extent.hpp"

namespace brume::volumes {
namespace {

// What is less hot does not glow: by the fourth power.
constexpr float kGlows = 0.4f;

}  // namespace

VolumeExtent extent_of(const VolumeFrame& frame) {
  VolumeExtent extent{.bounds = frame.bounds};
  Box<float> bulk = kEmptyBox;
  const auto add = [&](const grids::BrickVolume& volume, float fraction) {
    const grids::DensityExtent measured = grids::measure_extent(volume, fraction);
    const glm::mat4 matrix(volume.world_from_voxel);
    // Nothing is drawn beyond the bounds, where heat may be.
    const Box<float> seen = intersection(transformed(matrix, measured.seen), frame.bounds);
    if (!measured.seen.empty() && !seen.empty()) extent.seen = united(extent.seen, seen);
    if (!measured.bulk.empty()) bulk = united(bulk, transformed(matrix, measured.bulk));
    extent.stray_part = std::max(extent.stray_part, measured.stray_part);
    extent.stray_reach = std::max(extent.stray_reach, measured.stray_reach);
    return measured.depth;
  };
  extent.depth = add(frame.density, kSeen);
  if (frame.heat) {
    add(*frame.heat, kGlows);
    extent.glow.push_back(grids::glow_columns(*frame.heat, frame.density));
    extent.hottest = frame.heat->densest;
  }
  if (extent.stray_part > 0) extent.bounds = intersection(frame.bounds, bulk);
  if (extent.seen.empty()) extent.seen = extent.bounds;
  return extent;
}

}  // namespace brume::volumes
