// Pictures of a tank on a device: samples are added until it is as smooth as wanted.
#pragma once

#include "passes/display.hpp"
#include "render/tank_sampler.hpp"

namespace brume::render {

class TankRenderer {
 public:
  static constexpr std::uint32_t kRows = TankSampler::kRows;

  /// Uploads the tank and finds its voxels. `context` and `stream` must outlive it, `tank` need not. Throws
  /// resource_limit when the device has too little memory. `with_ids`: as TankSampler.
  TankRenderer(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
               glm::uvec2 size_px, bool with_ids = false);

  // As TankSampler.
  void set_kind(scene::TankView kind) { sampler_.set_kind(kind); }
  void set_lighting(scene::TankLighting lighting) { sampler_.set_lighting(lighting); }
  void set_photons(const spheres::LightPaths& paths) { sampler_.set_photons(paths); }
  void replace_photons(const spheres::LightPaths& paths) { sampler_.replace_photons(paths); }
  /// What the samples from the next one on show: the picture begins again. When the device is done with what
  /// was recorded before.
  void set_view(const planning::TankPlan& plan, const planning::TankDisplay& display);
  /// Light paths are traced again for every few samples, with this number as their seed: what their noise
  /// leaves in one batch averages out over all.
  static constexpr std::uint32_t kSamplesOfBatch = 16;
  static constexpr std::uint32_t batch_of(std::uint32_t samples) { return samples / kSamplesOfBatch; }
  /// Pictures of another size from the next one on. When the device is done with what was recorded before.
  void resize(glm::uvec2 size_px);
  /// Exposure, tone curve and dither alone: the picture goes on.
  void set_display(const planning::TankDisplay& display) { display_ = display; }

  /// Records `count` more samples of each pixel, and the picture so far.
  void record_samples(gpu::Recorder& recorder, std::uint32_t count);
  /// Records a part of one more sample of each pixel: as many rows, from the top to the bottom; with the last
  /// ones the sample and the picture are complete.
  void record_rows(gpu::Recorder& recorder, std::uint32_t rows);
  /// Records the picture so far with the exposure and the tone curve that it has now. Not before the first
  /// sample.
  void record_display(gpu::Recorder& recorder);
  /// So far, of every pixel.
  std::uint32_t samples() const { return sampler_.samples(); }
  /// Rows of one more sample.
  std::uint32_t rows() const { return sampler_.rows(); }

  const gpu::Image& radiance() const { return sampler_.radiance(); }  ///< Half floats.
  const gpu::Image& sum() const { return sampler_.sum(); }            ///< As TankSampler.
  const gpu::Image& display() const { return shown_; }                ///< RGBA8, sRGB.
  const passes::TankVolume& volume() const { return sampler_.volume(); }

 private:
  gpu::Context& context_;
  TankSampler sampler_;
  passes::DisplayPass display_pass_;
  gpu::Image blue_noise_, shown_;
  gpu::Buffer frame_;
  planning::TankDisplay display_;
};

}  // namespace brume::render
