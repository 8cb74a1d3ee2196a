#include <algorithm>
#include <cstdio>
#include <optional>

#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "scenario/first_view.hpp"
#include "scenario/voxel_cache.hpp"
#include "scene/files/load.hpp"
#include "voxel/obj_export.hpp"
#include "voxel/voxelize.hpp"

namespace brume::cli {
namespace {

struct VoxelizeOptions {
  std::string scene, grid, origin, output, obj, json;
  float voxel = 0.25f;
  std::optional<double> scale;
};

// Checks as much of the grid layout as possible before the scene is loaded.
void check_options(const VoxelizeOptions& options) {
  if (!options.origin.empty()) parse_point("--origin", options.origin);
  if (options.grid.empty()) {
    if (options.origin.empty()) return;
    throw Error(ErrorCode::usage,
                "--origin requires --grid, such as --grid 120x20x120; give both or neither");
  }
  voxel::check_frame({parse_grid("--grid", options.grid), options.voxel, glm::vec3(0)}).value_or_throw();
}

// The requested grid layout; fits the scene where no option is given.
voxel::GridLayout choose_frame(const VoxelizeOptions& options, const scene::Scene& scene) {
  const Box<float> bounds = scene::world_bounds(scene);
  if (options.grid.empty())
    return voxel::layout_around(bounds.low, bounds.high, options.voxel, 1).value_or_throw();
  voxel::GridLayout frame{parse_grid("--grid", options.grid), options.voxel, {}};
  frame.origin_world = options.origin.empty() ? glm::floor(bounds.low / options.voxel) * options.voxel
                                              : parse_point("--origin", options.origin);
  return frame;
}

// The scene is taken as it is, other than by the commands that show it.
void warn_of_units(const std::string& file, const Box<float>& bounds) {
  if (bounds.empty()) return;
  const glm::vec3 extent = bounds.high - bounds.low;
  const float largest = std::max({extent.x, extent.y, extent.z});
  if (scenario::fitting_scale(largest, to_path(file)) == 1) return;
  char message[160];
  std::snprintf(message, sizeof message, ": %g m wide; if its unit is another, give --scale, such as %g",
                static_cast<double>(largest),
                static_cast<double>(scenario::fitting_scale(largest, to_path(file))));
  log_warning(file + message);
}

/// Why no voxel stops smoke.
std::string why_empty(const scene::Scene& scene) {
  const bool any_solid = std::ranges::any_of(
      scene.objects, [](const scene::Object& object) { return stops_smoke(object.role); });
  return any_solid ? "no voxel is solid: the scene lies outside the grid; move it with --origin"
                   : "no voxel is solid: smoke passes all objects, which are grilles or ghosts";
}

/// What became of the scene, as JSON or in words.
void report(const VoxelizeOptions& options, const scenario::Voxels& voxels, const voxel::GridLayout& frame,
            double seconds) {
  // Glass and grilles are what grids of other roles have and lack.
  const std::uint64_t solid = voxels.grid.count_solid();
  const voxel::Solids solids = voxels.solids();
  const std::uint64_t glass = solid - (voxels.roles.sight ? solids.sight.count_solid() : solid),
                      grilles = (voxels.roles.bodies ? solids.bodies.count_solid() : solid) - solid;
  if (!options.json.empty()) {
    write_json(options.json,
               {{"scene", options.scene},
                {"solid", solid},
                {"glass", glass},
                {"grilles", grilles},
                {"milliseconds", 1000 * seconds},
                {"voxelize_milliseconds", voxels.milliseconds},
                {"triangles", voxels.triangles},
                {"cached", voxels.cached},
                {"grid", Json::list({frame.size.x, frame.size.y, frame.size.z})},
                {"voxel_size", frame.voxel_size},
                {"origin", Json::list({frame.origin_world.x, frame.origin_world.y, frame.origin_world.z})}});
  }
  if (options.json == "-") return;
  // In words.
  char text[200];
  std::snprintf(text, sizeof text, "%llu triangles, %llu solid voxels of %dx%dx%d, %s in %.3g s\n",
                static_cast<unsigned long long>(voxels.triangles), static_cast<unsigned long long>(solid),
                frame.size.x, frame.size.y, frame.size.z,
                voxels.cached ? "loaded from the cache" : "voxelized", seconds);
  print(text);
  if (voxels.roles.empty()) return;
  std::snprintf(text, sizeof text, "%llu of them are glass; %llu other voxels are grilles\n",
                static_cast<unsigned long long>(glass), static_cast<unsigned long long>(grilles));
  print(text);
}

void voxelize(const VoxelizeOptions& options, Outputs& outputs) {
  check_options(options);
  const Stopwatch watch;
  // Declare all files before any work.
  expect_suffix("", options.scene, {".txt", ".gltf", ".glb", ".obj"});
  outputs.reads(to_path(options.scene));
  outputs.writes("-o", to_path(options.output), FileKind::vxl);
  outputs.writes("--obj", to_path(options.obj), FileKind::obj);
  outputs.writes("--json", to_path(options.json), FileKind::json);

  // Load the scene, and voxelize it unless the file is up to date.
  scene::Scene scene =
      scene::load_scene(to_path(options.scene), false, scene::ImageUse::roles).value_or_throw();
  if (options.scale) {
    scenario::scale_scene(scene, static_cast<float>(*options.scale));
  } else {
    warn_of_units(options.scene, scene::world_bounds(scene));
  }
  outputs.reads(scene.files);
  stop_if_interrupted();
  const voxel::GridLayout frame = choose_frame(options, scene);
  const scenario::Voxels voxels =
      scenario::load_or_voxelize(scene, frame, to_path(options.output)).value_or_throw();
  if (voxels.cached) outputs.up_to_date(to_path(options.output));
  stop_if_interrupted();
  if (!options.obj.empty()) (void)voxel::export_obj(voxels.grid, to_path(options.obj)).value_or_throw();

  if (voxels.grid.count_solid() == 0) log_warning(why_empty(scene));
  report(options, voxels, frame, watch.seconds());
}

}  // namespace

Command add_voxelize(CommandLine& program) {
  Command command = declare(
      program, "voxelize", "Finds the solid voxels of a scene.",
      "  brume voxelize room.glb -o room.vxl\n"
      "  brume voxelize room.glb --grid 120x20x120 --voxel 0.5 --origin -30,0,-30 --obj cubes.obj --json -");
  auto options = std::make_shared<VoxelizeOptions>();
  const Arguments& arguments = command.arguments;
  arguments.add_option("SCENE", options->scene, "Scene (.txt, .gltf, .glb, .obj)").required().type_name("");
  arguments
      .add_option("-o,--output", options->output, "Voxel file; loaded instead if the scene has not changed")
      .type_name("FILE");
  // Where the grid lies.
  arguments.add_option("--grid", options->grid, "Grid size in voxels; default: encloses the scene")
      .type_name("XxYxZ");
  arguments.add_option("--voxel", options->voxel, "Edge of a voxel [m]; default 0.25")
      .range(1e-6, 1e6)
      .type_name("M");
  arguments.add_option("--scale", options->scale, "Metres per unit of the scene; default 1")
      .range(1e-6, 1e6)
      .type_name("X");
  arguments
      .add_option("--origin", options->origin, "Minimum corner of the grid [m]; default: that of the scene")
      .type_name("X,Y,Z");
  arguments.add_option("--obj", options->obj, "Write the solid voxels as a mesh").type_name("FILE");
  declare_json(arguments, options->json);
  command.run = [options, common = command.common] { voxelize(*options, common->outputs); };
  return command;
}

}  // namespace brume::cli
