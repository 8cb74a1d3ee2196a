#include "scenario/scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/log.hpp"
#include "grids/files/grid_files.hpp"
#include "image/font.hpp"
#include "scenario/first_smoke.hpp"
#include "scenario/free_place.hpp"
#include "scenario/volume_view.hpp"
#include "scene/files/load.hpp"
#include "scene/files/stand_ins.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/moved_objects.hpp"
#include "voxel/voxelize.hpp"

namespace brume::scenario {
namespace {

/// Gives a scene that has no grenade a built-in one, with a warning where a Scene.txt, which is to have its
/// own, shows it in flight.
void complete_grenade(const scene::Timeline& timeline, scene::Scene& scene) {
  const bool is_thrown = std::ranges::any_of(
      timeline.smokes, [](const scene::SmokeEvent& smoke) { return smoke.from_world != smoke.at_world; });
  if (!scene.grenade && is_thrown && scene::lower_extension(timeline.scene) == ".txt")
    log_warning(timeline.scene.string() + ": no object is called Grenade; a built-in one is thrown");
  scene::add_built_in_grenade(scene);
}

/// Makes a scenario of a timeline and its loaded scene.
Result<Scenario> assemble(scene::Timeline timeline, scene::Scene scene,
                          std::shared_ptr<volumes::Volumes> volumes, float aspect,
                          const std::filesystem::path& cache_folder) {
  if (auto checked = scene::check_objects(timeline, scene); !checked) return checked.failure();

  // The level: roles of its objects, and its voxels, from the cache if there is one.
  complete_grenade(timeline, scene);
  for (const scene::RoleOptions& options : timeline.roles)
    for (scene::Object& object : scene.objects)
      if (object.name == options.object) object.role = options.role;
  scene::exclude_moved_objects(timeline.carriers, scene);
  const auto layout = grid_layout(timeline, scene);
  if (!layout) return layout.failure();
  std::filesystem::path cache;
  if (!cache_folder.empty()) cache = cache_folder / timeline.scene.filename().replace_extension(".vxl");
  auto voxels = load_or_voxelize(scene, *layout, cache);
  if (!voxels) return voxels.failure();

  // The camera, and what the timeline's files hold.
  const bool is_fitted = !scene.camera;
  const scene::Camera camera = scene::default_camera(scene, aspect);
  auto masks = load_masks(timeline);
  if (!masks) return masks.failure();
  auto slices = load_slice_volumes(timeline);
  if (!slices) return slices.failure();
  auto tanks = load_tanks(timeline);
  if (!tanks) return tanks.failure();
  LensOpenings lens_openings;
  if (auto loaded = load_lens_openings(timeline, lens_openings); !loaded) return loaded.failure();
  return Scenario{.timeline = std::move(timeline),
                  .scene = std::move(scene),
                  .camera = camera,
                  .voxels = std::move(*voxels),
                  .masks = std::move(masks->atlas),
                  .shot_masks = std::move(masks->of_shots),
                  .volumes = std::move(volumes),
                  .slices = std::move(*slices),
                  .tanks = std::move(*tanks),
                  .lens_openings = std::move(lens_openings),
                  .camera_is_fitted = is_fitted};
}

/// Where the volumes of a timeline are, for the scene's bounds.
void place_volumes(const scene::Timeline& timeline, const volumes::Volumes& volumes, scene::Scene& scene) {
  for (std::size_t i = 0; i < timeline.volumes.size(); ++i) {
    const scene::VolumeOptions& options = timeline.volumes[i];
    scene::Volume place = volumes::place_of(options, volumes.extent(i));
    const glm::mat4 pose = scene::pose_of(timeline.carriers, options.carrier, 0);
    scene.volumes.push_back({place.name, volumes::transformed(pose, place.bounds_world),
                             volumes::transformed(pose, place.core_world)});
  }
}

/// Where something else glows or is drawn than one might expect.
void warn_of_values(const std::filesystem::path& file, const volumes::VolumeFrame& first) {
  if (!first.heat_note.empty() && (!first.heat || first.heat_is_kelvin))
    log_warning(file.string() + ": " + first.heat_note);
  if (!first.value_note.empty()) log_warning(file.string() + ": " + first.value_note);
  for (const std::string& note : first.grid_notes) log_warning(file.string() + ": " + note);
}

/// Where a camera is fitted to the volume, and a part of it lies far outside of the picture.
void warn_of_strays(const std::filesystem::path& file, const volumes::VolumeExtent& extent) {
  if (const std::string note = volumes::stray_note(extent); !note.empty())
    log_warning(file.string() + ": " + note);
}

/// Whether the simulation accepts it.
bool is_near_origin(const voxel::GridLayout& layout) {
  const glm::vec3 high = layout.origin_world + glm::vec3(layout.size) * layout.voxel_size;
  const glm::vec3 most = glm::max(glm::abs(layout.origin_world), glm::abs(high));
  return std::max({most.x, most.y, most.z}) < static_cast<float>(scene::kFarthestEvent);
}

bool covers(const voxel::GridLayout& layout, glm::vec3 at_world) {
  const glm::vec3 high = layout.origin_world + glm::vec3(layout.size) * layout.voxel_size;
  return glm::all(glm::greaterThanEqual(at_world, layout.origin_world)) &&
         glm::all(glm::lessThanEqual(at_world, high));
}

/// Moves smoke whose place was chosen out of what is solid, and warns where it is not seen for all that.
void free_smokes(Scenario& scenario, const std::filesystem::path& file, const FirstViewOptions& options) {
  const scene::SmokeOptions& smoke_options = scenario.timeline.smoke;
  const SmokeView view{options.camera.value_or(scenario.camera), options.aspect, true};
  const float diameter =
      2 * std::cbrt(static_cast<float>(smoke_options.voxels) * 0.75f / std::numbers::pi_v<float>) *
      scenario.timeline.grid.voxel;
  for (scene::SmokeEvent& smoke : scenario.timeline.smokes) {
    smoke.from_world = smoke.at_world =
        nearest_free_place(scenario.voxels.grid, smoke.at_world, smoke_options.voxels / 2)
            .value_or(smoke.at_world);
    if (!is_smoke_seen(scenario.scene, view, smoke.at_world, diameter))
      log_warning(file.string() + ": the smoke is hidden or out of the picture; choose a place with --smoke");
  }
}

Result<Scenario> load_volume(const std::filesystem::path& file, const FirstViewOptions& options) {
  scene::VolumeOptions chosen{file};
  chosen.density = options.density;
  chosen.heat = options.heat;
  chosen.kelvin = options.kelvin.value_or(chosen.kelvin);
  chosen.opacity = options.opacity;
  chosen.range = options.range;
  auto volumes = volumes::Volumes::load(std::array{chosen});
  if (!volumes) return volumes.failure();
  warn_of_values(file, (*volumes)->typical_frame(0));
  if (options.kelvin && !(*volumes)->typical_frame(0).heat)
    log_warning("--kelvin: nothing of " + file.string() + " glows");
  scene::Scene scene;
  (*volumes)->measure_sequence(0);
  const volumes::VolumeExtent extent = (*volumes)->extent(0);
  if (!options.camera) warn_of_strays(file, extent);
  scene::Timeline timeline = prepare_volume_view(file, (*volumes)->typical_frame(0), extent, options);
  if ((*volumes)->is_sequence(0))
    timeline.duration = static_cast<float>((*volumes)->length(0)) / timeline.volumes.front().frame_rate;
  place_volumes(timeline, **volumes, scene);
  apply_level_options(timeline, scene);
  auto scenario = assemble(std::move(timeline), std::move(scene), std::move(*volumes), options.aspect, {});
  if (scenario) scenario->measure_exposure = false;
  return scenario;
}

}  // namespace

Result<voxel::GridLayout> grid_layout(const scene::Timeline& timeline, const scene::Scene& scene) {
  // The margin holds a whole smoke in open air: a ball of its voxels with its soft rim.
  const auto& grid = timeline.grid;
  const int margin =
      2 + static_cast<int>(std::cbrt(static_cast<float>(timeline.smoke.voxels) * 0.75f / 3.14159f) * 1.2f);
  Box<float> bounds = scene::world_bounds(scene);
  auto layout = voxel::layout_around(bounds.low, bounds.high, grid.voxel, margin);
  if (!layout && layout.failure().code == ErrorCode::resource_limit && !scene.volumes.empty()) {
    // Volumes may be larger than any grid of smoke: it covers the level, or the middle of volumes without
    // one.
    constexpr float kVoxels = 128;
    const glm::vec3 middle = 0.5f * (bounds.low + bounds.high);
    bounds = scene::level_bounds(scene);
    if (bounds.empty()) bounds = {middle - kVoxels * grid.voxel, middle + kVoxels * grid.voxel};
    layout = voxel::layout_around(bounds.low, bounds.high, grid.voxel, margin);
  }
  // It reaches to where smoke goes off beside the scene, as far as a grid can.
  if (layout)
    for (const scene::SmokeEvent& smoke : timeline.smokes) {
      if (covers(*layout, smoke.at_world)) continue;
      const Box<float> wider = united(bounds, {smoke.at_world, smoke.at_world});
      const auto larger = voxel::layout_around(wider.low, wider.high, grid.voxel, margin);
      if (!larger || !is_near_origin(*larger)) continue;
      layout = larger;
      bounds = wider;
    }
  if (!layout && !(grid.size && grid.origin_world)) return layout;
  voxel::GridLayout chosen = layout ? *layout : voxel::GridLayout{glm::ivec3(1), grid.voxel, glm::vec3(0)};
  if (grid.size) chosen.size = *grid.size;
  if (grid.origin_world) chosen.origin_world = *grid.origin_world;
  return chosen;
}

bool is_timeline(const std::filesystem::path& path) {
  return scene::lower_extension(path) == ".toml";
}

Result<Scenario> load_scenario(const std::filesystem::path& input, const std::filesystem::path& cache_folder,
                               const FirstViewOptions& options) {
  if (is_timeline(input)) {
    auto timeline = scene::load_timeline(input);
    if (!timeline) return timeline.failure();
    return make_scenario(std::move(*timeline), cache_folder);
  }
  if (grids::is_grid_file(input)) return load_volume(input, options);
  auto scene = scene::load_scene(input);
  if (!scene) return scene.failure();
  const bool is_fitted = !scene->camera;
  scene::Timeline timeline = prepare_first_view(input, *scene, options);
  auto volumes = volumes::Volumes::load({});
  if (!volumes) return volumes.failure();
  auto scenario =
      assemble(std::move(timeline), std::move(*scene), std::move(*volumes), options.aspect, cache_folder);
  if (!scenario) return scenario;
  scenario->camera_is_fitted = is_fitted;
  scenario->measure_exposure = !options.picture.exposure;
  if (options.smokes.empty()) free_smokes(*scenario, input, options);
  return scenario;
}

Result<Scenario> make_scenario(scene::Timeline timeline, const std::filesystem::path& cache_folder) {
  // A file of grids in the place of a scene is a level of nothing.
  const bool is_volume = grids::is_grid_file(timeline.scene);
  if (is_volume && timeline.volumes.empty()) timeline.volumes.push_back({timeline.scene});
  auto scene = is_volume ? Result<scene::Scene>(scene::Scene())
                         : scene::load_scene(timeline.scene, !timeline.volumes.empty());
  if (!scene) return scene.failure();
  auto volumes = volumes::Volumes::load(timeline.volumes);
  if (!volumes) return volumes.failure();
  for (std::size_t i = 0; i < timeline.volumes.size(); ++i)
    warn_of_values(timeline.volumes[i].file, (*volumes)->typical_frame(i));
  // A camera that the timeline leaves to be fitted is to see all frames.
  if (timeline.camera.empty() && !scene->camera)
    for (std::size_t i = 0; i < timeline.volumes.size(); ++i) {
      (*volumes)->measure_sequence(i);
      warn_of_strays(timeline.volumes[i].file, (*volumes)->extent(i));
    }
  place_volumes(timeline, **volumes, *scene);
  apply_level_options(timeline, *scene);
  return assemble(std::move(timeline), std::move(*scene), std::move(*volumes), 16.0f / 9.0f, cache_folder);
}

std::vector<std::filesystem::path> files_of(const Scenario& scenario) {
  std::vector<std::filesystem::path> files = scenario.scene.files;
  if (scenario.volumes)
    for (const std::filesystem::path& file : scenario.volumes->files()) {
      // A description that cannot be read is listed alone; to load it fails.
      const auto all = grids::files_of(file);
      if (all)
        files.insert(files.end(), all->begin(), all->end());
      else
        files.push_back(file);
    }
  for (std::filesystem::path& file : slice_files_of(scenario.timeline)) files.push_back(std::move(file));
  for (const scene::TankOptions& tank : scenario.timeline.tanks)
    for (std::filesystem::path& file : files_of_tank_input(tank.file)) files.push_back(std::move(file));
  for (const scene::ShotEvent& shot : scenario.timeline.shots)
    if (shot.shape == scene::ShotShape::mask) files.push_back(shot.mask);
  for (const auto& [file, opening] : scenario.lens_openings) files.push_back(file);
  for (const scene::TextEvent& text : scenario.timeline.texts)
    files.push_back(text.font.empty() ? image::default_font() : text.font);
  return files;
}

}  // namespace brume::scenario
