// Where a volume can be seen, how deep it is, and how it glows: what its first view is made from.
#pragma once

#include <string>
#include <vector>

#include "core/box.hpp"
#include "grids/glow.hpp"
#include "volumes/stray_note.hpp"
#include "volumes/volume_frame.hpp"

namespace brume::volumes {

/// Where a volume can be seen over its frames, in the world of its files, and how deep it is.
struct VolumeExtent {
  Box<float> bounds = kEmptyBox;  ///< Around what can be dense and does not stray.
  Box<float> seen = kEmptyBox;    ///< Around what is dense enough to be seen, or glows: what a camera frames.
  double depth = 0;               ///< As grids::DensityExtent::depth: of the deepest frame.
  /// As grids::DensityExtent: most of any frame.
  double stray_part = 0, stray_reach = 0;
  /// What glows, of each frame that was measured, and the hottest of them: BrickVolume::densest, 0 without.
  std::vector<std::vector<grids::GlowColumn>> glow = {};
  float hottest = 0;
};

VolumeExtent extent_of(const VolumeFrame& frame);

/// What of it lies far outside of the picture, a sentence; empty: nothing.
inline std::string stray_note(const VolumeExtent& extent) {
  return stray_note(extent.stray_part, extent.stray_reach);
}

}  // namespace brume::volumes
