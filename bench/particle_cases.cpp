#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/frames.hpp"
#include "grids/dense_grid.hpp"
#include "grids/files.hpp"

namespace brume::bench {
namespace {

// The volume of the exhaust of an ion thruster: a ring and a beam, in a box twice as long as wide.
constexpr glm::uvec3 kExhaustVoxels{64, 64, 32};
constexpr glm::vec3 kExhaustBox{1, 1, 2};                                              // [m]
constexpr std::array kExhaustTints{glm::vec3(9, 2.4f, 0.6f), glm::vec3(1, 3.5f, 10)};  // per metre

/// Both masks, which are 0 on the faces of the box.
std::vector<grids::DenseGrid> exhaust_masks() {
  std::vector<grids::DenseGrid> masks(2);
  for (grids::DenseGrid& mask : masks) {
    mask.name = &mask == &masks[0] ? "ring" : "beam";
    mask.size = kExhaustVoxels;
    mask.box = {-0.5 * glm::dvec3(kExhaustBox), 0.5 * glm::dvec3(kExhaustBox)};
  }
  for (std::uint32_t i = 0; i < kExhaustVoxels.x * kExhaustVoxels.y * kExhaustVoxels.z; ++i) {
    const glm::uvec3 voxel(i % kExhaustVoxels.x, i / kExhaustVoxels.x % kExhaustVoxels.y,
                           i / kExhaustVoxels.x / kExhaustVoxels.y);
    const glm::vec3 uvw = (glm::vec3(voxel) + 0.5f) / glm::vec3(kExhaustVoxels);
    const glm::vec3 to_face = glm::min(uvw, 1.0f - uvw) - 0.5f / glm::vec3(kExhaustVoxels);
    const float fade = glm::smoothstep(0.0f, 0.06f, std::min({to_face.x, to_face.y, to_face.z}));
    const float r = glm::length(glm::vec2(uvw) - 0.5f);
    masks[0].values.push_back(fade * std::exp(-std::pow((r - 0.3f) / 0.05f, 2.0f) - 6 * uvw.z));
    masks[1].values.push_back(fade * std::exp(-std::pow(r / (0.05f + 0.12f * uvw.z), 2.0f) - 2 * uvw.z));
  }
  return masks;
}

/// Both masks as a volume that is marched, from a file that is removed again; seen from the side so that it
/// fills the image.
Result<scenario::Scenario> exhaust_scenario() {
  scene::Timeline timeline;
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("brume_bench_" + std::to_string(::getpid()) + ".brv");
  grids::GridFile file;
  for (const grids::DenseGrid& mask : exhaust_masks()) file.grids.push_back(grids::to_grid(mask));
  if (auto saved = grids::save_grid_file(path, file); !saved) return saved.failure();
  scene::VolumeOptions volume;
  volume.file = path;
  volume.extinction = 0;
  for (std::size_t i = 0; i < kExhaustTints.size(); ++i) {
    const float intensity = std::max({kExhaustTints[i].r, kExhaustTints[i].g, kExhaustTints[i].b});
    volume.masks.push_back({i == 0 ? "ring" : "beam", kExhaustTints[i] / intensity, intensity, {}});
  }
  timeline.volumes.push_back(volume);
  timeline.scene = path;
  timeline.camera = {{0, {{1.55f, 0.35f, 0.3f}, {0, 0, 0}, 0.8f}}};
  auto scenario = scenario::make_scenario(std::move(timeline), {});
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return scenario;
}

/// A frame in which nothing but the exhaust emits.
class ExhaustFrame {
 public:
  ExhaustFrame(Bench& bench, const scenario::Scenario& scenario)
      : bench_(bench), frame_(bench.context(), scenario, options_of(bench), 0) {
    render::FrameInput& input = frame_.input();
    input.environment = {};
    input.quality.rebuild_light = false;
  }

  /// Instead of the march.
  void use_particles(std::uint32_t count) {
    frame_.input().slices = std::make_shared<std::vector<grids::DenseVolume>>(1, exhaust_masks());
    planning::ParticleInput particles;
    particles.world_from_uvw =
        glm::translate(glm::mat4(1), -0.5f * kExhaustBox) * glm::scale(glm::mat4(1), kExhaustBox);
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
  /// GPU time of a pass.
  Measurement time(const std::string& name, const char* pass) {
    const bool slow = bench_.context().info().kind == "cpu";
    std::vector<double> times;
    for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame_.draw();
    for (unsigned i = 0; i < bench_.repetitions(slow ? 3 : 200); ++i)
      times.push_back(frame_.draw().passes.at(pass));
    return summarize(name, "ms", "gpu", std::move(times));
  }

 private:
  static render::RendererOptions options_of(Bench& bench) {
    render::RendererOptions options;
    options.size_px = bench.context().info().kind == "cpu" ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
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

Result<std::vector<Measurement>> marched_exhaust(Bench& bench) {
  const auto scenario = exhaust_scenario();
  if (!scenario) return scenario.failure();
  ExhaustFrame frame(bench, *scenario);
  const std::vector<glm::vec4> reference = frame.draw(kReferenceSteps), image = frame.draw();
  Measurement m = frame.time("particles/march", "march");
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
  Measurement m = frame.time("particles/" + std::to_string(count), "particles");
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
       marched_exhaust}};
  for (const std::uint32_t count : {50u, 400u, 6400u})
    cases.push_back({"particles/" + std::to_string(count),
                     "the same by " + std::to_string(count) + " particles",
                     [count](Bench& b) { return exhaust_of_particles(b, count); }});
  return cases;
}

}  // namespace brume::bench
