#include "film/tank_playback.hpp"

#include <algorithm>
#include <chrono>

#include "core/progress.hpp"
#include "film/read_back.hpp"

namespace brume::film {
namespace {

/// A submission of a tank's samples takes about this long [s], so that a stop is noticed and no device thinks
/// that it hangs.
constexpr double kSubmission = 0.2;
constexpr std::uint32_t kMostSamplesOfSubmission = 64;

}  // namespace

void add_samples(gpu::CommandRunner& runner, render::TankPicture& picture, TankPhotons& photons,
                 const spheres::Tank& tank, std::uint32_t samples, const std::function<bool()>& stopped) {
  Progress progress("samples", samples);
  std::uint32_t most = 1;
  while (picture.samples() < samples) {
    photons.complete(picture, tank, stopped);
    if (stopped && stopped()) return;
    const std::uint32_t done = picture.samples();
    most = std::min({most, samples - done, photons.samples_from(done), kMostSamplesOfSubmission});
    // The rest of a sample comes first.
    const std::uint32_t rows = picture.rows() > 0 ? picture.size_px().y - picture.rows() : 0;
    const auto begin = std::chrono::steady_clock::now();
    runner.run([&](gpu::Recorder& recorder) { picture.record(recorder, {rows > 0 ? 0u : most, rows}); });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    progress.advance(picture.samples() - done);
    most = taken.count() < 0.5 * kSubmission ? 2 * most
           : taken.count() > kSubmission     ? std::max(most / 2, 1u)
                                             : most;
  }
}

TankPlayback::TankPlayback(gpu::Context& context, const scenario::TankScenario& scenario, glm::uvec2 size_px)
    : context_(context),
      scenario_(scenario),
      runner_(context),
      picture_(context, runner_, scenario.tank),
      size_px_(size_px),
      samples_(scenario.scene.samples) {}

void TankPlayback::refine(double seconds, const std::function<bool()>& stopped) {
  picture_.restart();
  picture_.show(planning::plan_tank(scenario_.scene, scenario_.tank, seconds, size_px_, camera_),
                planning::plan_tank_display(scenario_.scene, size_px_));
  add_samples(runner_, picture_, photons_, scenario_.tank, samples_, stopped);
}

image::Image8 TankPlayback::draw(double seconds, const std::function<bool()>& stopped) {
  refine(seconds, stopped);
  return read_picture(context_, runner_, picture_.display());
}

image::LayeredImage TankPlayback::draw_layers(double seconds, const std::function<bool()>& stopped) {
  refine(seconds, stopped);
  const auto sum = gpu::read_texels<glm::vec4>(context_, runner_, picture_.sampler().sum());
  image::LayeredImage image{size_px_.x, size_px_.y, {}};
  constexpr const char* kNames[]{"R", "G", "B"};
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float> values(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i)
      values[i] = sum[i][channel] / static_cast<float>(picture_.samples());
    image.layers.push_back({kNames[channel], std::move(values)});
  }
  return image;
}

}  // namespace brume::film
