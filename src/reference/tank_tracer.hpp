// Paths of light from the eye into a tank of spheres: docs/how/path-tracer.md.
#pragma once

#include <functional>

#include "reference/path_tracer.hpp"
#include "reference/render.hpp"
#include "reference/tank_model.hpp"
#include "spheres/light_paths.hpp"

namespace brume::reference {

/// What one path from the eye found: an unbiased estimate of the radiance along a ray (in the world, metres)
/// and what stands for its first event. Light that reaches an event through or off the glass is from
/// `photons`, or, where they are null, from scattered rays that meet a light, which never meet a point.
PathSample trace_tank_path(const TankModel& model, const Ray& ray, Sampler& sampler,
                           const spheres::LightPaths* photons = nullptr);

/// The same for a Render; all must outlive it.
Render::Trace tank_trace(const TankModel& model, const spheres::LightPaths* photons = nullptr);

/// What spheres::trace_light_paths reads of a model.
spheres::LightPathScene light_path_scene(const TankModel& model);

}  // namespace brume::reference
