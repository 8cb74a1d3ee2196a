// Volumes by formula, and both forms of raycasting, for tests.
#pragma once

#include <optional>

#include "passes/raycast.hpp"
#include "planning/device_camera.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {

using volume::SparseVolume;

/// Of a voxel's density by its index; bricks with `has` only, and aprons that continue it.
template <typename Has, typename Density>
SparseVolume make_volume(glm::ivec3 bricks, Has has, Density density) {
  SparseVolume volume({{}, 1, {{sizeof(std::uint16_t)}}});
  volume.begin_update();
  for_each_in(Box<int>{glm::ivec3(0), bricks}, [&](glm::ivec3 brick) {
    if (!has(brick)) return;
    auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, volume.acquire(brick));
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(10)}, [&](glm::ivec3 t) {
      texels[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))] =
          glm::packHalf1x16(density(8 * brick + t - 1));
    });
  });
  volume.set_bounds(glm::vec3(0), glm::vec3(8 * bricks));
  volume.end_update();
  return volume;
}

/// A volume in the world, seen by a camera.
struct Placed {
  const SparseVolume* volume;
  glm::mat4 world_from_voxel{1};
  shared::VolumeLook look{glm::vec3(0.8f), 1, glm::vec3(0), 0, 0};
};

/// Draws volumes in both forms.
class RaycastFixture : public gpu::GpuTest {
 protected:
  explicit RaycastFixture(glm::uvec2 size_px) : size_(size_px) {
    light_.to_sun = glm::normalize(glm::vec3(0.4f, 0.8f, 0.3f));
    light_.sun_irradiance = glm::vec3(6, 5, 4);
    light_.ambient = glm::vec3(0.1f, 0.15f, 0.2f);
    light_.phase = shared::phase_of_hg(0.3f);
    depth_ = depth_image(std::vector(size_.x * size_.y, 0.0f));
  }

  gpu::Image depth_image(const std::vector<float>& depth) {
    return upload_image(context(), runner(), size_, VK_FORMAT_R32_SFLOAT, depth);
  }
  RaycastPass& pass(RaycastForm form) {
    std::optional<RaycastPass>& pass = form == RaycastForm::two_pass ? two_pass_ : single_pass_;
    if (!pass) pass.emplace(context(), form, size_);
    return *pass;
  }
  shared::Camera device_camera() const { return planning::device_camera(camera_, size_, sample_); }

  /// Instances of the volumes, without their bricks.
  static std::vector<planning::PlacedVolume> visible(const std::vector<Placed>& placed) {
    std::vector<planning::PlacedVolume> visible;
    for (const Placed& one : placed) {
      shared::VolumeInstance instance{};
      instance.voxel_from_world =
          shared::affine_of(glm::mat4x3(glm::mat4(glm::inverse(glm::dmat4(one.world_from_voxel)))));
      instance.bounds_min = one.volume->layout().bounds_min;
      instance.bounds_max = one.volume->layout().bounds_max;
      instance.look = one.look;
      visible.push_back({visible.size(), {}, instance});
      visible.back().grids.volume = one.volume;
    }
    return visible;
  }

  /// Premultiplied radiance and transmittance of each pixel.
  std::vector<glm::vec4> draw(RaycastForm form, const std::vector<Placed>& placed) {
    std::vector<planning::VolumeInput> inputs;
    for (const Placed& one : placed) inputs.push_back({one.volume, one.world_from_voxel, one.look, {}});
    const auto in_view = visible(placed);
    upload_.reserve(inputs);
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    info.size = {size_, 1};
    info.usage = kRaycastTargetUsage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const gpu::Image target(context(), info);
    runner().run([&](gpu::Recorder& recorder) {
      upload_.record(recorder, inputs, {}, in_view, in_view);
      pass(form).record(recorder, {upload_.resources(), depth_},
                        planning::plan_raycast(device_camera(), size_, in_view, light_, steps_), target);
    });
    return from_half(read_back<Half4>(target));
  }

  const glm::uvec2 size_;
  scene::Camera camera_{{0, 0, 6}, {0, 0, 0}, 0.9f};
  planning::ViewSample sample_;
  planning::RaycastLight light_;
  planning::RaycastSteps steps_;
  gpu::Image depth_;  ///< Of the scene; none at first.

 private:
  std::optional<RaycastPass> two_pass_, single_pass_;
  VolumeUpload upload_{context()};
};

}  // namespace brume::passes
