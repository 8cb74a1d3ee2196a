// The window that a person plays in.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "apps/viewer/session.hpp"
#include "passes/debug_view.hpp"

namespace brume::viewer {

struct ViewerOptions {
  glm::uvec2 size_px{1280, 720};
  std::string title = "Brume";
  std::string device;       ///< As gpu::choose_device takes it.
  bool validation = false;  ///< Validation layers; what they say is in the report.
  bool vertical_sync = true;
  double frames_per_second = 60;     ///< That adaptive quality holds.
  std::optional<std::size_t> level;  ///< Of quality_levels, instead of adaptive quality.
  passes::DebugView view = passes::DebugView::none;
  bool panels = false, overlay = true;
  Weapons weapons;
  std::filesystem::path folder = ".";   ///< Where screenshots and recordings go.
  std::filesystem::path shaders;        ///< Watched for changes.
  std::optional<double> begin_at;       ///< Begins at this time of its clock, paused [s].
  std::optional<double> exit_after;     ///< The window closes at this time of its clock [s].
  std::filesystem::path screenshot;     ///< Of the end; empty: none.
  std::filesystem::path frame_log;      ///< A line for each frame; empty: none.
  std::filesystem::path record;         ///< The timeline of all that was done, at the end; empty: none.
  std::function<void()> check_signals;  ///< Called every frame; throws to end the program.
  std::optional<double> lose_device, lose_surface;  ///< For tests: at these times of the clock [s].
};

/// What a run of the window was like.
struct ViewerReport {
  std::string device, quality;
  std::uint64_t frames = 0;
  double seconds = 0;                                                      ///< Of the clock, at the end.
  double frames_per_second = 0, work_ms = 0, latency_ms = 0, tick_ms = 0;  ///< Medians of the last frames.
  std::vector<std::pair<std::string, double>> passes_ms;                   ///< Medians, too.
  std::uint32_t tick = 0;
  std::uint64_t state_hash = 0;
  std::uint64_t process_bytes = 0, device_bytes = 0;  ///< Memory at the end.
  std::size_t shader_reloads = 0, devices_lost = 0;
  std::vector<std::string> validation_messages;
};

/// Opens a window on a scenario until it is closed. With `play` what the scenario's timeline says happens, too.
/// Throws no_device when there is no display or no device, bad_input for a timeline that cannot be.
ViewerReport run_viewer(scenario::Scenario scenario, bool play, const ViewerOptions& options);

}  // namespace brume::viewer
