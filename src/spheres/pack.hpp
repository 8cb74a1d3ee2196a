// Packs spheres into a tank.
#pragma once

#include <functional>

#include "core/error.hpp"
#include "spheres/pack_options.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Packs spheres until there are `count` or no room is found for more: Tank::spheres may then be fewer. The
/// same tank for the same options and any number of threads. `stopped`, called often and from any thread,
/// ends it early with what is packed so far. Fails as check_options. Its Progress is "pack spheres".
///
/// Radii follow the power law, independent of each other (random) or one from each of `count` equally
/// probable ranges. Only a sphere that finds no room at 24 places shrinks, step by step, down to the least
/// radius. In exact arithmetic |c_i - c_j| >= r_i + r_j and r <= c <= size - r along each axis.
Result<Tank> pack(const PackOptions& options, const std::function<bool()>& stopped = {});

}  // namespace brume::spheres
