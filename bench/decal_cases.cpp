#include <glm/gtc/matrix_transform.hpp>

#include "bench/frames.hpp"

namespace brume::bench {
namespace {

/// Where decals are in the yard of scenes/flyby.
enum class Spread {
  over_image,  ///< Boxes that hold all that is in view.
  over_yard,   ///< Boxes of their own size, in rows over the ground.
};

/// GPU time of the decals of one frame; without a past each pixel takes all of its samples itself.
Result<std::vector<Measurement>> time_decals(Bench& bench, const std::string& name, std::size_t count,
                                             Spread spread, bool continues) {
  const auto scenario = scenario::load_scenario(scene_file("flyby/flyby.toml"), {});
  if (!scenario) return scenario.failure();
  const bool slow = bench.is_slow();
  render::RendererOptions options;
  options.size_px = slow ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
  options.smoke.temporal = continues;
  // The drone is over the ground in the middle of the image.
  constexpr double kSeconds = 2.4;
  RepeatedFrame frame(bench.context(), *scenario, options, kSeconds);
  render::FrameInput& input = frame.input();
  input.volumes.clear();
  input.quality.rebuild_light = false;
  input.view.continues = continues;
  const planning::DecalInput first = input.decals.at(0);
  input.decals.clear();
  for (std::size_t i = 0; i < count; ++i) {
    planning::DecalInput decal = first;
    const glm::vec3 at(-7 + 2 * static_cast<float>(i % 8), 0.7f, -5 + 2 * static_cast<float>(i / 8));
    decal.world_from_box = spread == Spread::over_yard
                               ? glm::translate(glm::mat4(1), at)
                               : glm::scale(first.world_from_box, glm::vec3(20 + static_cast<float>(i)));
    decal.strength = 0.5f;
    input.decals.push_back(decal);
  }
  std::vector<double> times;
  for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame.draw();
  for (unsigned i = 0; i < bench.repetitions(slow ? 3 : 200); ++i)
    times.push_back(frame.draw().passes.at("decals"));
  return std::vector{summarize(name, "ms", "gpu", std::move(times))};
}

Case decal_case(const std::string& name, const std::string& about, std::size_t count, Spread spread,
                bool continues) {
  return {name, about, [=](Bench& bench) { return time_decals(bench, name, count, spread, continues); }};
}

}  // namespace

std::vector<Case> decal_cases() {
  return {
      decal_case("decals/1", "a decal that covers the image; 480x270 without a GPU", 1, Spread::over_image,
                 true),
      decal_case("decals/1_still", "the same without the frames before", 1, Spread::over_image, false),
      decal_case("decals/32", "32 decals over the ground of a yard", 32, Spread::over_yard, true),
      decal_case("decals/32_stacked", "32 decals that each cover the image", 32, Spread::over_image, true)};
}

}  // namespace brume::bench
