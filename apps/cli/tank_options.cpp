#include "apps/cli/tank_options.hpp"

namespace brume::cli {
namespace {

struct OptionOfLevels {
  const char* option;
  const char* command = nullptr;  ///< Where it has that meaning; null: everywhere.
};

// What a tank does not know.
constexpr OptionOfLevels kOptionsOfLevels[]{
    // Timelines, and what happens in them.
    {"--timeline"},
    {"--shutter"},
    {"--word"},
    {"--shot"},
    {"--record"},
    // Smoke, volumes and how they are drawn.
    {"--smoke"},
    {"--throw"},
    {"--smoke-size"},
    {"--voxel"},
    {"--scale"},
    {"--march"},
    {"--raycast"},
    {"--temporal"},
    {"--step"},
    {"--resolve-error-scale"},
    {"--light-update-fraction"},
    {"--volume-memory"},
    {"--quality"},
    {"--fps", "view"},
    {"--view"},
    {"--slice"},
    // Transfer functions.
    {"--opacity"},
    {"--color-map"},
    {"--range"},
    {"--density"},
    {"--heat"},
    {"--kelvin"},
    {"--volume-fps"},
    // Surfaces and sky.
    {"--sun"},
    {"--ground"},
    {"--background"},
    {"--matte"},
    {"--clamp"},
    {"--flipbook"},
};

}  // namespace

void declare_input(Outputs& outputs, const std::filesystem::path& input) {
  outputs.reads(input);
  if (scenario::is_tank_input(input)) outputs.reads(scenario::files_of_tank_input(input));
}

void refuse_options_of_levels(const Arguments& arguments) {
  for (const OptionOfLevels& of_levels : kOptionsOfLevels)
    if (!of_levels.command || arguments.name() == of_levels.command)
      arguments.refuse(of_levels.option, "is not for a tank of spheres");
}

scenario::TankScenario load_tank(const std::filesystem::path& input,
                                 const scenario::FirstViewOptions& options,
                                 const std::function<bool()>& stopped) {
  scenario::TankScenario scenario = scenario::load_tank_scenario(input, stopped).value_or_throw();
  const scene::PictureSettings<std::optional>& given = options.picture;
  if (given.exposure) scenario.scene.exposure = *given.exposure;
  if (given.bounces) scenario.scene.bounces = *given.bounces;
  if (given.tone) scenario.scene.tone = *given.tone;
  return scenario;
}

}  // namespace brume::cli
