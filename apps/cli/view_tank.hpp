// `brume view` of a tank of spheres.
#pragma once

#include <filesystem>

#include "apps/cli/command.hpp"
#include "apps/cli/view_options.hpp"

namespace brume::cli {

/// Shows the scene of a tank, or a file of one, until its window is closed. Throws Error.
void view_tank(const Arguments& arguments, const ViewOptions& options, const std::filesystem::path& input,
               Outputs& outputs);

}  // namespace brume::cli
