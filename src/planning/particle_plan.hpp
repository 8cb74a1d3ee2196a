// Volumes that a frame displays by particles (shared/particles.h, docs/guides/volume-textures.md).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "planning/view_frustum.hpp"
#include "shared/particles.h"

namespace brume::planning {

/// A volume as the quads of particles. Everything in a frame follows from this and the camera: no particle
/// depends on frames before.
struct ParticleInput {
  glm::mat4 world_from_uvw{1};       ///< Affine, with an inverse; the volume's box is [0, 1]^3.
  std::uint32_t slices = 0;          ///< Its place among the renderer's SliceTextures.
  std::array<glm::vec3, 4> tints{};  ///< By channel, linear radiance per metre where it is 1; >= 0.
  float extinction = 0;              ///< Where the largest channel is 1 [1/m]; >= 0, 0: emission only.
  std::uint32_t count = 400;         ///< Particles, [1, shared::kMaxParticles].
  float radius = 0.6f;               ///< Where a quad ends, in shortest edges of the box; > 0.
  std::uint32_t seed = 0;
  double time = 0;           ///< [s]
  float drift = 0;           ///< Edges of the box that particles move along its z axis in a second.
  float swirl = 0.05f;       ///< Radius of their swirl, a fraction of the box's shortest edge; >= 0.
  double swirl_seconds = 4;  ///< Time of a turn of the swirl [s]; > 0.
  float softness = 0;        ///< Distance over which quads fade before surfaces and from the eye [m]; >= 0.
  std::size_t index = 0;     ///< Among the volumes of the timeline.
};

/// What shaders read of a system, whose particles are the first ones of all. Throws bad_input for a transform
/// without an inverse and for a count or a radius out of range.
shared::ParticleSystem particle_system(const ParticleInput& input, const shared::SliceTexture& slices);

/// The systems of a frame that may be in view, in their order, with the places of their particles. Throws
/// bad_input as particle_system, for a volume that `slices` lacks, and for more than
/// shared::kMaxParticleSystems systems.
std::vector<shared::ParticleSystem> plan_particles(std::span<const ParticleInput> inputs,
                                                   std::span<const shared::SliceTexture> slices,
                                                   const ViewFrustum& frustum);

}  // namespace brume::planning
