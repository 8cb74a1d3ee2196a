#include "planning/device_camera.hpp"

#include <cmath>

namespace brume::planning {
namespace {

/// Half of a picture 1 m in front of the eye, or of a parallel one: its size, and where its middle is, in
/// such halves.
struct HalfPicture {
  glm::vec2 tangents, middle;
};

/// Nearer to the direction up than this a view has no horizon in floats [rad].
constexpr float kLeastTilt = 1e-3f;

HalfPicture half_picture(const scene::Camera& camera, glm::uvec2 size_px) {
  if (!camera.frustum) {
    const float tan_y = std::tan(0.5f * camera.vertical_fov);
    return {{tan_y * static_cast<float>(size_px.x) / static_cast<float>(size_px.y), tan_y}, {0, 0}};
  }
  const glm::vec2 low(camera.frustum->left, camera.frustum->down),
      high(camera.frustum->right, camera.frustum->up), tangents = 0.5f * (high - low);
  return {tangents, 0.5f * (high + low) / tangents};
}

}  // namespace

shared::Camera device_camera(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample,
                             Projection projection) {
  // Axes of the view: forward, right, up.
  const glm::vec3 apart = camera.target_world - camera.position_world;
  const glm::vec3 forward = glm::length(apart) > 1e-6f ? glm::normalize(apart) : glm::vec3(0, 0, -1);
  const bool is_along_up = glm::length(glm::cross(forward, camera.up_world)) < kLeastTilt;
  const glm::vec3 other = std::abs(forward.z) > 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
  const glm::vec3 helper = is_along_up ? other : camera.up_world;
  const glm::vec3 right = glm::normalize(glm::cross(forward, helper)), up = glm::cross(right, forward);
  const HalfPicture half = half_picture(camera, size_px);
  const float tan_x = half.tangents.x, tan_y = half.tangents.y;

  // The point of the lens, and how far rays lean back from there to the same point of what is sharp.
  const glm::vec2 on_lens = camera.lens.aperture * sample.lens;
  const glm::vec3 p = camera.position_world + on_lens.x * right + on_lens.y * up;
  const glm::vec2 shift = half.middle +
                          2.0f * glm::vec2(sample.pixel.x, -sample.pixel.y) / glm::vec2(size_px) -
                          on_lens / (focus_distance(camera) * half.tangents);

  // Reverse depth, infinite far plane; Vulkan's y runs down.
  glm::mat4 rows(0);
  const bool parallel = projection == Projection::parallel;
  rows[3] = parallel ? glm::vec4(0, 0, 0, 1) : glm::vec4(forward, -glm::dot(forward, p));
  rows[2] = glm::vec4(0, 0, 0, kNearPlane);
  rows[1] = glm::vec4(-up, glm::dot(up, p)) / tan_y + shift.y * rows[3];
  rows[0] = glm::vec4(right, -glm::dot(right, p)) / tan_x - shift.x * rows[3];
  shared::Camera result{};
  result.clip_from_world = glm::transpose(rows);
  result.eye_world = p;
  result.near_z = kNearPlane;
  result.forward = forward;
  result.parallel = parallel ? 1.0f : 0.0f;
  result.right = tan_x * right;
  result.up = tan_y * up;
  result.shift = shift;
  return result;
}

glm::mat4 seen_from_world(const shared::Camera& camera) {
  glm::mat4 rows = glm::transpose(camera.clip_from_world);
  rows[2] = rows[3];
  if (camera.parallel > 0) rows[3] = glm::vec4(camera.forward, -glm::dot(camera.forward, camera.eye_world));
  return glm::transpose(rows);
}

PastView past_view(const scene::Camera& camera, glm::uvec2 size_px, const ViewSample& sample,
                   Projection projection) {
  return {seen_from_world(device_camera(camera, size_px, sample, projection)),
          seen_from_world(device_camera(camera, size_px, {}, projection)), size_px};
}

glm::vec4 viewpoint(const View& view) {
  const scene::Camera& camera = view.camera;
  if (view.projection == Projection::perspective) return {camera.position_world, 1};
  return {camera.position_world - camera.target_world, 0};
}

ViewSample film_sample(std::uint32_t frame_index) {
  constexpr glm::ivec2 kSixteenths[kFilmSamples] = {{1, -3}, {-1, 3},  {5, 1}, {-3, -5},
                                                    {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
  return {glm::vec2(kSixteenths[frame_index % kFilmSamples]) / 16.0f};
}

}  // namespace brume::planning
