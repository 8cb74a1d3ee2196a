// The options of `brume view`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/cli/scene_options.hpp"
#include "apps/viewer/viewer.hpp"

namespace brume::cli {

struct ViewOptions {
  std::string input, play, size = "1280x720", device, quality = "auto", view = "none", word = "BRUME",
                           picture, folder = ".", screenshot, record, frame_log, json;
  std::string shaders;
  SceneOptions scene;
  std::uint32_t volume_memory = 0;  // [MiB]
  double frames_per_second = 60;
  std::optional<double> time, exit_after, lose_device, lose_surface;
  bool panels = false, bare = false, no_vertical_sync = false, validation = false, log_widgets = false;
};

/// What the window needs of them. Throws Error for invalid ones.
viewer::ViewerOptions viewer_options(const ViewOptions& options);

/// Throws Error (internal) if there are any.
void expect_no_messages(const std::vector<std::string>& validation_messages);

}  // namespace brume::cli
