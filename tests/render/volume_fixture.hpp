// What tests of volumes on the device share: small volumes, a floor far below, and reading the media.
#pragma once

#include <glm/gtc/packing.hpp>

#include "film/playback.hpp"
#include "tests/frame_builder.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {

/// Bricks whose texels, aprons included, hold a function of their centres: filtering is exact where it is
/// linear.
template <typename Texel, typename Function>
volume::SparseVolume field(glm::ivec3 bricks, Function value_at) {
  volume::SparseVolume volume({{}, 1, {{sizeof(Texel)}}});
  volume.begin_update();
  for_each_in(Box<int>{glm::ivec3(0), bricks}, [&](glm::ivec3 brick) {
    std::size_t i = 0;
    for (Texel& texel : volume.texels<Texel>(volume::ChannelId{0}, volume.acquire(brick))) {
      const glm::ivec3 local(i % 10, i / 10 % 10, i / 100);
      texel = value_at(glm::vec3(8 * brick + local) - 0.5f);
      ++i;
    }
  });
  volume.set_bounds(glm::vec3(0), glm::vec3(8 * bricks));
  volume.end_update();
  return volume;
}

template <typename Function>
volume::SparseVolume values(glm::ivec3 bricks, Function value_at) {
  return field<std::uint16_t>(bricks, [&](glm::vec3 p) { return glm::packHalf1x16(value_at(p)); });
}

/// One value throughout: a solid block of 8 voxels a brick from the origin on.
inline volume::SparseVolume block(glm::ivec3 bricks, float value = 1) {
  return values(bricks, [&](glm::vec3) { return value; });
}

class VolumeFixture : public gpu::GpuTest {
 protected:
  static scene::Scene far_floor() { return scene_of({{{-40, -31, -40}, {40, -30, 40}}}, {}, 0); }
  /// Premultiplied radiance and transmittance of each pixel that a renderer drew.
  std::vector<glm::vec4> media_of(const Renderer& renderer) const {
    return passes::from_half(read_back<passes::Half4>(renderer.media()));
  }

  VolumeFixture() {
    input_.smoke.look.swirl_width = 1;
    input_.smoke.look.noise_frequency = 1;
  }
  FrameInput input_;
};

/// Frames of one renderer for all tests of `Own`, which has kSize: compiling its pipelines takes longer than
/// most tests.
template <typename Own>
class VolumePictures : public VolumeFixture {
 protected:
  static Renderer& renderer() {
    static Renderer instance(context(), runner(), Own::scene(), RendererOptions{Own::kSize});
    return instance;
  }
  static scene::Scene scene() { return far_floor(); }
  std::vector<glm::vec4> draw() {
    renderer().draw(input_);
    return media_of(renderer());
  }
};

/// A cloud that has come to rest in a level, and a frame that shows it.
struct RestingSmoke : SmokeWorld {
  RestingSmoke(const voxel::BitGrid& level, const std::vector<voxel::Triangle>& triangles,
               glm::dvec3 position, std::uint32_t voxels)
      : SmokeWorld(level, triangles) {
    append(lasting_smoke_at(position, voxels));
    advance_to(300);
  }
  void show_in(FrameInput& input) const {
    input.smoke.volume = &volume;
    input.smoke.state = &world.state();
    input.smoke.look.step_length = 0.2f;
    input.level.voxels.grid = &grid;
  }
};

}  // namespace brume::render
