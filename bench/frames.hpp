// A frame of a scenario that is drawn again and again, and the time that each of its passes takes.
#pragma once

#include "bench/bench.hpp"
#include "render/playback.hpp"

namespace brume::bench {

/// What one drawing took [ms].
struct FrameCost {
  std::map<std::string, double> passes;    ///< On the device.
  double prepare_cpu = 0, record_cpu = 0;  ///< Of this thread's processor time: making room, recording.
};

/// The moment `seconds` of a scenario, its smoke lit anew in each drawing.
class RepeatedFrame {
 public:
  /// `scenario` must outlive it.
  RepeatedFrame(gpu::Context& context, const scenario::Scenario& scenario, const render::RendererOptions& options,
                double seconds);

  FrameCost draw();
  /// What is drawn: to be changed from drawing to drawing.
  render::FrameInput& input() { return input_; }
  const render::Renderer& renderer() const { return renderer_; }
  /// Texture samples that the last march took, with RendererOptions::count_samples.
  std::uint32_t texture_samples() const;
  const scenario::Simulation& simulation() const { return *simulation_; }

 private:
  std::unique_ptr<scenario::Simulation> simulation_;
  gpu::CommandRunner runner_;
  render::Renderer renderer_;
  gpu::Buffer counter_;
  std::vector<shared::Hole> holes_;
  render::FrameInput input_;
};

struct FrameTimes {
  /// All passes but the raster; details: the median of each and of the processor's parts, the memory that the
  /// device holds for it (device_mb), and that of the smoke's volume (volume_mb).
  Measurement all;
  Measurement march;
};

/// Draws a moment of a scenario until its times are known: some 200 times on a GPU, three times on a processor.
FrameTimes time_frames(Bench& bench, const std::string& name, const scenario::Scenario& scenario,
                       const render::RendererOptions& options, double seconds);

}  // namespace brume::bench
