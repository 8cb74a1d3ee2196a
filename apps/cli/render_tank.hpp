// `brume render` of a tank of spheres.
#pragma once

#include "apps/cli/command.hpp"
#include "apps/cli/render_options.hpp"

namespace brume::cli {

/// Renders the scene of a tank, or a file of one, as the plan says. Throws Error.
void render_tank(const Arguments& arguments, const RenderOptions& options, const Plan& plan,
                 CommonOptions& common);

}  // namespace brume::cli
