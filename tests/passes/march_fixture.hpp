// What tests of passes that march smoke share: a room full of it, noise, and a frame's constants.
#pragma once

#include "passes/blue_noise.hpp"
#include "passes/march.hpp"
#include "tests/passes/half.hpp"
#include "tests/passes/smoke_alone.hpp"
#include "tests/passes/smoke_room.hpp"

namespace brume::passes {

class MarchFixture : public gpu::GpuTest {
 protected:
  MarchFixture() {
    const NoisePass noise(context());
    runner().run([&](gpu::Recorder& recorder) {
      noise.record(recorder, noise_tile_, {8, 2, 1});
      blue_noise_ = make_blue_noise(context(), recorder);
    });
  }
  /// A grid without walls, full of smoke: a box of constant density. One for all tests.
  static const SmokeRoom& full_room() {
    static const SmokeRoom kRoom(context(), runner(), {}, {{24, 17, 33}, 0.5f, {-6, -4, -16}}, {0, 0, -1},
                                 1u << 22, 4000);
    return kRoom;
  }
  /// A camera at `eye` that looks along -z. `half`: of the image 1 m in front of it [m].
  static shared::FrameConstants frame_at(const SmokeRoom& room, glm::vec3 eye, glm::vec2 half,
                                         glm::uvec2 size_px) {
    shared::FrameConstants frame{};
    frame.camera.eye_world = eye;
    frame.camera.near_z = 0.05f;
    frame.camera.forward = {0, 0, -1};
    frame.camera.right = {half.x, 0, 0};
    frame.camera.up = {0, half.y, 0};
    frame.smoke = room.volume.layout();
    frame.size_px = size_px;
    frame.look.albedo = glm::vec3(1);
    frame.look.extinction = 0.7f;
    frame.look.step_length = 0.1f;
    frame.look.noise_frequency = 1;
    return frame;
  }
  /// What a march of smoke alone reads.
  MarchPass::Inputs inputs(const gpu::Buffer& frame, const SmokeRoom& room, const gpu::Image& depth,
                           const HoleClusters& holes) const {
    const SmokeResources& smoke = room.upload.resources();
    return {frame,
            smoke_alone(smoke, holes, volumes_),
            no_light(smoke, volumes_),
            noise_tile_,
            noise_tile_,
            depth,
            blue_noise_,
            glm::uvec2(depth.info().size)};
  }
  /// Light of one colour in all of a room's smoke.
  static void light_evenly(gpu::Recorder& recorder, const SmokeRoom& room) {
    recorder.clear(room.upload.resources().inscatter, {{0.5f, 0.25f, 1.0f, 1.0f}});
  }

  gpu::Image noise_tile_ = make_noise_tile(context(), 8), blue_noise_;
  VolumeUpload volumes_{context()};
};

}  // namespace brume::passes
