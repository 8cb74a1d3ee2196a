// What a file of grids alone is shown with, as prepare_first_view does for a scene.
#pragma once

#include <filesystem>

#include "scenario/first_view.hpp"
#include "volumes/volumes.hpp"

namespace brume::scenario {

/// The timeline of a file of grids without one:
///
/// - scale: as given, or fitting_scale with a warning;
/// - up: as its program writes files (VolumeFrame::z_is_up);
/// - extinction: an optical depth of kViewDepth through the deep parts of the deepest frame, whatever its
/// units; less
///   where voxels would be opaque one by one. With an opacity curve: through a ball of the volume's size;
/// - light: a sun before a deep blue sky, exposed for white clouds, or for the brightest fire of all frames;
/// - ground: below it, for its shadow;
/// - tone curve: ToneCurve::standard for what glows: flames stay yellow.
///
/// Smoke is thrown only where the options say so. `frame` is the typical one of its sequence, of which
/// `extent` is.
scene::Timeline prepare_volume_view(const std::filesystem::path& path, const volumes::VolumeFrame& frame,
                                    const volumes::VolumeExtent& extent, const FirstViewOptions& options);
constexpr double kViewDepth = 15;

}  // namespace brume::scenario
