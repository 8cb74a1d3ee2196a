#include "apps/viewer/frame_log.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include "apps/viewer/figures.hpp"
#include "core/error.hpp"

namespace brume::viewer {

FrameLog::FrameLog(const std::filesystem::path& path) : path_(path) {
  if (path.empty()) return;
  // Not an AtomicFile: the log is read while it grows.
  file_.reset(std::fopen(path.c_str(), "w"));
  if (!file_) throw Error(ErrorCode::bad_input, path.string() + ": cannot write: " + std::strerror(errno));
  std::fputs(
      "frame,seconds,frame_ms,tick_ms,latency_ms,width,height,picture,mapped_bytes,heap_bytes,device_bytes,"
      "shader_faults\n",
      file_.get());
}

void FrameLog::add(const FrameLine& line) {
  if (!file_) return;
  constexpr std::array kNames{"film", "still", "best"};
  std::fprintf(file_.get(), "%llu,%.6f,%.3f,%.3f,%.3f,%u,%u,%s,%llu,%llu,%llu,%zu\n",
               static_cast<unsigned long long>(++frames_), line.seconds, line.frame_ms, line.tick_ms,
               line.latency_ms, line.size_px.x, line.size_px.y,
               kNames[static_cast<std::size_t>(line.picture)],
               static_cast<unsigned long long>(mapped_bytes()), static_cast<unsigned long long>(heap_bytes()),
               static_cast<unsigned long long>(line.device_bytes), line.shader_faults);
  if (std::fflush(file_.get()) == 0) return;
  throw Error(ErrorCode::resource_limit,
              path_.string() + ": cannot write: " + std::strerror(errno) + "; free some space");
}

void FrameLog::add_widgets(std::span<const Widget> widgets) {
  if (!file_) return;
  std::string text = "widgets," + std::to_string(widgets.size()) + "\n";
  for (const Widget& widget : widgets) {
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "widget,%08x,%s,%.0f,%.0f,%.0f,%.0f,%d,%d,%llu,", widget.id,
                  widget.kind, double{widget.low_px.x}, double{widget.low_px.y}, double{widget.high_px.x},
                  double{widget.high_px.y}, widget.reachable, widget.in_popup,
                  static_cast<unsigned long long>(widget.uses));
    text += numbers + widget.label + "\n";
  }
  if (text == widgets_) return;
  std::fputs(text.c_str(), file_.get());
  widgets_ = std::move(text);
}

}  // namespace brume::viewer
