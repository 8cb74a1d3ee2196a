// Pictures of a tank's scene at its times.
#pragma once

#include <optional>

#include "image/image.hpp"
#include "render/tank_renderer.hpp"
#include "scenario/tank.hpp"

namespace brume::render {

class TankPictures {
 public:
  /// `context` and `scenario` must outlive it. Throws what TankRenderer throws.
  TankPictures(gpu::Context& context, const scenario::TankScenario& scenario, glm::uvec2 size_px);

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
  void trace_batch(const planning::TankPlan& plan, const std::function<bool()>& stopped);
  void add_samples(double seconds, const std::function<bool()>& stopped);

  gpu::Context& context_;
  const scenario::TankScenario& scenario_;
  gpu::CommandRunner runner_;
  spheres::BrickLists bricks_;
  TankRenderer renderer_;
  std::optional<spheres::LightPathScene> traced_;  ///< Its light of this batch is in the renderer.
  std::uint32_t batch_ = 0;
  glm::uvec2 size_px_;
  std::uint32_t samples_;
  std::optional<scene::Camera> camera_;
};

}  // namespace brume::render
