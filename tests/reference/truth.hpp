// Reference renderer for lit smoke: single scattering by definition, in double precision, in many small
// steps. Stores nothing on a grid: every step of every camera ray traces a ray to every light, through the
// triangles of the scene, the holes and the smoke.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "shared/frame.h"
#include "shared/hole.h"
#include "shared/light.h"
#include "smoke/smoke_volume.hpp"

namespace brume::reference {

/// The noise tile read back from the device: RGBA of 8 bits, size^3 texels.
struct NoiseTile {
  std::uint32_t size = 0;
  std::vector<glm::u8vec4> texels;
};

/// The noise displacement read back from the device: xyz of the texels of all bricks [m], laid out as the
/// density.
struct NoiseAdvectionField {
  glm::ivec3 size{0};  ///< Texels per axis.
  std::vector<glm::vec3> texels;
};

/// A world-space triangle with its material.
struct TruthTriangle {
  glm::dvec3 a, b, c;
  glm::dvec3 albedo, emission;
  double roughness = 1;
};

/// The triangles of a scene without textures; does not support metals.
std::vector<TruthTriangle> truth_triangles(const scene::Scene& scene);

struct TruthScene {
  shared::Camera camera{};
  glm::uvec2 size_px{0};
  shared::SmokeLook look{};  ///< Its step_length, stop and multiple_scattering are ignored.
  double time = 0;           ///< [s]
  const smoke::SmokeVolume* volume = nullptr;
  std::span<const shared::Hole> holes;  ///< Without masks.
  std::span<const shared::Light> lights;
  std::span<const TruthTriangle> triangles;
  const NoiseTile* noise = nullptr;                   ///< Required if look.erosion or look.hole_rim is not 0.
  const NoiseTile* detail = nullptr;                  ///< Of the noise; null: it has none.
  const NoiseAdvectionField* displacement = nullptr;  ///< Null: no noise displacement.
  double view_step = 0.2;                             ///< Of the rays of the pixels [voxels].
  double light_step = 0.4;                            ///< Of the rays to the lights [voxels].
};

/// The result at the centre of a pixel.
struct TruthPixel {
  glm::dvec3 smoke{0};       ///< In-scattered radiance that reaches the eye.
  double transmittance = 1;  ///< Of the smoke in front of the surface.
  glm::dvec3 surface{0};     ///< Radiance of the surface behind, lit through the smoke.
  glm::dvec3 radiance() const { return smoke + transmittance * surface; }
};

/// Rows from the top. No ambient light, black sky. On all threads.
std::vector<TruthPixel> trace_truth(const TruthScene& scene);

/// Density at a point after noise and holes.
double truth_density(const TruthScene& scene, glm::dvec3 p_world);

}  // namespace brume::reference
