// Options that stand in for a timeline: the smoke, scale, light and exposure of a scene alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/cli/arguments.hpp"
#include "scenario/first_view.hpp"
#include "scenario/scenario.hpp"

namespace brume::cli {

struct SceneOptions {
  std::vector<std::string> smokes, throws;
  std::optional<double> smoke_size, voxel, scale, exposure;
  std::string sun, tone;
};

void declare_scene_options(const Arguments& arguments, SceneOptions& options);

/// All that the options say, for a key of what depends on them.
std::vector<std::string> texts_of(const SceneOptions& options);

/// Checks the options' values. Throws Error (usage).
scenario::FirstViewOptions parse_scene_options(const SceneOptions& options);

/// Loads a timeline, or a scene with `timeline` (empty: none), with the options applied; warns of smokes that
/// cannot be seen. Throws Error.
scenario::Scenario load_with_options(const std::string& input, const std::string& timeline,
                                     const scenario::FirstViewOptions& options);

}  // namespace brume::cli
