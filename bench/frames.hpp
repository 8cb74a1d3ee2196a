// Renders one frame of a scenario repeatedly and measures each of its passes.
#pragma once

#include <functional>

#include "bench/bench.hpp"
#include "film/playback.hpp"

namespace brume::bench {

/// Cost of rendering one frame [ms].
struct FrameCost {
  std::map<std::string, double> passes;    ///< GPU time by pass.
  double prepare_cpu = 0, record_cpu = 0;  ///< CPU time of this thread in Renderer::prepare and record_frame.
};

/// The frame at `seconds` of a scenario. Each draw recomputes all light in its smoke unless input() changes
/// that.
class RepeatedFrame {
 public:
  /// `scenario` must outlive this object.
  RepeatedFrame(gpu::Context& context, const scenario::Scenario& scenario,
                const render::RendererOptions& options, double seconds);

  FrameCost draw();
  /// The input of the next draw, for cases that change it between draws.
  render::FrameInput& input() { return input_; }
  const render::Renderer& renderer() const { return renderer_; }
  render::Renderer& renderer() { return renderer_; }
  /// Targets::radiance of the last draw.
  std::vector<glm::vec4> radiance();
  /// Number of texture samples of the last march; requires RendererOptions::count_samples.
  std::uint32_t texture_samples() const;
  const scenario::Simulation& simulation() const { return *simulation_; }

 private:
  gpu::Context& context_;
  std::unique_ptr<scenario::Simulation> simulation_;
  gpu::CommandRunner runner_;
  render::Renderer renderer_;
  gpu::Buffer counter_;
  std::vector<shared::Hole> holes_;
  render::FrameInput input_;
};

struct FrameTimes {
  /// All passes except rasterization. Details: the medians of each pass and of the CPU parts, the device
  /// memory (device_mb) and the size of the smoke volume (volume_mb).
  Measurement all;
  Measurement march;
};

/// Measures the frame at `seconds` of a scenario, with a quality other than the usual one if given: about 200
/// draws on a GPU, three on a software device.
FrameTimes time_frames(Bench& bench, const std::string& name, const scenario::Scenario& scenario,
                       const render::RendererOptions& options, double seconds,
                       const std::function<void(planning::Quality&)>& change = {});

}  // namespace brume::bench
