// The shadow maps that an engine has of its own lights: distances to the nearest triangle, by rays.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "tests/textures/gl_engine.hpp"
#include "voxel/triangle.hpp"

namespace brume::textures {

/// Six faces for each light, of suns the first alone: `shadows` of kShadowLookup.
FloatMap shadow_maps(const std::vector<scene::Light>& lights, const std::vector<voxel::Triangle>& triangles);

/// GLSL: `float shadow(int light, bool sun, vec3 from_light)`, how much of a light arrives. `from_light`: the
/// vector from the light to the point; for a sun the point itself, whose map has the axes sun_right, sun_up,
/// and the sun's direction.
extern const std::string kShadowLookup;
/// The unit vectors across a sun's direction.
glm::vec3 sun_right(glm::vec3 direction);

}  // namespace brume::textures
