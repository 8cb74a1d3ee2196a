// Where each arrangement tries spheres.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "spheres/pack_levels.hpp"
#include "spheres/pack_options.hpp"

namespace brume::spheres {

/// A place for a sphere: within the tank with the radius `least`.
struct PackPlace {
  glm::vec3 center{0};
  std::uint32_t parent = kNoParent;  ///< Sphere that it touches.
  static constexpr std::uint32_t kNoParent = UINT32_MAX;
};

/// What is tried: attempt number `attempt` for sphere `slot` of PackOptions::count, with radii from `least`
/// to `radius`.
struct PackTry {
  std::uint32_t slot = 0, attempt = 0;
  float radius = 0, least = 0;
};

/// Proposes places. `propose` may be called from any thread, and depends on what was added before alone.
class PackPlaces {
 public:
  virtual ~PackPlaces() = default;
  virtual std::optional<PackPlace> propose(const PackTry& what) const = 0;
  /// Whether spheres have to keep the radius that they are tried with.
  virtual bool keeps_radius() const { return false; }
  /// Sphere `index` is inserted at this place.
  virtual void added(std::uint32_t /*index*/, const PackPlace& /*place*/) {}
  /// A sphere did not fit at this place.
  virtual void refused(const PackPlace& /*place*/) {}
  /// Most spheres to try at a time from now on.
  virtual std::uint32_t most_at_once() { return UINT32_MAX; }
};

/// Makes the places of the options' arrangement. They read `spheres`, which holds what is inserted so far.
std::unique_ptr<PackPlaces> make_pack_places(const PackOptions& options, const PackLevels& spheres);

/// A position along an axis of `size` voxels of a sphere inside of it: `fraction` in [0, 1) of what is
/// possible.
float pack_position(double fraction, float radius, std::uint32_t size);

}  // namespace brume::spheres
