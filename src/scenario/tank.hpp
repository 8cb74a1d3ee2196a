// The tank of a scene: loaded, or packed; and the tanks of a timeline.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "scene/tank_illumination.hpp"
#include "scene/timeline.hpp"
#include "spheres/tank.hpp"

namespace brume::scenario {

/// A scene of a tank with its spheres.
struct TankScenario {
  scene::TankScene scene;
  spheres::Tank tank;
};

/// The colours that a text like "NAME:0.2-0.6" chooses (palettes::parse_palette_choice), interpolated in a
/// space of palettes::space_of, as spheres::PackOptions takes them. Fails as those, and with usage for
/// another space.
Result<std::vector<spheres::Color>> palette_colors(const std::string& choice, const std::string& space);

/// Loads the tank of a scene from its file, or packs it. `stopped`: as spheres::pack. Fails as those, and
/// with bad_input for a palette that does not exist.
Result<spheres::Tank> make_tank(const scene::TankScene& scene, const std::function<bool()>& stopped = {});

/// The same for the file of a scene, or of a tank (.spheres) in a scene of its own: a light, a sky.
Result<TankScenario> load_tank_scenario(const std::filesystem::path& path,
                                        const std::function<bool()>& stopped = {});

/// A tank of a timeline with its light.
struct LitTank {
  std::shared_ptr<const scene::TankContent> content;
  std::shared_ptr<const scene::TankIllumination> light;
};

/// Loads and lights the tanks of a timeline, those of one file once. Fails as load_tank_scenario, with the
/// place of the table.
Result<std::vector<LitTank>> load_tanks(const scene::Timeline& timeline);

/// Whether load_tank_scenario takes a file.
bool is_tank_input(const std::filesystem::path& path);

/// Every file that its pictures depend on, without the scene's own.
std::vector<std::filesystem::path> files_of(const scene::TankScene& scene);

/// Every file that load_tank_scenario reads for a file, and those that it only names, this one first. Reads
/// its text alone, and is complete for scenes with faults, too.
std::vector<std::filesystem::path> files_of_tank_input(const std::filesystem::path& path);

}  // namespace brume::scenario
