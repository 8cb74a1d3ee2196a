#include <algorithm>
#include <cstdio>

#include "apps/cli/atlas_options.hpp"
#include "apps/cli/bake_inputs.hpp"
#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/units.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/targets.hpp"
#include "bake/occlusion.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

struct OcclusionBake {
  std::string input, size = "64x64x64", box, json;
  std::vector<std::string> objects;
  double margin = 1.5;
  bool separate = false;
  bake::OcclusionOptions options;
  bake::OcclusionCurve curve;
  AtlasOptions atlas;
  UnitOptions units;
};

/// Planes face up and down: a tile is one of them, seen from above.
constexpr grids::AtlasAxes kPlanes{{{0, false}, {2, false}, {1, false}}};

/// The triangles of the chosen objects, or of all.
std::vector<voxel::Triangle> chosen_triangles(const scene::Scene& scene, const OcclusionBake& bake) {
  std::vector<voxel::Triangle> triangles;
  if (bake.objects.empty()) return triangles_of(scene);
  for (const std::string& object : bake.objects) {
    const auto more = triangles_of_object(scene, bake.input, "--object", object);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  return triangles;
}

/// The mesh and a margin around it, of its longest side: beyond, a decal would end visibly.
Box<double> box_of_mesh(std::span<const voxel::Triangle> triangles, const OcclusionBake& bake) {
  const Box<double> bounds = bounds_of(triangles);
  if (bounds.empty()) throw Error(ErrorCode::bad_input, bake.input + ": has no triangles to bake");
  const glm::dvec3 extent = bounds.high - bounds.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) throw Error(ErrorCode::bad_input, bake.input + ": is a single point");
  const double margin = std::max(bake.margin, 1e-3) * longest;
  return {bounds.low - margin, bounds.high + margin};
}

/// The three atlases: combined, up and down, in one image or in three.
struct Targets {
  AtlasTarget combined;
  std::optional<AtlasTarget> up, down;
};

Targets make_targets(const OcclusionBake& bake, glm::uvec3 size, Outputs& outputs) {
  const auto target = [&](const std::string& suffix) {
    AtlasOptions options = bake.atlas;
    std::filesystem::path path = to_path(options.output);
    if (!suffix.empty())
      options.output =
          path.replace_filename(to_path(path.stem().string() + suffix + path.extension().string())).string();
    return atlas_target(options, size, kPlanes, outputs);
  };
  if (!bake.separate) return {target(""), std::nullopt, std::nullopt};
  return {target(""), target("_up"), target("_down")};
}

void save(const OcclusionBake& bake, const Targets& targets, bake::Occlusion occlusion) {
  grids::DenseGrid combined = bake::combine_occlusion(occlusion, bake.curve);
  if (!bake.separate)
    return save_atlas(targets.combined,
                      {std::move(combined), std::move(occlusion.up), std::move(occlusion.down)});
  save_atlas(targets.combined, {std::move(combined)});
  save_atlas(*targets.up, {std::move(occlusion.up)});
  save_atlas(*targets.down, {std::move(occlusion.down)});
}

void bake_occlusion(OcclusionBake bake, const Arguments& arguments, Outputs& outputs) {
  const Stopwatch watch;
  // Check the options and declare all outputs before any work.
  if (!bake.box.empty()) arguments.refuse("--margin", "--box sets the box; give one of the two");
  expect_suffix("", bake.input, {".glb", ".gltf", ".obj", ".txt"});
  outputs.reads(to_path(bake.input));
  const auto given_box = parse_box(bake.box);
  const Targets targets = make_targets(bake, *parse_voxels(bake.size), outputs);
  outputs.writes("--json", to_path(bake.json), FileKind::json);

  // Read the meshes.
  const scene::Scene scene =
      scene::load_scene(to_path(bake.input), false, scene::ImageUse::none).value_or_throw();
  outputs.reads(scene.files);
  stop_if_interrupted();
  const std::vector<voxel::Triangle> triangles = chosen_triangles(scene, bake);
  // Trace, and warn of a box in which nothing is dark.
  bake.options.size = targets.combined.layout.size;
  bake.options.box = given_box ? *given_box : box_of_mesh(triangles, bake);
  bake::Occlusion occlusion = bake::bake_occlusion(triangles, bake.options).value_or_throw();
  stop_if_interrupted();
  if (std::ranges::all_of(occlusion.up.values, [](float value) { return value <= 0; }) &&
      std::ranges::all_of(occlusion.down.values, [](float value) { return value <= 0; }))
    log_warning(bake.input + ": hides nothing from any point of the box");
  save(bake, targets, std::move(occlusion));

  // Report.
  const double seconds = watch.seconds();
  if (!bake.json.empty()) {
    Json json{{"input", bake.input}, {"triangles", triangles.size()}, {"rays", bake.options.rays}};
    json.update(to_json(targets.combined));
    json.set("box", to_json(bake.options.box));
    json.set("milliseconds", 1000 * seconds);
    write_json(bake.json, json);
  }
  if (bake.json == "-") return;
  char text[80];
  std::snprintf(text, sizeof text, " of %zu triangles, %u rays each way, in %.3g s\n", triangles.size(),
                bake.options.rays, seconds);
  print(to_text(targets.combined.layout) + text);
}

