#include "volumes/volume_extent.hpp"

#include <algorithm>
#include <cstdio>

#include "grids/density_extent.hpp"

namespace brume::volumes {
namespace {

// What is less dense is not seen; what is less hot does not glow: by the fourth power.
constexpr float kSeen = 0.01f, kGlows = 0.4f;

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

std::string stray_note(const VolumeExtent& extent) {
  if (!(extent.stray_part > 0)) return "";
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%.2g %% of its voxels lie far from the rest, up to %.4g units, outside of the first picture: "
      "--camera shows them",
      100 * extent.stray_part, extent.stray_reach);
  return text;
}

Result<std::string> stray_note(const grids::Grid& density) {
  // At a lower resolution a large grid takes little memory, and strays as far.
  constexpr std::uint32_t kMostBricks = 1u << 15;
  const auto volume = grids::make_brick_volume(density, {.max_bricks = kMostBricks});
  if (!volume) return volume.failure();
  const grids::DensityExtent extent = grids::measure_extent(*volume, kSeen);
  return stray_note(VolumeExtent{.stray_part = extent.stray_part, .stray_reach = extent.stray_reach});
}

}  // namespace brume::volumes
