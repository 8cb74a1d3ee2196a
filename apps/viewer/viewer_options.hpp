// Options of a run of the viewer, and what it reports.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/viewer/session.hpp"
#include "passes/debug_view.hpp"
#include "scenario/tank.hpp"

namespace brume::viewer {

struct ViewerOptions {
  glm::uvec2 size_px{1280, 720};
  std::string level_name = "level";  ///< Its name, for the title and while it loads.
  std::string device;                ///< As for gpu::choose_device.
  bool validation = false;           ///< Enables the validation layers; the report holds their messages.
  bool vertical_sync = true;
  double frames_per_second = 60;     ///< Target of the adaptive quality.
  std::uint64_t volume_bytes = 0;    ///< Device memory for volumes; 0: as much as suits the device.
  std::optional<std::size_t> level;  ///< Index into quality_levels() instead of adaptive quality.
  passes::DebugView view = passes::DebugView::none;
  bool panels = false, overlay = true;
  Weapons weapons;
  std::filesystem::path folder = ".";   ///< For screenshots and recordings.
  std::filesystem::path shaders;        ///< Folder of shader sources to watch for changes.
  std::optional<double> begin_at;       ///< Starts at this session time [s]; paused, without exit_after.
  std::optional<double> exit_after;     ///< Closes the window at this session time [s].
  std::filesystem::path screenshot;     ///< Saved at exit_after; empty: none.
  std::filesystem::path frame_log;      ///< CSV file with a line per frame; empty: none.
  bool log_widgets = false;             ///< The frame log lists the widgets, too.
  std::filesystem::path record;         ///< Timeline of the session, saved on exit; empty: none.
  std::function<void()> check_signals;  ///< Called every frame; throws to end the program.
  std::function<void(const std::string&)> say;      ///< Shows a line on the terminal; empty: none.
  std::optional<double> lose_device, lose_surface;  ///< For tests: session times of simulated losses [s].
};

/// Statistics of a level.
struct LevelReport {
  std::string quality;
  double frames_per_second = 0, work_ms = 0, latency_ms = 0, tick_ms = 0;  ///< Medians of the last frames.
  std::vector<std::pair<std::string, double>> passes_ms;                   ///< Median GPU time of each pass.
  std::uint32_t tick = 0;
  std::uint64_t state_hash = 0;
};

/// Statistics of a tank.
struct TankReport {
  std::size_t spheres = 0;    ///< At the end.
  std::uint32_t samples = 0;  ///< Samples of each pixel of the last picture.
  glm::uvec2 picture_px{0};   ///< Its size.
  std::size_t packings = 0;   ///< After the first tank.
};

/// Statistics of a viewer run.
struct ViewerReport {
  std::string device;
  std::uint64_t frames = 0;  ///< Frames of the running film; all frames of a tank.
  double seconds = 0;        ///< Session time at the end.
  std::variant<LevelReport, TankReport> document;
  std::uint64_t process_bytes = 0, device_bytes = 0;  ///< Memory at the end.
  std::size_t shader_reloads = 0, devices_lost = 0;
  std::vector<std::string> validation_messages;
};

using ScenarioLoader = std::function<scenario::Scenario()>;
/// Makes a tank with its scene; packing ends early, with what is packed so far, when its argument returns
/// true. Throws Error.
using TankMaker = std::function<scenario::TankScenario(const std::function<bool()>& stopped)>;

}  // namespace brume::viewer