void add_bake_options(const Arguments& arguments, OcclusionBake& bake) {
  // What is baked, and the box around it.
  arguments.add_option("--object", bake.objects, "Bake only the objects of this name; repeatable")
      .take_all()
      .type_name("NAME");
  arguments.add_option("--size", bake.size, "Voxels along x, y (planes) and z; default 64x64x64")
      .type_name("XxYxZ");
  arguments
      .add_option("--margin", bake.margin, "Space around the mesh, relative to its longest side; default 1.5")
      .range(0.0, 100.0)
      .type_name("X");
  arguments
      .add_option("--box", bake.box, "Lowest and highest corner of what is baked [m] instead of --margin")
      .type_name("POINTS");
  // How it is traced.
  arguments.add_option("--rays", bake.options.rays, "Rays of a texel, up and down each; default 256")
      .range(1u, 1u << 24)
      .type_name("N");
  arguments.add_option("--seed", bake.options.seed, "Seed of the rays; default 0")
      .range(0u, 4294967295u)
      .type_name("N");
  // How the image combines up and down.
  arguments
      .add_option("--gamma", bake.curve.gamma,
                  "Exponent of the combined occlusion at the middle plane; below 1 darkens; default 1")
      .range(0.1, 10.0)
      .type_name("X");
  arguments
      .add_option("--correction", bake.curve.correction,
                  "How much of --gamma applies at the middle plane; default 1")
      .range(0.0, 1.0)
      .type_name("X");
  arguments
      .add_option("--falloff", bake.curve.falloff,
                  "How fast that fades towards the first and last plane; default 1")
      .range(0.0, 100.0)
      .type_name("X");
  arguments.add_flag("--separate", bake.separate,
                     "Three images of one channel, FILE, FILE_up and FILE_down, instead of one with all");
}

}  // namespace

Command add_bake_occlusion(CommandLine& program) {
  Command command =
      declare(program, "bake occlusion",
              "Writes the ambient occlusion around a mesh, on planes that face up and down, as tiles.",
              "  brume bake occlusion scenes/flyby/drone.glb -o drone_ao.png\n"
              "  brume bake occlusion scenes/flyby/drone.glb -o ao.png --separate --gamma 0.7 --falloff 2\n"
              "  brume bake occlusion room.glb -o room_ao.exr --size 32x16x32 --rays 64 --preset unity");
  auto bake = std::make_shared<OcclusionBake>();
  const Arguments& arguments = command.arguments;
  arguments.add_option("INPUT", bake->input, "Meshes (.glb, .gltf, .obj, .txt)").required().type_name("");
  declare_atlas_options(arguments, bake->atlas);
  add_bake_options(arguments, *bake);
  declare_units(arguments, bake->units, "numbered files, such as pose_%04d.glb");
  declare_json(arguments, bake->json);
  command.run = [bake, arguments, common = command.common] {
    // Each unit bakes a copy with its own files.
    expect_suffix("-o", bake->atlas.output, {".png", ".exr"});
    run_units(arguments, bake->units, *common,
              {bake->input,
               "-o",
               bake->atlas.output,
               target_file_kind(to_path(bake->atlas.output)),
               {},
               {kAtlasDescription}},
              [&](const Unit& unit, Outputs& outputs) {
                OcclusionBake one = *bake;
                one.input = unit.input;
                one.atlas.output = unit.output;
                bake_occlusion(one, arguments, outputs);
              });
  };
  return command;
}

}  // namespace brume::cli
