// A tank of spheres at a time, its lights, glass and air, as its path tracer reads it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "scene/tank_scene.hpp"
#include "spheres/tank.hpp"
#include "surfaces/sampler.hpp"
#include "trace/sphere_tree.hpp"

namespace brume::reference {

using surfaces::Sampler;

// All lengths are in voxels from the tank's low corner, all numbers doubles.

/// A ball that shines evenly in all directions; it is invisible and blocks nothing.
struct TankBall {
  glm::dvec3 center{0};
  double radius = 0;        ///< 0: a point, which only direct light is from.
  glm::dvec3 intensity{0};  ///< [W/sr] times the squared voxels of a metre.
  glm::dvec3 radiance{0};   ///< What its surface sends outwards; 0 for a point.
};

/// An ellipsoid of a clear dielectric.
struct TankLensBody {
  glm::dvec3 center{0}, radii{1};
  double index = 1;  ///< Index of refraction relative to the outside.

  bool contains(const glm::dvec3& at) const;
  /// Where a line enters and leaves it, in units of its direction; x > y: nowhere.
  glm::dvec2 crossings(const glm::dvec3& origin, const glm::dvec3& direction) const;
  /// A ray (unit direction) at the surface, from inside or outside: reflects or refracts it, as Fresnel's
  /// equations for unpolarized light say for `random` in [0, 1). Returns whether it has passed.
  bool cross(const glm::dvec3& at, bool inside, double random, glm::dvec3& direction) const;
};

/// A ray among the spheres; `direction` is unit.
struct TankRay {
  static constexpr std::uint32_t kNone = trace::SphereTree::kNone;
  glm::dvec3 origin{0}, direction{0, 0, 1};
  std::uint32_t leaves = kNone;  ///< The opaque sphere from whose surface it comes.
  std::uint32_t inside = kNone;  ///< The ball of medium in which it begins.
  glm::dvec3 at(double t) const { return origin + t * direction; }
};

/// Where a ray is scattered.
struct TankEvent {
  std::uint32_t sphere = TankRay::kNone;  ///< kNone: nowhere.
  double t = std::numeric_limits<double>::infinity();
  bool is_surface = false;
};

/// What light meets.
class TankModel {
 public:
  /// `scene`: its lights and its glass where they are now (scene_at). The tank must outlive it. Throws what
  /// SphereTree::build fails with.
  TankModel(const spheres::Tank& tank, const scene::TankScene& scene);

  glm::dvec3 voxel_from_world(const glm::vec3& p_world) const {
    return glm::dvec3(p_world) / voxel_ + 0.5 * glm::dvec3(tank_.size);
  }
  double voxel() const { return voxel_; }  ///< [m]
  const std::vector<TankBall>& lights() const { return lights_; }
  const std::optional<TankLensBody>& glass() const { return glass_; }
  std::uint32_t bounces() const { return bounces_; }
  const scene::SkyOptions& sky() const { return sky_; }
  const scene::TankFog& fog() const { return fog_; }
  double fog_extinction() const { return fog_extinction_; }  ///< Per voxel's length.

  const spheres::Sphere& sphere(std::uint32_t i) const { return tank_.spheres[i]; }
  /// Linear colour.
  glm::dvec3 albedo(std::uint32_t sphere) const;
  bool is_opaque(std::uint32_t sphere) const { return tank_.colors[sphere] >> 24 == 255; }
  /// Extinction of a sphere that is not opaque, per length of a voxel.
  double extinction(std::uint32_t sphere) const { return extinctions_[tank_.colors[sphere] >> 24]; }
  glm::dvec3 normal(std::uint32_t sphere, const glm::dvec3& at) const {
    return glm::normalize(at - glm::dvec3(tank_.spheres[sphere].center));
  }

  /// The first event on a ray before `end`: the surface of an opaque sphere, or one in a medium, at random.
  TankEvent next_event(const TankRay& ray, double end, Sampler& sampler) const;
  /// Fraction of light that passes between the origin and `end`.
  double transmittance(const TankRay& ray, double end) const;
  /// How far a ray goes inside of the tank's box before `end`.
  double length_in_tank(const TankRay& ray, double end) const;

 private:
  template <typename Visit>
  void for_each_sphere(const TankRay& ray, double end, const Visit& visit) const;
  glm::dvec2 crossings(std::uint32_t sphere, const TankRay& ray) const;
  glm::dvec2 box_crossings(const TankRay& ray, double margin) const;

  const spheres::Tank& tank_;
  double voxel_;
  std::vector<TankBall> lights_;
  std::optional<TankLensBody> glass_;
  std::uint32_t bounces_;
  scene::SkyOptions sky_;
  scene::TankFog fog_;
  double fog_extinction_;
  std::vector<double> linear_, extinctions_;  ///< By byte of a colour.
  trace::SphereTree tree_;
};

/// The scene with its lights and its glass where they are at a time [s].
inline scene::TankScene scene_at(const scene::TankScene& scene, double time) {
  scene::TankScene at = scene;
  for (scene::TankLight& light : at.lights) light = scene::light_at(light, time);
  if (at.glass) at.glass = scene::glass_at(*at.glass, time);
  return at;
}

}  // namespace brume::reference
