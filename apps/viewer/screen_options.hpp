// How the screens of windows use a device.
#pragma once

#include <string>

namespace brume::viewer {

struct ScreenOptions {
  std::string device;       ///< As for gpu::choose_device.
  bool validation = false;  ///< Enables the validation layers; Context stores their messages.
  bool vertical_sync = true;
};

}  // namespace brume::viewer
