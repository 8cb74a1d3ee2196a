// How bright what lies behind media may be: FrameMedia::opaque_transmittance follows from it.
#pragma once

#include <span>

#include "planning/media_plan.hpp"

namespace brume::planning {

/// The largest component of the radiance that may lie behind media: the sky, what glows in volumes in view,
/// and paint that faces a directional light. Without surfaces that emit (PlanTarget::brightest_surface), without
/// stars, which are points, and without what point lights and spots light: the smoke before it is about as
/// bright.
float brightest_behind(const FrameInput& input, const MediaPlan& media,
                       std::span<const shared::Light> lights);

}  // namespace brume::planning
