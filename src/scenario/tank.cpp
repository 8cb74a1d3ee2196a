#include "scenario/tank.hpp"

#include <algorithm>

#include "core/utf8.hpp"
#include "palettes/choice.hpp"
#include "palettes/sample.hpp"
#include "scene/files/tank_reader.hpp"
#include "spheres/file.hpp"
#include "spheres/pack.hpp"

namespace brume::scenario {

Result<std::vector<spheres::Color>> palette_colors(const std::string& choice, const std::string& space) {
  constexpr std::size_t kColors = 256;
  const auto chosen = palettes::parse_palette_choice(choice);
  if (!chosen) return chosen.failure();
  const auto known = palettes::space_of(space);
  if (!known) return Failure{ErrorCode::usage, "\"" + space + "\": expected oklab, linear, srgb or nearest"};
  return palettes::sample_range(chosen->palette, chosen->low, chosen->high, kColors, *known);
}

Result<spheres::Tank> make_tank(const scene::TankScene& scene, const std::function<bool()>& stopped) {
  if (!scene.file.empty()) return spheres::load_tank(scene.file);
  spheres::PackOptions options = scene.pack;
  if (!scene.palette.empty()) {
    auto colors = palette_colors(scene.palette, scene.palette_space);
    if (!colors) return colors.failure();
    options.palette = std::move(*colors);
  }
  return spheres::pack(options, stopped);
}

bool is_tank_input(const std::filesystem::path& path) {
  return spheres::is_tank_file(path) || scene::is_tank_scene(path);
}

Result<TankScenario> load_tank_scenario(const std::filesystem::path& path,
                                        const std::function<bool()>& stopped) {
  scene::TankScene scene;
  if (spheres::is_tank_file(path)) {
    scene = scene::scene_of_tank_file(path);
  } else {
    auto loaded = scene::load_tank_scene(path);
    if (!loaded) return loaded.failure();
    scene = std::move(*loaded);
  }
  auto tank = make_tank(scene, stopped);
  if (!tank) return tank.failure();
  return TankScenario{std::move(scene), std::move(*tank)};
}

Result<std::vector<LitTank>> load_tanks(const scene::Timeline& timeline) {
  std::vector<LitTank> tanks;
  for (const scene::TankOptions& options : timeline.tanks) {
    const auto first = std::ranges::find(timeline.tanks, options.file, &scene::TankOptions::file);
    const auto index = static_cast<std::size_t>(first - timeline.tanks.begin());
    if (index < tanks.size()) {
      tanks.push_back(tanks[index]);
      continue;
    }
    auto loaded = load_tank_scenario(options.file);
    if (!loaded) {
      const std::string place = options.place.empty() ? "" : options.place + ": ";
      return Failure{loaded.failure().code, place + loaded.failure().message};
    }
    auto content = std::make_shared<scene::TankContent>();
    content->tank = std::move(loaded->tank);
    content->bricks = spheres::list_bricks(content->tank);
    auto light = std::make_shared<const scene::TankIllumination>(
        scene::illuminate(*content, std::move(loaded->scene)));
    tanks.push_back({std::move(content), std::move(light)});
  }
  return tanks;
}

std::vector<std::filesystem::path> files_of(const scene::TankScene& scene) {
  if (!scene.file.empty()) return {scene.file};
  const std::string_view palette = palettes::file_of_choice(scene.palette);
  if (palette.empty()) return {};
  return {to_path(palette)};
}

std::vector<std::filesystem::path> files_of_tank_input(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files{path};
  if (spheres::is_tank_file(path)) return files;
  for (std::filesystem::path& file : scene::files_named_by_tank_scene(path)) files.push_back(std::move(file));
  return files;
}

}  // namespace brume::scenario
