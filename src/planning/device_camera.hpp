// The camera of a frame in the form that shaders and culling read.
#pragma once

#include "planning/frame_input.hpp"
#include "scene/scene.hpp"
#include "shared/frame.h"

namespace brume::planning {

constexpr float kNearPlane = 0.05f;  // [m]

/// `camera` for an image of this size. A view straight up or down is valid. The pinhole may be elsewhere on
/// the lens: all of them see the plane that is sharp alike.
shared::Camera device_camera(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample = {});

/// What the picture before a view's frame showed, in coordinates of the frame.
struct PastView {
  glm::mat4 clip_from_world{1};        ///< Camera::clip_from_world, with jitter.
  glm::mat4 unjittered_from_world{1};  ///< The same without jitter.
  glm::uvec2 size_px{1};
};
PastView past_view(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample);

/// The sample of a frame of a film that is antialiased over its frames: one of eight points of the pixel,
/// the places of multisampling with eight samples (Vulkan, "Standard sample locations"), in turn. Their mean
/// is the middle of the pixel.
constexpr std::uint32_t kFilmSamples = 8;
ViewSample film_sample(std::uint32_t frame_index);

/// Width of a pixel at a distance of 1 m, in the middle of the image [m].
inline float pixel_width(const shared::Camera& camera, glm::uvec2 size_px) {
  return 2 * glm::length(camera.up) / static_cast<float>(size_px.y);
}

}  // namespace brume::planning
