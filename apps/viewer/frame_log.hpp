// One line of CSV a frame, readable while the window is open: hitches, memory and pictures over time, and how
// a test knows what was drawn.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>

namespace brume::viewer {

/// How the picture in the window came about.
enum class PictureKind {
  film,   ///< Drawn for this frame.
  still,  ///< Paused: the one of the frame before, not yet at its best.
  best,   ///< Paused: the picture that `brume render` draws.
};

struct FrameLine {
  double seconds = 0;  ///< Of the viewer's clock.
  double frame_ms = 0, tick_ms = 0, latency_ms = 0;
  glm::uvec2 size_px{0};  ///< Of the window.
  PictureKind picture = PictureKind::film;
  std::uint64_t device_bytes = 0;
  std::size_t shader_faults = 0;  ///< Changed shaders that were refused.
};

class FrameLog {
 public:
  /// Writes the heading. An empty path: no log. Throws bad_input when the file cannot be written.
  explicit FrameLog(const std::filesystem::path& path);

  /// Adds a line, with the frame's number (from 1) and the memory of the process. Throws resource_limit when
  /// the disk is full.
  void add(const FrameLine& line);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t frames_ = 0;
};

}  // namespace brume::viewer
