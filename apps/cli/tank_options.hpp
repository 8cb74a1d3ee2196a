// What the options of `render` and `view` mean for a tank of spheres.
#pragma once

#include <filesystem>
#include <functional>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/outputs.hpp"
#include "scenario/first_view.hpp"
#include "scenario/tank.hpp"

namespace brume::cli {

/// Declares that a file is read; of a tank, what its scene names, too.
void declare_input(Outputs& outputs, const std::filesystem::path& input);

/// Throws Error (usage) if an option is given that tanks do not know.
void refuse_options_of_levels(const Arguments& arguments);

/// Loads a tank with the options applied. `stopped`: as scenario::load_tank_scenario. Throws Error.
scenario::TankScenario load_tank(const std::filesystem::path& input,
                                 const scenario::FirstViewOptions& options,
                                 const std::function<bool()>& stopped);

}  // namespace brume::cli
