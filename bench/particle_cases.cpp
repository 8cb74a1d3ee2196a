#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "bench/frames.hpp"
#include "grids/files/slice_atlas.hpp"

namespace brume::bench {
namespace {

/// Radiance of its ring and its beam, per metre.
constexpr std::array kExhaustTints{glm::vec3(18, 70, 180), glm::vec3(200, 280, 350)};

/// The exhaust of an ion thruster, seen from the side so that it fills the image, without anything else.
Result<scenario::Scenario> exhaust_scenario() {
  scene::Timeline timeline;
  timeline.scene = scene_file("thruster/thruster.json");
  scene::VolumeOptions volume;
  volume.file = timeline.scene;
  volume.extinction = 0;
  for (std::size_t i = 0; i < kExhaustTints.size(); ++i) {
    const float intensity = std::max({kExhaustTints[i].r, kExhaustTints[i].g, kExhaustTints[i].b});
    volume.masks.push_back({i == 0 ? "ring" : "beam", kExhaustTints[i] / intensity, intensity, {}});
  }
  timeline.volumes.push_back(volume);
  timeline.camera = {{0, {{0.085f, 0.02f, 0.015f}, {0, 0, 0}, 0.72f}}};
  return scenario::make_scenario(std::move(timeline), {});
}

/// A frame in which nothing but the exhaust emits.
class ExhaustFrame {
 public:
  ExhaustFrame(Bench& bench, const scenario::Scenario& scenario, std::uint32_t march_scale = 1)
      : bench_(bench), frame_(bench.context(), scenario, options_of(bench, march_scale), 0) {
    render::FrameInput& input = frame_.input();
    input.environment = {};
    input.quality.rebuild_light = false;
  }

  /// Instead of the march.
  void use_particles(std::uint32_t count) {
    const grids::SliceAtlas atlas =
        grids::load_slice_atlas(scene_file("thruster/thruster.json")).value_or_throw();
    frame_.input().slices = std::make_shared<const grids::DenseVolumes>(
        1, std::make_shared<const grids::DenseVolume>(atlas.channels));
    const Box<double>& box = atlas.channels.front().box;
    planning::ParticleInput particles;
    particles.world_from_uvw =
        glm::mat4(glm::translate(glm::dmat4(1), box.low) * glm::scale(glm::dmat4(1), box.high - box.low));
    std::ranges::copy(kExhaustTints, particles.tints.begin());
    particles.count = count;
    frame_.input().volumes.clear();
    frame_.input().particles = {particles};
  }

  std::vector<glm::vec4> draw(float step_scale = 1, planning::DebugView view = planning::DebugView::none) {
    frame_.input().quality.step_scale = step_scale;
    frame_.input().debug.view = view;
    frame_.draw();
    return frame_.radiance();
  }
  /// GPU time of passes together.
  Measurement time(const std::string& name, std::initializer_list<const char*> passes) {
    const bool slow = bench_.is_slow();
    std::vector<double> times;
    for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame_.draw();
    for (unsigned i = 0; i < bench_.repetitions(slow ? 3 : 200); ++i) {
      const FrameCost cost = frame_.draw();
      times.push_back(std::accumulate(passes.begin(), passes.end(), 0.0, [&](double sum, const char* pass) {
        return sum + cost.passes.at(pass);
      }));
    }
    return summarize(name, "ms", "gpu", std::move(times));
  }

 private:
  static render::RendererOptions options_of(Bench& bench, std::uint32_t march_scale) {
    render::RendererOptions options;
    options.smoke.march_scale = march_scale;
    options.size_px = bench.is_slow() ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
    return options;
  }

  Bench& bench_;
  RepeatedFrame frame_;
};

/// Root mean square of the difference, in percent of that of the reference.
double percent_apart(const std::vector<glm::vec4>& image, const std::vector<glm::vec4>& reference) {
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const glm::dvec3 expected(reference[i]), apart = glm::dvec3(image[i]) - expected;
    difference += glm::dot(apart, apart);
    all += glm::dot(expected, expected);
  }
  return 100 * std::sqrt(difference / all);
}

/// The march at this many times its usual step is the reference of all.
constexpr float kReferenceSteps = 0.125f;

Result<std::vector<Measurement>> marched_exhaust(Bench& bench, std::uint32_t march_scale) {
  const auto scenario = exhaust_scenario();
  if (!scenario) return scenario.failure();
  const std::vector<glm::vec4> reference = ExhaustFrame(bench, *scenario).draw(kReferenceSteps);
  ExhaustFrame frame(bench, *scenario, march_scale);
  const std::vector<glm::vec4> image = frame.draw();
  Measurement m = march_scale == 1 ? frame.time("particles/march", {"march"})
                                   : frame.time("particles/march_half", {"march", "resolve"});
  m.details = {{"rms_percent", percent_apart(image, reference)}};
  return std::vector{m};
}

Result<std::vector<Measurement>> exhaust_of_particles(Bench& bench, std::uint32_t count) {
  const auto scenario = exhaust_scenario();
  if (!scenario) return scenario.failure();
  ExhaustFrame frame(bench, *scenario);
  const std::vector<glm::vec4> reference = frame.draw(kReferenceSteps);
  frame.use_particles(count);
  const std::vector<glm::vec4> image = frame.draw();
  const std::vector<glm::vec4> quads = frame.draw(1, planning::DebugView::overdraw);
  double sum = 0, most = 0;
  for (const glm::vec4& pixel : quads) {
    sum += double{pixel.x};
    most = std::max(most, double{pixel.x});
  }
  frame.draw();
  Measurement m = frame.time("particles/" + std::to_string(count), {"particles"});
  m.details = {{"rms_percent", percent_apart(image, reference)},
               {"quads_per_pixel", sum / static_cast<double>(quads.size())},
               {"most_quads", most}};
  return std::vector{m};
}

}  // namespace

std::vector<Case> particle_cases() {
  std::vector<Case> cases{
      {"particles/march",
       "the exhaust of an ion thruster that fills the image, marched; 480x270 without a GPU",
       [](Bench& b) { return marched_exhaust(b, 1); }},
      {"particles/march_half", "the same with a ray for 2 x 2 pixels, resolved",
       [](Bench& b) { return marched_exhaust(b, 2); }}};
  for (const std::uint32_t count : {50u, 100u, 200u, 400u, 800u, 1600u, 3200u, 6400u})
    cases.push_back({"particles/" + std::to_string(count),
                     "the same by " + std::to_string(count) + " particles",
                     [count](Bench& b) { return exhaust_of_particles(b, count); }});
  return cases;
}

}  // namespace brume::bench
