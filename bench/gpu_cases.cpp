#include <algorithm>
#include <cstring>
#include <map>

#include "bench/bench.hpp"
#include "render/playback.hpp"

namespace brume::bench {
namespace {

constexpr glm::uvec2 k1080p{1920, 1080};

/// One grown smoke of 1,800 voxels of half a metre in the yard of the demo scene, seen from 6 m away: it
/// fills the view.
Result<stage::Stage> smoke_in_the_yard() {
  auto timeline = scene::load_timeline(BRUME_SCENES_DIR "/demo.toml");
  if (!timeline) return timeline.failure();
  timeline->grid = {0.5f, glm::ivec3(57, 19, 57), glm::vec3(-14.1f, -0.35f, -12.1f)};
  timeline->smoke.voxels = 1800;
  timeline->smoke.bloom = 1;
  timeline->smokes = {{0, {0, 3, 7}, {0, 0.3f, 6}}};
  timeline->shots.clear();
  timeline->camera = {{0, {{0, 1.8f, 12}, {0, 2.2f, 6}, 1.0472f}}};
  return stage::make_stage(std::move(*timeline), {});
}

/// A frame that can be drawn again and again.
class RepeatedFrame {
 public:
  RepeatedFrame(gpu::Context& context, const stage::Stage& stage, glm::uvec2 size, bool count_samples)
      : simulation_(stage::Simulation::create(stage).value_or_throw()),
        runner_(context),
        renderer_(context, runner_, stage.scene, {size, count_samples}),
        counter_(context, sizeof(std::uint32_t), VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::readback) {
    simulation_->advance_to(kGrown);
    input_ = render::frame_input(stage, *simulation_, kGrown, holes_);
    input_.force_light = true;
  }

  /// GPU milliseconds of each pass.
  std::map<std::string, double> draw() {
    ++input_.frame_index;
    renderer_.prepare(input_);
    runner_.run([&](gpu::Recorder& recorder) {
      renderer_.record_frame(recorder, input_);
      recorder.read_back(renderer_.sample_counter(), counter_, sizeof(std::uint32_t));
    });
    std::map<std::string, double> passes;
    for (const auto& scope : runner_.timings()) passes[scope.name] = scope.milliseconds;
    return passes;
  }
  std::uint32_t texture_samples() const {
    std::uint32_t count = 0;
    std::memcpy(&count, counter_.mapped(), sizeof count);
    return count;
  }

 private:
  static constexpr double kGrown = 4;  // [s]
  std::unique_ptr<stage::Simulation> simulation_;
  gpu::CommandRunner runner_;
  render::Renderer renderer_;
  gpu::Buffer counter_;
  std::vector<shared::Hole> holes_;
  render::FrameInput input_;
};

/// Texture samples that the march takes for a frame.
double count_texture_samples(gpu::Context& context, const stage::Stage& stage) {
  RepeatedFrame frame(context, stage, k1080p, true);
  frame.draw();
  return frame.texture_samples();
}

Result<std::vector<Measurement>> frames(Bench& bench, bool march_only) {
  const auto stage = smoke_in_the_yard();
  if (!stage) return stage.failure();
  gpu::Context& context = bench.context();
  const bool slow = context.info().kind == "cpu";
  const unsigned count = bench.repetitions(slow ? 5 : 200);
  RepeatedFrame frame(context, *stage, k1080p, false);
  for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame.draw();

  std::map<std::string, std::vector<double>> passes;
  std::vector<double> sums;
  for (unsigned i = 0; i < count; ++i) {
    double sum = 0;
    for (const auto& [name, milliseconds] : frame.draw()) {
      passes[name].push_back(milliseconds);
      if (name != "gbuffer") sum += milliseconds;
    }
    sums.push_back(sum);
  }
  if (march_only) {
    auto m = summarize("march/1080p", "ms", "gpu", passes["march"]);
    const double samples = count_texture_samples(context, *stage);
    m.details = {{"texture_samples", samples}, {"gsamples_per_second", samples / m.median * 1e-6}};
    return std::vector{m};
  }
  auto m = summarize("frame/1080p", "ms", "gpu", sums);
  for (const auto& [name, values] : passes)
    m.details[name + "_ms"] = summarize(name, "ms", "gpu", values).median;
  return std::vector{m};
}

}  // namespace

std::vector<Case> gpu_cases() {
  return {
      {"march/1080p", "the march through one grown smoke that fills the view",
       [](Bench& b) { return frames(b, true); }},
      {"frame/1080p", "all passes of that frame but the raster", [](Bench& b) { return frames(b, false); }},
  };
}

}  // namespace brume::bench
