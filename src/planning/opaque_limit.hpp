// How bright what lies behind media may be: FrameMedia::opaque_transmittance follows from it.
#pragma once

#include <span>

#include "planning/media_plan.hpp"
#include "planning/view_frustum.hpp"

namespace brume::planning {

/// A surface of the scene that emits.
struct Emitter {
  WorldSphere bounds;  ///< Where it is unless it moves.
  std::uint32_t object = 0;
  float radiance = 0;  ///< Its largest component [W/(sr m^2)].
};

/// The largest component of the radiance that may lie behind media: of surfaces in view that emit, the sky,
/// what glows in volumes in view, and paint that faces a directional light. Without stars, which are points,
/// and without what point lights and spots light: the smoke before it is about as bright.
float brightest_behind(const FrameInput& input, const ViewFrustum& frustum, std::span<const Emitter> emitters,
                       const MediaPlan& media, std::span<const shared::Light> lights);

}  // namespace brume::planning
