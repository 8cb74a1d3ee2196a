// What a file of grids alone is shown with, as prepare_first_view does for a scene.
#pragma once

#include <filesystem>

#include "scenario/first_view.hpp"
#include "scenario/volumes.hpp"

namespace brume::scenario {

/// The timeline of a file of grids without one:
///
/// - scale: as given, or fitting_scale with a warning;
/// - up: as its program writes files (VolumeFrame::z_is_up);
/// - extinction: an optical depth of kViewDepth through a ball of the volume's size, whatever its units and
///   opacity curve;
/// - light: a sun before a blue sky, exposed for white clouds;
/// - ground: below a volume that glows, whose tone curve is ToneCurve::standard: flames stay yellow.
///
/// Smoke is thrown only where the options say so.
scene::Timeline prepare_volume_view(const std::filesystem::path& path, const VolumeFrame& frame,
                                    const FirstViewOptions& options);
constexpr float kViewDepth = 12;

}  // namespace brume::scenario
