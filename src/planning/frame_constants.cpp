#include "planning/frame_constants.hpp"

#include <algorithm>
#include <cmath>

#include "planning/device_camera.hpp"
#include "shared/resolve.h"

namespace brume::planning {
namespace {

/// Each of n samples of a pixel stands for an nth of its area; a frame of an antialiased film for an eighth.
float texture_bias(const ViewSample& sample) {
  constexpr float kLeastBias = -4;
  const bool in_film = sample.count == 1 && sample.pixel != glm::vec2(0);
  const std::uint32_t samples = in_film ? kFilmSamples : sample.count;
  return std::max(-0.5f * std::log2(static_cast<float>(samples)), kLeastBias);
}

}  // namespace

shared::FrameConstants frame_constants(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  shared::FrameConstants frame{};
  frame.camera = plan.camera;
  frame.sky = input.environment.sky;
  frame.look = input.smoke.look;
  frame.look.step_length *= input.quality.step_scale;
  frame.smoke = plan.media.smoke;
  frame.media = plan.media.frame;
  frame.caster_bounds_min = plan.visibility.caster_bounds.low;
  frame.caster_bounds_max = plan.visibility.caster_bounds.high;
  frame.size_px = plan.size_px;
  frame.light_count = static_cast<std::uint32_t>(plan.lights.size());
  frame.holes = plan.holes.layout();
  frame.frame_index = input.view.frame_index;
  frame.time = input.smoke.time;
  frame.pixel_width = pixel_width(plan.camera, plan.size_px).at(1);
  frame.exposure = input.view.exposure;
  frame.tone = static_cast<std::uint32_t>(input.view.tone);
  frame.texture_bias = texture_bias(input.view.sample);
  frame.resolve_error = shared::kResolveError * input.quality.resolve_error_scale;
  return frame;
}

}  // namespace brume::planning
