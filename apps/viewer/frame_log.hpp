// A CSV line per frame, readable while the window is open: shows hitches and memory over time, and lets tests
// wait for a frame with the properties that they check.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>

#include "apps/viewer/widgets.hpp"

namespace brume::viewer {

/// Where the image in the window comes from.
enum class PictureKind {
  film,   ///< Rendered for this frame.
  still,  ///< Paused: repeats the previous frame at its quality.
  best,   ///< Paused: full quality, the image that `brume render` renders.
};

struct FrameLine {
  double seconds = 0;  ///< Session time.
  double frame_ms = 0, tick_ms = 0, latency_ms = 0;
  glm::uvec2 size_px{0};  ///< Window size.
  PictureKind picture = PictureKind::film;
  std::uint64_t device_bytes = 0;
  std::size_t shader_faults = 0;  ///< Number of edited shaders that were rejected.
};

class FrameLog {
 public:
  FrameLog() = default;  ///< Writes nothing.
  /// Replaces the file by one with the header line; writes nothing for an empty path. Throws bad_input if the
  /// file cannot be written.
  explicit FrameLog(const std::filesystem::path& path);

  /// Adds a line with the frame number (from 1) and the memory of the process. Throws resource_limit if the
  /// disk is full.
  void add(const FrameLine& line);
  /// Adds the widgets of the next frame, if they changed: "widgets,COUNT", then for each of them
  /// "widget,ID,KIND,LEFT,TOP,RIGHT,BOTTOM,REACHABLE,IN_POPUP,USES,LABEL" (pixels; flags 0 or 1).
  void add_widgets(std::span<const Widget> widgets);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t frames_ = 0;
  std::string widgets_;  ///< As last added.
};

}  // namespace brume::viewer
