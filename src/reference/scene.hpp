// Everything that light meets, as the path tracer reads it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "planning/frame_input.hpp"
#include "reference/media.hpp"
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/sky_light.h"
#include "smoke/mask_atlas.hpp"
#include "smoke/noise_tile.hpp"
#include "surfaces/surfaces.hpp"

namespace brume::reference {

using surfaces::Surfaces;

/// Light that surrounds all: of what rays from the eye see, and of what scattered rays see.
struct Environment {
  shared::Sky sky{};
  /// The ambient light from a direction, relative to Sky::ambient: x + y direction.y.
  glm::vec2 shape{shared::sky_shape(0), shared::sky_shape(1) - shared::sky_shape(0)};
  /// Radiance towards the eye from a direction: gradient and stars.
  glm::vec3 seen(const glm::vec3& direction) const;
  /// Radiance that lights surfaces and media: shared::sky_shape of the ambient light.
  glm::vec3 lighting(const glm::vec3& direction) const;
};

/// Light of a source without extent at a point, before anything that hides it.
struct Incident {
  glm::vec3 irradiance{0};  ///< On a surface that faces the light.
  glm::vec3 to_light{0};    ///< Unit.
  float distance = 0;       ///< [m]; infinite for the sun.
};
/// Closer than this to a point or spot light, its irradiance is what it is there [m].
constexpr float kConstantWithin = 0.1f;

/// The inverse square law from kConstantWithin on, and the cone of a spot (shared/spot.h):
/// shaders/lib/lights.glsl without its window, which cuts lights off at their range.
Incident light_at(const shared::Light& light, const glm::vec3& p_world);

/// A point or spot light with media nearby, for NearChords and LightPath.
struct NearLight {
  std::uint32_t light = 0;  ///< Index into Scene::lights.
  float solid_angle = 0;    ///< How wide it shines [sr].
};

struct Scene {
  Surfaces surfaces;
  Media media;
  std::vector<shared::Light> lights;
  Environment environment;
  /// Sum over the emitters before and with each one, and over all: largest component of radiance times area.
  std::vector<float> power_up_to = {};
  float emitted_power = 0;
  /// Lights with media up to this distance of them are near lights, and as far the eye's rays are sampled for
  /// their sake [m]. A matter of noise alone, which hardly differs from 0.25 to 2 m.
  float near = 1;
  std::vector<NearLight> near_lights = {};
};

/// Fills power_up_to and emitted_power.
void sum_emitters(Scene& scene);
/// Fills near_lights. Lights that are missing there are as bright, with more noise.
void find_near_lights(Scene& scene);

/// What a frame shows, without what stands in for light that paths find themselves: FrameInput's glow, decals
/// and particles, and Sky::bounce. `later`: the same at further equal steps while the shutter is open, at
/// most kMostSteps - 1, of which where objects and volumes are counts; empty: all rests. `scene`, the masks
/// and what the frame points to must outlive it. `matte`: see Surfaces. Throws resource_limit.
std::unique_ptr<Scene> make_scene(const scene::Scene& scene, const planning::FrameInput& frame,
                                  const smoke::MaskAtlas* masks, bool matte = false,
                                  std::span<const planning::FrameInput> later = {});

}  // namespace brume::reference
