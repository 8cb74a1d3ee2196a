// The interactive viewer of tanks of spheres.
#pragma once

#include "apps/viewer/tank_job.hpp"
#include "apps/viewer/viewer.hpp"

namespace brume::viewer {

/// Statistics of a run.
struct TankViewerReport {
  std::string device;
  std::uint64_t frames = 0;                           ///< That the window showed.
  double seconds = 0;                                 ///< Time of the scene at the end.
  std::size_t spheres = 0;                            ///< At the end.
  std::uint32_t samples = 0;                          ///< Of each pixel of the last picture.
  glm::uvec2 picture_px{0};                           ///< Its size.
  std::uint64_t process_bytes = 0, device_bytes = 0;  ///< Memory at the end.
  std::size_t packings = 0;                           ///< After the first tank.
  std::size_t shader_reloads = 0, devices_lost = 0;
  std::vector<std::string> validation_messages;
};

/// Opens a window, makes a tank in another thread, and returns when the window is closed. With `play` its
/// time runs from the start. Of the options those of levels are not used: quality, volumes, view, weapons,
/// record. The screenshot has all samples of the scene. Throws what `make` throws, and no_device without a
/// display or device.
TankViewerReport run_tank_viewer(const TankMaker& make, bool play, const ViewerOptions& options);

}  // namespace brume::viewer
