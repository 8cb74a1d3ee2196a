// The interactive viewer.
#pragma once

#include "apps/viewer/viewer_options.hpp"

namespace brume::viewer {

/// Opens a window, loads a scenario in another thread, and returns when the window is closed. With `play` the
/// events of its timeline take place. Throws what `load` throws, no_device without a display or device, and
/// bad_input for an invalid timeline.
ViewerReport run_viewer(const ScenarioLoader& load, bool play, const ViewerOptions& options);

/// Makes a tank in another thread, and shows it; with `play` its time runs from the start. Quality, volumes,
/// view, weapons and record are options of levels alone. The screenshot has all samples of the scene.
ViewerReport run_viewer(const TankMaker& make, bool play, const ViewerOptions& options);

}  // namespace brume::viewer
