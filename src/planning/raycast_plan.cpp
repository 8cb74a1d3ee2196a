#include "planning/raycast_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace brume::planning {
namespace {

/// Boxes are clipped this far from the eye [m]: the scene's near plane would cut a hole into them.
constexpr double kBoxNear = 1e-4;
/// An eye this near to a box counts as inside [m].
constexpr double kAroundEye = 1e-2;

/// From the view's axes, which are not scaled, to the world.
glm::dmat4 world_from_view(const shared::Camera& camera) {
  return glm::dmat4(glm::dvec4(glm::normalize(glm::dvec3(camera.right)), 0),
                    glm::dvec4(glm::normalize(glm::dvec3(camera.up)), 0),
                    glm::dvec4(-glm::dvec3(camera.forward), 0), glm::dvec4(glm::dvec3(camera.eye_world), 1));
}

/// Reverse depth, infinite far plane; Vulkan's y runs down.
glm::dmat4 clip_from_view(double focal_length, const glm::dvec2& shift, glm::uvec2 size_px) {
  glm::dmat4 clip(0);
  clip[0][0] = focal_length * size_px.y / size_px.x;
  clip[1][1] = -focal_length;
  clip[2] = glm::dvec4(shift.x, -shift.y, 0, -1);
  clip[3][2] = kBoxNear;
  return clip;
}

/// The longest chord of a box under an affine transform: the longest of its four diagonals.
double longest_diagonal(const glm::dmat4& world_from_voxel, glm::dvec3 size) {
  double longest = 0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 diagonal = size * glm::dvec3(i & 1 ? -1 : 1, i & 2 ? -1 : 1, 1);
    longest = std::max(longest, glm::length(glm::dvec3(world_from_voxel * glm::dvec4(diagonal, 0))));
  }
  return longest;
}

double shortest_edge(const glm::dmat4& world_from_voxel) {
  double shortest = 1e300;
  for (int axis = 0; axis < 3; ++axis)
    shortest = std::min(shortest, glm::length(glm::dvec3(world_from_voxel[axis])));
  return shortest;
}

/// Whether the eye is inside of a box, or nearly.
bool is_around_eye(const shared::RaycastVolume& volume, const glm::dmat4& voxel_from_view) {
  const glm::vec3 eye_voxel(voxel_from_view[3]);
  for (int axis = 0; axis < 3; ++axis) {
    const double per_metre =
        glm::length(glm::dvec3(voxel_from_view[0][axis], voxel_from_view[1][axis], voxel_from_view[2][axis]));
    const double margin = kAroundEye * per_metre, eye = double{eye_voxel[axis]};
    if (eye < double{volume.bounds_min[axis]} - margin || eye > double{volume.bounds_max[axis]} + margin)
      return false;
  }
  return true;
}

glm::dmat4 inverse_of(const glm::dmat4& voxel_from_world) {
  const glm::dmat4 inverse = glm::inverse(voxel_from_world);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(inverse[column][row]))
        throw Error(ErrorCode::bad_input,
                    "the transform of a volume has no inverse; give each axis a length");
  return inverse;
}

}  // namespace

RaycastPlan plan_raycast(const shared::Camera& camera, glm::uvec2 size_px,
                         std::span<const PlacedVolume> volumes, const RaycastLight& light,
                         const RaycastSteps& steps) {
  RaycastPlan plan;
  const glm::dmat4 from_view = world_from_view(camera), to_view = glm::inverse(from_view);
  const double focal_length = 1 / glm::length(glm::dvec3(camera.up));
  const glm::dmat4 projection = clip_from_view(focal_length, glm::dvec2(camera.shift), size_px);
  plan.view.size_px = size_px;
  plan.view.focal_length = static_cast<float>(focal_length);
  plan.view.shift = camera.shift;
  plan.view.near_z = camera.near_z;
  plan.view.sun_direction = glm::vec3(to_view * glm::dvec4(glm::dvec3(light.to_sun), 0));
  plan.view.sun_irradiance = light.sun_irradiance;
  plan.view.ambient = light.ambient;
  plan.view.phase = light.phase;
  plan.view.opaque_transmittance = steps.opaque_transmittance;

  std::vector<double> distances;
  for (const PlacedVolume& volume : volumes) {
    // Spaces.
    const shared::VolumeInstance& instance = volume.instance;
    const glm::dmat4 to_voxel = glm::dmat4(glm::mat4(matrix_of(instance.voxel_from_world))),
                     from_voxel = inverse_of(to_voxel), voxel_from_view = to_voxel * from_view;
    shared::RaycastVolume placed{};
    placed.clip_from_voxel = glm::mat4(projection * to_view * from_voxel);
    placed.voxel_from_view = shared::affine_of(glm::mat4x3(glm::dmat4x3(voxel_from_view)));
    placed.to_sun = glm::vec3(to_voxel * glm::dvec4(glm::dvec3(light.to_sun), 0));
    placed.bounds_min = instance.bounds_min;
    placed.bounds_max = instance.bounds_max;

    // Steps that reach across: a chord of n steps touches up to n + 1 steps of the lattice.
    const glm::dvec3 size(instance.bounds_max - instance.bounds_min);
    const double diagonal = longest_diagonal(from_voxel, size), edge = shortest_edge(from_voxel);
    const double view_step = steps.length > 0 ? double{steps.length} : 0.5 * edge;
    const double light_step = steps.light_length > 0 ? double{steps.light_length} : 2 * edge;
    placed.step_length =
        static_cast<float>(std::max(view_step, diagonal / (std::max(steps.samples, 2u) - 1)));
    placed.light_step_length =
        static_cast<float>(std::max(light_step, diagonal / std::max(steps.light_samples, 1u)));

    const bool mirrored = glm::determinant(glm::dmat3(from_voxel)) < 0;
    plan.boxes.push_back(
        {static_cast<std::uint32_t>(plan.volumes.size()), mirrored, is_around_eye(placed, voxel_from_view)});
    plan.volumes.push_back(placed);
    const glm::dvec3 middle = 0.5 * glm::dvec3(instance.bounds_min + instance.bounds_max);
    distances.push_back(glm::length(glm::dvec3(to_view * from_voxel * glm::dvec4(middle, 1))));
  }
  std::ranges::stable_sort(plan.boxes, [&](const RaycastPlan::Box& a, const RaycastPlan::Box& b) {
    return distances[a.volume] > distances[b.volume];
  });
  return plan;
}

}  // namespace brume::planning
