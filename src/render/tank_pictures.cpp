#include "render/tank_pictures.hpp"

#include <algorithm>
#include <chrono>

#include "core/progress.hpp"
#include "render/read_back.hpp"

namespace brume::render {
namespace {

/// A submission takes about this long [s], so that a stop is noticed and no device thinks that it hangs.
constexpr double kSubmission = 0.2;
constexpr std::uint32_t kMostSamplesOfSubmission = 64;

}  // namespace

TankPictures::TankPictures(gpu::Context& context, const scenario::TankScenario& scenario, glm::uvec2 size_px)
    : context_(context),
      scenario_(scenario),
      runner_(context),
      bricks_(spheres::list_bricks(scenario.tank)),
      renderer_(context, runner_, scenario.tank, size_px),
      size_px_(size_px),
      samples_(scenario.scene.samples) {
  renderer_.set_kind(scenario.scene.view);
  renderer_.set_lighting(scenario.scene.lighting);
}

void TankPictures::trace_batch(const planning::TankPlan& plan, const std::function<bool()>& stopped) {
  if (scenario_.scene.view != scene::TankView::spheres) return;
  const spheres::LightPathScene scene = planning::light_path_scene(plan);
  const std::uint32_t batch = TankRenderer::batch_of(renderer_.samples());
  // The light of the frame before, as long as neither the lights nor the glass move.
  if (traced_ && spheres::same_light(*traced_, scene) && batch == batch_) return;
  spheres::LightPathOptions options;
  options.count = scenario_.scene.photons;
  options.seed = batch;
  renderer_.replace_photons(spheres::trace_light_paths(scenario_.tank, bricks_, scene, options, stopped));
  traced_ = scene;
  batch_ = batch;
}

void TankPictures::add_samples(double seconds, const std::function<bool()>& stopped) {
  Progress progress("samples", samples_);
  const planning::TankPlan plan =
      planning::plan_tank(scenario_.scene, scenario_.tank, seconds, size_px_, camera_);
  renderer_.set_view(plan, planning::plan_tank_display(scenario_.scene, size_px_));
  const bool has_batches = scenario_.scene.photons > 0 && scenario_.scene.glass.has_value();
  std::uint32_t count = 1;
  while (renderer_.samples() < samples_ && !(stopped && stopped())) {
    if (has_batches) trace_batch(plan, stopped);
    count = std::min({count, samples_ - renderer_.samples(), kMostSamplesOfSubmission});
    if (has_batches)
      count = std::min(count,
                       TankRenderer::kSamplesOfBatch - renderer_.samples() % TankRenderer::kSamplesOfBatch);
    const auto begin = std::chrono::steady_clock::now();
    runner_.run([&](gpu::Recorder& recorder) { renderer_.record_samples(recorder, count); });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    progress.advance(count);
    count = taken.count() < 0.5 * kSubmission ? 2 * count
            : taken.count() > kSubmission     ? std::max(count / 2, 1u)
                                              : count;
  }
}

image::Image8 TankPictures::draw(double seconds, const std::function<bool()>& stopped) {
  add_samples(seconds, stopped);
  return read_picture(context_, runner_, renderer_.display());
}

image::LayeredImage TankPictures::draw_layers(double seconds, const std::function<bool()>& stopped) {
  add_samples(seconds, stopped);
  const auto sum = gpu::read_texels<glm::vec4>(context_, runner_, renderer_.sum());
  image::LayeredImage image{size_px_.x, size_px_.y, {}};
  constexpr const char* kNames[]{"R", "G", "B"};
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float> values(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i)
      values[i] = sum[i][channel] / static_cast<float>(renderer_.samples());
    image.layers.push_back({kNames[channel], std::move(values)});
  }
  return image;
}

}  // namespace brume::render
