#include "spheres/sense.hpp"

#include <cmath>
#include <limits>

#include "core/tasks.hpp"
#include "spheres/color.hpp"

namespace brume::spheres {
namespace {

constexpr std::size_t kRayGrain = 256;  // rays of a task

}  // namespace

Sensed sense_ray(const TankView& view, const glm::vec3& position_world, const glm::vec3& direction) {
  const double voxel = view.tank.voxel;
  const glm::vec3 origin(glm::dvec3(position_world) / voxel + 0.5 * glm::dvec3(view.tank.size));
  const double length = glm::length(glm::dvec3(direction));  // what t = 1 is long [voxels]
  constexpr double kHalf = 0.6931471805599453;               // optical depth that takes half
  double depth = 0;                                          // optical depth so far
  double half_at = std::numeric_limits<double>::infinity();  // t
  glm::dvec3 color(0);
  visit_chords(view, origin, direction, kNoEnd, [&](const Chord& chord) {
    const Color of_sphere = view.tank.colors[chord.id - 1];
    if (of_sphere >> 24 == 0) return true;
    const double extinction = extinction_of(of_sphere) * length;  // per t
    const bool ends = is_opaque(of_sphere);
    const double taken = ends ? 1 : -std::expm1(-extinction * (chord.leave - chord.enter));
    color += std::exp(-depth) * taken * glm::dvec3(albedo_of(of_sphere));
    const double after =
        ends ? std::numeric_limits<double>::infinity() : depth + extinction * (chord.leave - chord.enter);
    if (depth < kHalf && after >= kHalf) half_at = chord.enter + (ends ? 0 : (kHalf - depth) / extinction);
    depth = after;
    return !ends;
  });
  return {glm::vec3(color), static_cast<float>(-std::expm1(-depth)),
          static_cast<float>(half_at * length * voxel)};
}

std::vector<Sensed> sense(const TankView& view, const Eye& eye) {
  // Axes as planning::device_camera has them.
  const glm::vec3 apart = eye.target_world - eye.position_world;
  const glm::vec3 forward = glm::length(apart) > 1e-6f ? glm::normalize(apart) : glm::vec3(0, 0, -1);
  const bool is_along_up = glm::length(glm::vec2(forward.x, forward.z)) < 1e-3f;
  const glm::vec3 helper = is_along_up ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(forward, helper)), up = glm::cross(right, forward);
  const glm::vec2 size(eye.size);
  const float tan_y = std::tan(0.5f * eye.vertical_fov), tan_x = tan_y * size.x / size.y;

  std::vector<Sensed> seen(std::size_t{eye.size.x} * eye.size.y);
  parallel_for(seen.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec2 pixel(static_cast<float>(i % eye.size.x), static_cast<float>(i / eye.size.x));
      const glm::vec2 at = 2.0f * (pixel + 0.5f) / size - 1.0f;
      seen[i] = sense_ray(view, eye.position_world,
                          glm::normalize(forward + at.x * tan_x * right - at.y * tan_y * up));
    }
  });
  return seen;
}

}  // namespace brume::spheres
