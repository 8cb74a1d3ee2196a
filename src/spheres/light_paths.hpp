// Light that comes from lights through glass to the spheres of a tank: docs/how/path-tracer.md.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "shared/optics.h"
#include "shared/photons.h"
#include "spheres/brick_lists.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// A ball that shines evenly in all directions. In voxels from the tank's low corner.
struct LightBall {
  glm::vec3 position{0};
  float radius = 0;        ///< 0: a point.
  glm::vec3 intensity{0};  ///< [W/sr] times the squared voxels of a metre.
};

/// In voxels from the tank's low corner. Without glass (its index is 0), there are no photons.
struct LightPathScene {
  std::vector<LightBall> lights;
  shared::Glass glass{glm::vec3(0), 0, glm::vec3(1)};
};

/// Whether two scenes have the same lights and the same glass: the same light paths.
bool same_light(const LightPathScene& a, const LightPathScene& b);

struct LightPathOptions {
  std::uint32_t count = 1u << 20;  ///< Paths that are aimed at the glass, at most kMostPhotons.
  std::uint64_t seed = 0;
  float radius = 0;  ///< Radius of the gathering [voxels]; 0: in proportion to the distances between photons.
};

/// Where light that has met the glass first meets spheres.
struct LightPaths {
  std::vector<shared::Photon> photons;  ///< By the hash of their cell.
  std::vector<std::uint32_t> cells;     ///< Where the photons of each hash begin, and one more entry.
  shared::PhotonGrid grid{0, 0};

  /// Irradiance at a point of an opaque sphere (`extinction` 0), or fluence at a point of a medium. By the
  /// sphere's index. Blurred over the radius; exact in the mean where light is parallel and nothing shades
  /// it.
  glm::vec3 gather(const glm::vec3& at, std::uint32_t sphere, const Sphere& ball, float extinction) const;
  /// The sum over all photons.
  glm::dvec3 flux() const;
};

/// Traces light from the lights to the glass, through it as often as it is reflected there, and to the first
/// event on an opaque sphere or in a medium. The same for any number of threads. Empty without paths, lights
/// or glass, and when `stopped`, called often and from any thread, returns true. Progress: "light paths".
LightPaths trace_light_paths(const Tank& tank, const BrickLists& bricks, const LightPathScene& scene,
                             const LightPathOptions& options, const std::function<bool()>& stopped = {});

/// Photons as above, in cells of a radius [voxels], > 0; equal hashes in the order that they are given in.
LightPaths sort_photons(std::vector<shared::Photon> photons, float radius);

}  // namespace brume::spheres
