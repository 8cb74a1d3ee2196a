// Plays the scene of a tank alone on a device: draws any time of it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "film/tank_photons.hpp"
#include "image/image.hpp"
#include "scenario/tank.hpp"

namespace brume::film {

/// Adds samples to the picture of a tank alone until it has so many, with progress, by new light paths for
/// every batch. `stopped` ends it early.
void add_samples(gpu::CommandRunner& runner, render::TankPicture& picture, TankPhotons& photons,
                 const spheres::Tank& tank, std::uint32_t samples, const std::function<bool()>& stopped);

/// A tank of spheres alone, frame after frame.
class TankPlayback {
 public:
  /// `context` and `scenario` must outlive it. Throws what TankPicture throws.
  TankPlayback(gpu::Context& context, const scenario::TankScenario& scenario, glm::uvec2 size_px);

  /// The camera at all times, in place of the scene's.
  void set_camera(const std::optional<scene::Camera>& camera) { camera_ = camera; }
  /// Samples of a pixel, in place of the scene's.
  void set_samples(std::uint32_t samples) { samples_ = samples; }
  std::uint32_t samples() const { return samples_; }

  /// The picture at a time [s], with progress; the same for the same time. `stopped` ends it early with fewer
  /// samples.
  image::Image8 draw(double seconds, const std::function<bool()>& stopped = {});
  /// The same as numbers: R, G and B.
  image::LayeredImage draw_layers(double seconds, const std::function<bool()>& stopped = {});
  /// GPU times of the last samples.
  std::vector<gpu::Timings::Scope> timings() const { return runner_.timings(); }

 private:
  void refine(double seconds, const std::function<bool()>& stopped);

  gpu::Context& context_;
  const scenario::TankScenario& scenario_;
  gpu::CommandRunner runner_;
  render::TankPicture picture_;
  TankPhotons photons_;
  glm::uvec2 size_px_;
  std::uint32_t samples_;
  std::optional<scene::Camera> camera_;
};

}  // namespace brume::film
