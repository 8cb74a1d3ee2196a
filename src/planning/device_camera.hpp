// The camera of a frame in the form that shaders and culling read.
#pragma once

#include "planning/frame_input.hpp"
#include "scene/scene.hpp"
#include "shared/frame.h"

namespace brume::planning {

constexpr float kNearPlane = 0.05f;  // [m]

/// `camera` for an image of this size. A view straight up or down is valid. The pinhole may be elsewhere on
/// the lens: all of them see the plane that is sharp alike.
shared::Camera device_camera(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample = {},
                             Projection projection = Projection::perspective);

/// Where a camera sees a point: z times its x and y in [-1, 1], y down; z; its distance along the view axis.
glm::mat4 seen_from_world(const shared::Camera& camera);

/// What the picture before a view's frame showed, in coordinates of the frame.
struct PastView {
  glm::mat4 seen_from_world{1};        ///< With jitter.
  glm::mat4 unjittered_from_world{1};  ///< Without it.
  glm::uvec2 size_px{1};
};
PastView past_view(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample,
                   Projection projection);

/// Where all rays of a view meet, in homogeneous coordinates: infinitely far behind a parallel one.
glm::vec4 viewpoint(const View& view);

/// The sample of a frame of a film that is antialiased over its frames: one of eight points of the pixel,
/// the places of multisampling with eight samples (Vulkan, "Standard sample locations"), in turn. Their mean
/// is the middle of the pixel.
constexpr std::uint32_t kFilmSamples = 8;
ViewSample film_sample(std::uint32_t frame_index);

/// Width of a pixel in the middle of the image; one of them is 0.
struct PixelWidth {
  float per_metre = 0;  ///< Growth with the distance [m/m].
  float at_eye = 0;     ///< [m]
  float at(float distance) const { return per_metre * distance + at_eye; }
};
inline PixelWidth pixel_width(const shared::Camera& camera, glm::uvec2 size_px) {
  const float width = 2 * glm::length(camera.up) / static_cast<float>(size_px.y);
  return camera.parallel > 0 ? PixelWidth{0, width} : PixelWidth{width, 0};
}

}  // namespace brume::planning
