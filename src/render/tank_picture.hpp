// The picture of a tank alone, as a list of parts: samples over its own air, and their colours on a display.
// Samples are added until it is as smooth as wanted.
#pragma once

#include "passes/display.hpp"
#include "render/tank_sampler.hpp"

namespace brume::render {

/// What is added to a picture.
struct TankSlice {
  std::uint32_t samples = 0;  ///< More samples of each pixel; 0: a part of one.
  std::uint32_t rows = 0;     ///< Rows of that part, where samples is 0: from the top to the bottom.
};

class TankPicture {
 public:
  /// Uploads the tank; show() must follow. `context` and `stream` must outlive it, `tank` need not. Throws
  /// resource_limit when the device has too little memory. `with_ids`: as TankSampler.
  TankPicture(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
              bool with_ids = false);

  // When the device is done with what was recorded before; all throw resource_limit.
  /// What the picture shows from now on, in the plan's size. Where samples of it are the plan's, too, it goes
  /// on; else it begins again: returns whether it does.
  bool show(const planning::TankPlan& plan, const planning::TankDisplay& display);
  /// Makes room for pictures of this size, as show() does.
  void reserve(glm::uvec2 size_px);
  /// The picture begins again.
  void restart() { sampler_.restart(); }
  /// Light of the lights that comes through the glass, as TankSampler::set_photons and replace_photons.
  void set_photons(const spheres::LightPaths& paths) { sampler_.set_photons(paths); }
  void replace_photons(const spheres::LightPaths& paths) { sampler_.replace_photons(paths); }

  /// Records a slice, and the colours of what is there if samples are complete or are shown differently than
  /// before. Whether display() is another picture then.
  bool record(gpu::Recorder& recorder, const TankSlice& slice);
  /// Samples of every pixel so far.
  std::uint32_t samples() const { return sampler_.samples(); }
  /// Rows of one more sample.
  std::uint32_t rows() const { return sampler_.rows(); }

  /// (0, 0) before the first show().
  glm::uvec2 size_px() const { return shown_ ? glm::uvec2(shown_.info().size) : glm::uvec2(0); }
  const TankSampler& sampler() const { return sampler_; }
  const gpu::Image& display() const { return shown_; }  ///< RGBA8, sRGB; of the last complete samples.

 private:
  gpu::Context& context_;
  TankSampler sampler_;
  passes::DisplayPass display_pass_;
  gpu::Image blue_noise_, shown_;
  gpu::Buffer frame_;
  planning::TankDisplay display_;
  gpu::Recorded<bool> is_displayed_;  ///< The samples so far, by display_.
};

}  // namespace brume::render
