// Which of the palette's colours packed spheres take.
#pragma once

#include <span>

#include "spheres/pack_options.hpp"

namespace brume::spheres {

/// Gives tank.colors to all of tank.spheres. Sphere i's depends on itself, on i and on the options alone.
void color_spheres(Tank& tank, const PackOptions& options);

}  // namespace brume::spheres
