// A small world with smoke in it, on the CPU and on the device.
#pragma once

#include "passes/noise.hpp"
#include "passes/noise_advection.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/worlds.hpp"

namespace brume::passes {

struct SmokeRoom : SmokeWorld {
  SmokeUpload upload;

  /// Floods the grid with `voxels` of smoke from `source_world` and shows it `tick` ticks later.
  SmokeRoom(gpu::Context& context, gpu::CommandRunner& runner, const std::vector<voxel::Triangle>& walls,
            const voxel::GridLayout& layout, glm::dvec3 source_world, std::uint32_t voxels,
            std::uint32_t tick)
      : SmokeWorld(walls, layout), upload(context) {
    sim::ThrowSmoke thrown = smoke_at(source_world, voxels);
    thrown.smoke.hold_ticks = tick;  // still there
    append(thrown);
    advance_to(tick);
    upload.reserve(volume);
    runner.run([&](gpu::Recorder& recorder) {
      upload.record(recorder, volume);
      upload.record_visibility(recorder, planning::all_smoke_visible(volume));
    });
    make_still_medium(context, runner);
  }

 private:
  /// The medium of smoke that no noise eats from.
  void make_still_medium(gpu::Context& context, gpu::CommandRunner& runner) {
    shared::FrameConstants constants{};
    constants.smoke = volume.layout();
    constants.look.swirl_width = 1;
    const gpu::Buffer layout(context, sizeof constants,
                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const gpu::Image noise = make_noise_tile(context, 8);
    const NoisePass noise_pass(context);
    NoiseAdvectionPass advection(context);
    const planning::NoisePlan still;
    advection.reserve({}, volume, still);
    runner.run([&](gpu::Recorder& recorder) {
      recorder.upload(layout, 0, std::as_bytes(std::span(&constants, 1)));
      noise_pass.record(recorder, noise, {8, 2, 1});
      advection.upload(recorder, still);
      advection.record(recorder, still, {layout, upload.resources(), noise});
    });
  }
};

/// Two triangles between four corners in order.
inline void add_quad(std::vector<voxel::Triangle>& out, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  out.push_back({a, b, c});
  out.push_back({a, c, d});
}

}  // namespace brume::passes
