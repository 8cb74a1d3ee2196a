#include <algorithm>
#include <cstdio>
#include <optional>

#include "apps/cli/atlas_options.hpp"
#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/units.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "passes/generate_cloud.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

struct BakeOptions {
  std::string shape, output, json, device;
  grids::CloudSettings cloud;
  std::optional<double> radius, softness;
  bool binary = false, gpu = false;
  UnitOptions units;
};

const std::vector<std::string> kShapes{"pyroclastic", "sphere", "slab", "torus"};

FileKind kind_of(const std::string& file) {
  const std::string suffix = scene::lower_extension(to_path(file));
  return suffix == ".png"    ? FileKind::png
         : suffix == ".vdb"  ? FileKind::vdb
         : suffix == ".nvdb" ? FileKind::nvdb
                             : FileKind::brv;
}

void refuse_idle_options(const BakeOptions& options, const Arguments& arguments) {
  if (options.binary) arguments.refuse("--edge-softness", "would do nothing with --binary");
  if (options.shape != kShapes.front())
    for (const char* option : {"--seed", "--octaves", "--amplitude", "--frequency", "--gain", "--lacunarity"})
      arguments.refuse(option, "is for the shape pyroclastic");
  if (!options.gpu) arguments.refuse("--device", "requires --gpu");
}

// The displacement of a pyroclastic cloud rarely exceeds its amplitude: a quarter of the cube leaves room for
// it.
grids::CloudSettings make_settings(const BakeOptions& options) {
  grids::CloudSettings cloud = options.cloud;
  const auto shape = std::find(kShapes.begin(), kShapes.end(), options.shape) - kShapes.begin();
  cloud.kind = static_cast<grids::CloudKind>(shape);
  const double side = cloud.edge * cloud.voxel_size;
  cloud.radius = options.radius.value_or(side * (cloud.kind == grids::CloudKind::pyroclastic ? 0.28 : 0.4));
  cloud.edge_width = options.binary ? 0 : options.softness.value_or(2 * cloud.voxel_size);
  return cloud;
}

grids::Grid generate(const BakeOptions& options, const grids::CloudSettings& settings) {
  if (!options.gpu) return grids::generate_cloud(settings);
  gpu::Context context(gpu::ContextOptions{options.device, false});
  gpu::CommandRunner runner(context);
  passes::CloudGenerator generator(context);
  return grids::generate_cloud(
      settings, [&](const shared::CloudParams& params, std::span<const glm::ivec3> bricks,
                    std::span<float> values) { generator.evaluate(runner, params, bricks, values); });
}

void warn_of_what_is_missing(const grids::Grid& grid, const grids::CloudSettings& settings) {
  const Box<double> bounds = grids::active_bounds(grid);
  const double end = settings.edge - 1.0;
  if (bounds.empty()) {
    log_warning("no voxel has density; give a larger --radius or smaller voxels");
  } else if (glm::any(glm::lessThan(bounds.low, glm::dvec3(0))) ||
             glm::any(glm::greaterThan(bounds.high, glm::dvec3(end)))) {
    log_warning(
        "the shape reaches the sides of its cube, where it may be cut; give a smaller --radius or a larger "
        "--edge");
  }
}

AtlasTarget slice_target(const std::string& output, std::uint32_t edge, Outputs& outputs) {
  AtlasOptions options;
  options.output = output;
  options.layout = "square";
  return atlas_target(options, glm::uvec3(edge), grids::kUprightAxes, outputs);
}

/// All of the cube, what is empty included.
void save_slices(const AtlasTarget& target, const grids::Grid& grid, const grids::CloudSettings& settings) {
  const glm::dvec3 low = glm::dvec3(grid.world_from_index * glm::dvec4(glm::dvec3(-0.5), 1));
  const grids::GridBox cube{
      glm::dmat4(1), {low, low + settings.edge * settings.voxel_size}, glm::uvec3(settings.edge)};
  save_atlas(target, {grids::resample(grid, cube).value_or_throw()});
}

void bake(const BakeOptions& options, const Arguments& arguments, Outputs& outputs) {
  const Stopwatch watch;
  refuse_idle_options(options, arguments);
  expect_suffix("-o", options.output, {".brv", ".vdb", ".nvdb", ".png"});
  // Declare all outputs before any work.
  const grids::CloudSettings settings = make_settings(options);
  const bool is_atlas = kind_of(options.output) == FileKind::png;
  std::optional<AtlasTarget> atlas;
  if (is_atlas)
    atlas = slice_target(options.output, settings.edge, outputs);
  else
    outputs.writes("-o", to_path(options.output), kind_of(options.output));
  outputs.writes("--json", to_path(options.json), FileKind::json);

  // Generate and write it.
  grids::Grid grid = generate(options, settings);
  stop_if_interrupted();
  warn_of_what_is_missing(grid, settings);
  const std::uint64_t active = grids::count_active(grid), bricks = grid.bricks.size();
  if (atlas) {
    save_slices(*atlas, grid, settings);
  } else {
    grids::GridFile file;
    file.grids.push_back(std::move(grid));
    grids::save_grid_file(to_path(options.output), file).value_or_throw();
  }

  // Report.
  const double seconds = watch.seconds();
  if (!options.json.empty())
    write_json(options.json, {{"output", options.output},
                              {"shape", options.shape},
                              {"edge", settings.edge},
                              {"voxel_size", settings.voxel_size},
                              {"radius", settings.radius},
                              {"active_voxels", active},
                              {"bricks", bricks},
                              {"milliseconds", 1000 * seconds}});
  if (options.json == "-") return;
  char text[200];
  std::snprintf(text, sizeof text, "%s of radius %g m, %llu active voxels in %llu bricks, in %.3g s\n",
                options.shape.c_str(), settings.radius, static_cast<unsigned long long>(active),
                static_cast<unsigned long long>(bricks), seconds);
  print(text);
}

