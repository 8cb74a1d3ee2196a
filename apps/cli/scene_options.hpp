// Options that stand in for a timeline: the smoke, scale, light and exposure of a scene alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/json.hpp"
#include "scenario/first_view.hpp"
#include "scenario/scenario.hpp"
#include "scenario/smoke_report.hpp"

namespace brume::cli {

struct SceneOptions {
  std::vector<std::string> smokes, throws;
  std::optional<double> smoke_size, voxel, scale, exposure;
  std::string sun, tone, ground = "auto", opacity, color_map, range, density, heat;
  std::optional<double> kelvin, volume_fps;
  std::optional<std::uint32_t> bounces;
};

void declare_scene_options(const Arguments& arguments, SceneOptions& options);

/// The same without --smoke and --throw, for the viewer.
void declare_level_options(const Arguments& arguments, SceneOptions& options);

/// Declares --volume-memory.
void declare_volume_memory(const Arguments& arguments, std::uint32_t& mebibytes);

/// All that the options say, for a key of what depends on them.
std::vector<std::string> to_texts(const SceneOptions& options);

/// Checks the options' values. Throws Error (usage).
scenario::FirstViewOptions parse_scene_options(const SceneOptions& options);

/// Declares --voxel and --scale alone, for commands without an image.
void declare_size_options(const Arguments& arguments, SceneOptions& options);

/// Loads a timeline, or a scene with `timeline` (empty: none), with the options applied. Throws Error; the
/// code is usage for a file whose suffix neither timelines nor scenes have.
scenario::Scenario load_with_options(const std::string& input, const std::string& timeline,
                                     const scenario::FirstViewOptions& options);

/// Warns of each smoke that cannot be seen, and of camera keys and events after the timeline's end. Returns
/// the reports as JSON: the list "smokes" of docs/reference/command-line.md.
Json report_timeline(const scenario::Scenario& scenario, const std::vector<scenario::SmokeReport>& smokes);

}  // namespace brume::cli
