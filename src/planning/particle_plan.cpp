#include "planning/particle_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"

namespace brume::planning {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::bad_input, message);
}

float fraction_of_turn(double turns) {
  const auto fraction = static_cast<float>(turns - std::floor(turns));
  return fraction < 1 ? fraction : 0.0f;
}

void check_particles(const ParticleInput& input) {
  if (input.count < 1 || input.count > shared::kMaxParticles)
    refuse("a volume of " + std::to_string(input.count) + " particles; expected 1 to " +
           std::to_string(shared::kMaxParticles));
  if (!(input.radius > 0) || !std::isfinite(input.radius))
    refuse("particles with a radius of " + std::to_string(input.radius) + "; give one above 0");
}

/// Around all centres and quads.
WorldSphere bounds_of(const shared::ParticleSystem& system) {
  const glm::mat4x3 world_from_uvw = matrix_of(system.world_from_uvw);
  WorldSphere sphere{world_from_uvw * glm::vec4(0.5f, 0.5f, 0.5f, 1), 0};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::vec3 away = world_from_uvw * glm::vec4(side * (0.5f + system.margin), 0);
    sphere.radius = std::max(sphere.radius, glm::length(away));
  }
  return sphere;
}

}  // namespace

shared::ParticleSystem particle_system(const ParticleInput& input, const shared::SliceTexture& slices) {
  check_particles(input);
  const glm::dmat4 world_from_uvw(input.world_from_uvw), inverse = glm::inverse(world_from_uvw);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(inverse[column][row]))
        refuse("the transform of a volume of particles has no inverse; give each axis a length");

  // The box, and the region of the centres around it: a step of one metre changes a coordinate of the box by
  // at most the length of its row.
  glm::dvec3 edges, margin;
  for (int axis = 0; axis < 3; ++axis) edges[axis] = glm::length(glm::dvec3(world_from_uvw[axis]));
  const double shortest = std::min({edges.x, edges.y, edges.z});
  const double radius = double{input.radius} * shortest;
  for (int axis = 0; axis < 3; ++axis)
    margin[axis] = radius * glm::length(glm::dvec3(inverse[0][axis], inverse[1][axis], inverse[2][axis]));
  const glm::dvec3 region = 1.0 + 2.0 * margin;
  const double volume =
      std::abs(glm::determinant(glm::dmat3(world_from_uvw))) * region.x * region.y * region.z;

  shared::ParticleSystem system{};
  system.world_from_uvw = shared::affine_of(glm::mat4x3(input.world_from_uvw));
  system.uvw_from_world = shared::affine_of(glm::mat4x3(glm::mat4(inverse)));
  system.slices = slices;
  const auto& tints = input.tints;
  system.tints = shared::affine_of(glm::mat4x3(tints[0], tints[1], tints[2], tints[3]));
  system.margin = glm::vec3(margin);
  system.radius = static_cast<float>(radius);
  system.weight = static_cast<float>(volume / (input.count * std::numbers::pi * radius * radius / 3));
  system.extinction = input.extinction;
  system.softness = input.softness;
  system.drift = fraction_of_turn(double{input.drift} * input.time / region.z);
  const glm::dvec2 swirl = double{input.swirl} * shortest / (glm::dvec2(edges) * glm::dvec2(region));
  system.swirl = glm::vec2(swirl);
  system.swirl_turns = fraction_of_turn(input.time / input.swirl_seconds);
  system.seed = input.seed;
  system.count = input.count;
  return system;
}

std::vector<shared::ParticleSystem> plan_particles(std::span<const ParticleInput> inputs,
                                                   std::span<const shared::SliceTexture> slices,
                                                   const ViewFrustum& frustum) {
  if (inputs.size() > shared::kMaxParticleSystems)
    refuse("a frame of " + std::to_string(inputs.size()) + " volumes of particles; at most " +
           std::to_string(shared::kMaxParticleSystems));
  std::vector<shared::ParticleSystem> systems;
  std::uint32_t first = 0;
  for (const ParticleInput& input : inputs) {
    if (input.slices >= slices.size())
      refuse("particles of volume " + std::to_string(input.slices) + " of " + std::to_string(slices.size()) +
             "; give the renderer its slices first");
    shared::ParticleSystem system = particle_system(input, slices[input.slices]);
    if (!frustum.may_intersect(bounds_of(system))) continue;
    system.first = first;
    first += system.count;
    systems.push_back(system);
  }
  return systems;
}

}  // namespace brume::planning