// What computes the numbers.
std::vector<std::string> device_of(const BakeOptions& options) {
  if (!options.gpu) return {};
  const gpu::Context context(gpu::ContextOptions{options.device, false});
  return {context.info().name, context.info().driver};
}

void add_shape_options(const Arguments& arguments, BakeOptions& options) {
  grids::CloudSettings& cloud = options.cloud;
  // The shape.
  arguments.add_option("--edge", cloud.edge, "Voxels along each side of the cube; default 128")
      .range(1u, grids::kMaxCloudEdge)
      .type_name("N");
  arguments.add_option("--voxel", cloud.voxel_size, "Edge of a voxel [m]; default 0.05")
      .range(1e-6, 1e6)
      .type_name("M");
  arguments
      .add_option(
          "--radius", options.radius,
          "Radius [m], of a pyroclastic cloud before its displacement; default: 0.28 of the cube's side, "
          "0.4 for the other shapes")
      .range(1e-6, 1e9)
      .type_name("M");
  arguments
      .add_option("--edge-softness", options.softness,
                  "Depth below the surface where density reaches 1 [m]; default: two voxels")
      .range(1e-9, 1e9)
      .type_name("M");
  arguments.add_flag("--binary", options.binary, "Density is 1 up to the surface");
  // The noise of a pyroclastic cloud.
  arguments.add_option("--seed", cloud.seed, "Seed of the noise; default 0")
      .range(0u, 4294967295u)
      .type_name("N");
  arguments.add_option("--octaves", cloud.octaves, "Octaves of the noise; default 6")
      .range(1u, grids::kMaxCloudOctaves)
      .type_name("N");
  arguments.add_option("--amplitude", cloud.amplitude, "Displacement where |fBm| is 1, in radii; default 0.6")
      .range(0.0, 10.0)
      .type_name("X");
  arguments
      .add_option("--frequency", cloud.frequency, "Noise cells of the first octave per radius; default 1.5")
      .range(0.01, 100.0)
      .type_name("X");
  arguments.add_option("--gain", cloud.gain, "Weight of each octave relative to the one before; default 0.5")
      .range(0.0, 1.0)
      .type_name("X");
  arguments
      .add_option("--lacunarity", cloud.lacunarity,
                  "Frequency of each octave relative to the one before; default 2")
      .range(1.0, 4.0)
      .type_name("X");
}

std::vector<FileBeside> description_beside(const std::string& output) {
  if (kind_of(output) != FileKind::png) return {};
  return {kAtlasDescription};
}

}  // namespace

Command add_bake(CommandLine& program) {
  Command command =
      declare(program, "bake",
              "Writes a cloud or a simple shape of fog as a volume (see also bake slices, bake occlusion).",
              "  brume bake pyroclastic -o cloud.brv\n"
              "  brume bake pyroclastic -o slices.png --edge 96 --seed 7 --octaves 7 --amplitude 1\n"
              "  brume bake sphere -o ball.brv --edge 64 --voxel 0.1 --radius 3 --binary --json -");
  auto options = std::make_shared<BakeOptions>();
  const Arguments& arguments = command.arguments;
  arguments.add_option("SHAPE", options->shape, "pyroclastic, sphere, slab or torus")
      .required()
      .one_of(kShapes)
      .type_name("");
  arguments
      .add_option(
          "-o,--output", options->output,
          "Volume (.brv, .vdb, .nvdb), or its slices as tiles of an image and their description (.png)")
      .required()
      .type_name("FILE");
  add_shape_options(arguments, *options);
  arguments.add_flag("--gpu", options->gpu,
                     "Evaluate the formula on a Vulkan device: values differ by rounding");
  arguments.add_option("--device", options->device, "Device of --gpu by number or name (see brume devices)")
      .type_name("NAME");
  declare_units(arguments, options->units,
                "numbered clouds, such as cloud_%04d.brv; it is added to the seed");
  declare_json(arguments, options->json);
  command.run = [options, arguments, common = command.common] {
    run_units(arguments, options->units, *common,
              {"", "-o", options->output, kind_of(options->output), device_of(*options),
               description_beside(options->output)},
              [&](const Unit& unit, Outputs& outputs) {
                // Frames of a shape without a seed would all be the same.
                if (unit.number && options->shape != kShapes.front())
                  arguments.refuse("--frames", "is for the shape pyroclastic: others have no seed");
                BakeOptions one = *options;
                one.output = unit.output;
                one.cloud.seed += unit.number.value_or(0);
                bake(one, arguments, outputs);
              });
  };
  return command;
}

}  // namespace brume::cli
