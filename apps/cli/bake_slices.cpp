#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/cli/atlas_options.hpp"
#include "apps/cli/bake_inputs.hpp"
#include "apps/cli/command.hpp"
#include "apps/cli/info.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/units.hpp"
#include "apps/cli/volumes.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/targets.hpp"
#include "bake/coverage.hpp"
#include "core/log.hpp"
#include "core/numbered_files.hpp"
#include "core/similar.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

struct SliceOptions {
  std::string input, size, box, channels, json;
  AtlasOptions atlas;
  UnitOptions units;
};

/// What goes into one channel.
struct ChannelChoice {
  std::string name;     ///< Name of an object or a grid; empty: all objects.
  std::size_t channel;  ///< 0 to 3: R, G, B, A.
};

std::vector<ChannelChoice> parse_channels(const std::string& text) {
  constexpr std::string_view kLetters = "rgba";
  std::vector<ChannelChoice> choices;
  std::string parts = text.empty() ? "" : text + ",";
  for (std::size_t end = 0; (end = parts.find(',')) != std::string::npos; parts.erase(0, end + 1)) {
    const std::string part = parts.substr(0, end);
    const std::size_t colon = part.rfind(':');
    const std::size_t letter = colon != std::string::npos && colon + 2 == part.size()
                                   ? kLetters.find(part.back())
                                   : std::string::npos;
    if (letter == std::string::npos || colon == 0)
      throw Error(ErrorCode::usage, "--channels '" + text +
                                        "': expected names and channels r, g, b or a, such as ring:r,beam:g");
    choices.push_back({part.substr(0, colon), letter});
  }
  for (std::size_t channel = 0; channel < choices.size(); ++channel)
    if (std::ranges::none_of(choices, [&](const ChannelChoice& one) { return one.channel == channel; }) &&
        std::ranges::any_of(choices, [&](const ChannelChoice& one) { return one.channel > channel; }))
      throw Error(ErrorCode::usage, "--channels '" + text + "': channel " + "rgba"[channel] +
                                        " is empty; use r, then g, b and a");
  return choices;
}

/// The triangles of the objects of one channel.
struct MeshChannel {
  std::string name;
  std::vector<voxel::Triangle> triangles;
};

std::vector<MeshChannel> mesh_channels(const scene::Scene& scene, const std::string& file,
                                       const std::vector<ChannelChoice>& choices) {
  if (choices.empty()) return {{"density", triangles_of(scene)}};
  std::vector<MeshChannel> channels;
  for (const ChannelChoice& choice : choices) {
    channels.resize(std::max(channels.size(), choice.channel + 1));
    MeshChannel& channel = channels[choice.channel];
    channel.name += (channel.name.empty() ? "" : "+") + choice.name;
    const auto triangles = triangles_of_object(scene, file, "--channels", choice.name);
    channel.triangles.insert(channel.triangles.end(), triangles.begin(), triangles.end());
  }
  return channels;
}

/// The bounds of all triangles and a voxel around them, so that nothing is cut and what is filtered ends at
/// 0.
Box<double> box_around(const std::vector<MeshChannel>& channels, glm::uvec3 size, const std::string& file) {
  std::vector<voxel::Triangle> all;
  for (const MeshChannel& channel : channels)
    all.insert(all.end(), channel.triangles.begin(), channel.triangles.end());
  Box<double> bounds = bounds_of(all);
  if (bounds.empty()) throw Error(ErrorCode::bad_input, file + ": has no triangles to bake");
  const glm::dvec3 extent = bounds.high - bounds.low;
  const double largest = std::max({extent.x, extent.y, extent.z, 1e-6});
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = size[axis];
    const double wide = std::max(extent[axis], 1e-3 * largest);
    const double margin = 0.5 * (wide - extent[axis]) + (voxels > 2 ? wide / (voxels - 2) : 0);
    bounds.low[axis] -= margin;
    bounds.high[axis] += margin;
  }
  return bounds;
}

/// 64 x 64 texels in 32 tiles.
glm::uvec3 default_size(const grids::AtlasAxes& axes) {
  glm::uvec3 size(64);
  size[axes[2].axis] = 32;
  return size;
}

struct Baked {
  AtlasTarget target;
  Box<double> box;
  std::vector<std::string> channels;
};

Baked bake_mesh(const SliceOptions& options, Outputs& outputs) {
  // Check the options before the scene is read.
  const auto size = parse_voxels(options.size);
  const auto box = parse_box(options.box);
  const auto choices = parse_channels(options.channels);
  const grids::AtlasAxes axes = axes_of(options.atlas, grids::kUprightAxes);
  const AtlasTarget target =
      atlas_target(options.atlas, size.value_or(default_size(axes)), grids::kUprightAxes, outputs);
  const scene::Scene scene =
      scene::load_scene(to_path(options.input), false, scene::ImageUse::none).value_or_throw();
  outputs.reads(scene.files);
  stop_if_interrupted();

  // Measure the coverage of each channel.
  Baked baked{target, {}, {}};
  const std::vector<MeshChannel> channels = mesh_channels(scene, options.input, choices);
  baked.box = box ? *box : box_around(channels, target.layout.size, options.input);
  std::vector<grids::DenseGrid> grids;
  for (const MeshChannel& channel : channels) {
    bake::Coverage coverage = bake::mesh_coverage(channel.triangles, baked.box, target.layout.size);
    if (const std::string fault = coverage.faults.text(); !fault.empty())
      log_warning(options.input + ": " + channel.name + " " + fault);
    if (std::ranges::all_of(coverage.grid.values, [](float value) { return value <= 0; }))
      log_warning(options.input + ": " + channel.name + " fills nothing of the box");
    coverage.grid.name = channel.name;
    baked.channels.push_back(channel.name);
    grids.push_back(std::move(coverage.grid));
    stop_if_interrupted();
  }
  save_atlas(target, std::move(grids));
  return baked;
}

/// The grids that are chosen, or the first ones; R first.
std::vector<const grids::Grid*> volume_channels(const grids::GridFile& file, const std::string& name,
                                                const std::vector<ChannelChoice>& choices) {
  std::vector<const grids::Grid*> channels;
  // Without a choice: all grids in their order, as far as there are channels.
  if (choices.empty()) {
    for (const grids::Grid& grid : file.grids) channels.push_back(&grid);
    if (channels.empty()) throw Error(ErrorCode::bad_input, name + ": has no grids");
    if (channels.size() > grids::kMostAtlasChannels)
      throw Error(ErrorCode::usage, name + ": has " + std::to_string(channels.size()) +
                                        " grids; choose up to 4 with --channels, such as " +
                                        printable(channels.front()->name) + ":r");
    return channels;
  }
  // Find the chosen ones, each for its own channel.
  std::vector<std::string> known;
  for (const grids::Grid& grid : file.grids) known.push_back(printable(grid.name));
  channels.resize(choices.size(), nullptr);
  for (const ChannelChoice& choice : choices) {
    const auto grid = std::ranges::find(file.grids, choice.name, &grids::Grid::name);
    if (grid == file.grids.end())
      throw Error(ErrorCode::usage, "--channels " + choice.name + ": " + name + " has no such grid" +
                                        suggestion(choice.name, known, ""));
    if (choice.channel >= channels.size() || channels[choice.channel])
      throw Error(ErrorCode::usage, "--channels: one grid for each channel");
    channels[choice.channel] = &*grid;
  }
  return channels;
}

/// What the voxels of a volume cover, or all frames of its sequence, or the part of it in the box that is
/// given in the world.
grids::GridBox volume_box(const SliceOptions& options, const std::vector<const grids::Grid*>& channels,
                          const std::optional<grids::GridBox>& of_sequence) {
  auto box = of_sequence ? Result<grids::GridBox>(*of_sequence) : grids::box_of(channels);
  if (!box) throw Error(box.failure().code, options.input + ": " + box.failure().message);
  const auto size = parse_voxels(options.size);
  if (const auto given = parse_box(options.box)) {
    if (box->world_from_box != glm::dmat4(1))
      throw Error(ErrorCode::usage,
                  "--box: " + options.input +
                      " is rotated against the axes of the world; leave the option out to bake its own box");
    const glm::dvec3 voxel = (box->box.high - box->box.low) / glm::dvec3(box->size);
    box->size = glm::uvec3(
        glm::clamp(glm::round((given->high - given->low) / voxel), glm::dvec3(1), glm::dvec3(16384)));
    box->box = *given;
  }
  if (size) box->size = *size;
  return *box;
}

/// What all frames of a sequence have in common, so that nothing jumps from one to the next.
struct SequenceBake {
  std::optional<grids::GridBox> box;      ///< Encloses every frame; empty: each frame has its own.
  std::vector<grids::AtlasRange> ranges;  ///< Range of each channel.
};

/// The range of all finite values of a grid, widened to contain [0, 1].
grids::AtlasRange range_of_values(const grids::Grid& grid) {
  double low = 0, high = 1;
  const auto add = [&](const std::byte* value) {
    const double number = grids::to_number(grid.type, value);
    if (!std::isfinite(number)) return;
    low = std::min(low, number);
    high = std::max(high, number);
  };
  for (std::size_t brick = 0; brick < grid.bricks.size(); ++brick) {
    const auto values = grid.values_of(brick);
    const std::size_t each = grids::bytes_of(grid.type);
    for (std::size_t at = 0; each > 0 && at + each <= values.size(); at += each) add(values.data() + at);
  }
  for (const grids::Tile& tile : grid.tiles) add(tile.value.data());
  return {static_cast<float>(low), static_cast<float>(high)};
}

bool is_near(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::all(glm::lessThanEqual(glm::abs(a - b), 1e-4 * glm::abs(a)));
}

/// Around both, in the voxels of the first; nullopt: their axes or voxels differ.
std::optional<grids::GridBox> united_boxes(const grids::GridBox& a, const grids::GridBox& b) {
  const auto voxel_of = [](const grids::GridBox& one) {
    return (one.box.high - one.box.low) / glm::dvec3(one.size);
  };
  if (a.world_from_box != b.world_from_box || !is_near(voxel_of(a), voxel_of(b))) return std::nullopt;
  grids::GridBox all = a;
  all.box = united(a.box, b.box);
  all.size = glm::uvec3(glm::max(glm::round((all.box.high - all.box.low) / voxel_of(a)), glm::dvec3(1)));
  return all;
}

/// The grids of one frame; nullopt if it cannot be read, which is reported when that frame is baked.
std::optional<grids::GridFile> readable_frame(const std::filesystem::path& file) {
  try {
    Outputs ignored;
    return load_volumes(file, ignored);
  } catch (const Error&) {
    return std::nullopt;
  }
}

SequenceBake measure_sequence(const SliceOptions& options) {
  const auto choices = parse_channels(options.channels);
  SequenceBake all;
  bool is_first = true;
  for (const auto& [number, file] : numbered_files(to_path(options.input))) {
    stop_if_interrupted();
    const auto grids = readable_frame(file);
    if (!grids) continue;
    const std::vector<const grids::Grid*> channels = volume_channels(*grids, file.string(), choices);
    all.ranges.resize(channels.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const grids::AtlasRange own = range_of_values(*channels[i]);
      all.ranges[i] = {std::min(all.ranges[i].low, own.low), std::max(all.ranges[i].high, own.high)};
    }
    // A frame of nothing has no box.
    const auto box = grids::box_of(channels);
    if (!options.box.empty() || !box) continue;
    all.box = is_first ? *box : all.box ? united_boxes(*all.box, *box) : std::nullopt;
    is_first = false;
  }
  if (!all.box && !is_first)
    log_warning(options.input +
                ": the voxels of its frames differ: each is baked in a box of its own; give --box");
  return all;
}

std::vector<std::string> to_texts(const SequenceBake& sequence) {
  std::vector<std::string> texts;
  for (const grids::AtlasRange& range : sequence.ranges)
    texts.push_back(Json(range.low).text() + " " + Json(range.high).text());
  if (sequence.box) {
    texts.push_back(to_json(sequence.box->box).text());
    for (int axis = 0; axis < 3; ++axis) texts.push_back(std::to_string(sequence.box->size[axis]));
  }
  return texts;
}

Baked bake_volume(const SliceOptions& options, const SequenceBake* sequence, Outputs& outputs) {
  parse_voxels(options.size);
  parse_box(options.box);
  const auto choices = parse_channels(options.channels);
  check_atlas_options(options.atlas);
  const grids::GridFile file = load_volumes(to_path(options.input), outputs);
  stop_if_interrupted();
  const std::vector<const grids::Grid*> channels = volume_channels(file, options.input, choices);
  const grids::GridBox box = volume_box(options, channels, sequence ? sequence->box : std::nullopt);
  Baked baked{atlas_target(options.atlas, box.size, grids::kUprightAxes, outputs), box.box, {}};
  std::vector<grids::DenseGrid> grids;
  for (const grids::Grid* grid : channels) {
    auto dense = grids::resample(*grid, box);
    if (!dense) throw Error(dense.failure().code, options.input + ": " + dense.failure().message);
    baked.channels.push_back(grid->name);
    grids.push_back(std::move(*dense));
    stop_if_interrupted();
  }
  if (sequence && baked.target.ranges.empty()) baked.target.ranges = sequence->ranges;
  save_atlas(baked.target, std::move(grids), box.world_from_box);
  return baked;
}

/// `sequence`: null for a single file.
void bake_slices(const SliceOptions& options, const SequenceBake* sequence, Outputs& outputs) {
  const Stopwatch watch;
  const bool is_volume = grids::is_grid_file(to_path(options.input));
  if (!is_volume)
    expect_suffix("", options.input,
                  {".glb", ".gltf", ".obj", ".txt", ".vdb", ".nvdb", ".brv", ".json", ".spheres"});
  outputs.reads(to_path(options.input));
  outputs.writes("--json", to_path(options.json), FileKind::json);
  const Baked baked = is_volume ? bake_volume(options, sequence, outputs) : bake_mesh(options, outputs);

  const double seconds = watch.seconds();
  if (!options.json.empty()) {
    Json json{{"input", options.input}};
    json.update(to_json(baked.target));
    json.set("channels", baked.channels);
    json.set("box", to_json(baked.box));
    json.set("milliseconds", 1000 * seconds);
    write_json(options.json, json);
  }
  if (options.json == "-") return;
  char text[40];
  std::snprintf(text, sizeof text, ", in %.3g s\n", seconds);
  print(to_text(baked.target.layout) + text);
}

}  // namespace

Command add_bake_slices(CommandLine& program) {
  Command command = declare(
      program, "bake slices", "Writes the slices of closed meshes or of a volume as tiles of an image.",
      "  brume bake slices scenes/thruster/thruster.glb -o thruster.png --channels ring:r,beam:g\n"
      "  brume bake slices smoke.vdb -o smoke.exr --preset unreal\n"
      "  brume bake slices smoke_%04d.vdb -o slices_%04d.png --frames 0-1 --resume\n"
      "  brume bake slices room.glb -o room.png --size 64x32x64 --layout square --bits 16");
  auto options = std::make_shared<SliceOptions>();
  const Arguments& arguments = command.arguments;
  // Inputs and channels.
  arguments
      .add_option("INPUT", options->input,
                  "Closed meshes (.glb, .gltf, .obj, .txt) or a volume (.vdb, .nvdb, .brv, .json)")
      .required()
      .type_name("");
  declare_atlas_options(arguments, options->atlas);
  arguments
      .add_option(
          "--channels", options->channels,
          "Objects of a scene, or grids of a volume, and the channels r, g, b, a that they fill; default: "
          "all objects in one, the first grids")
      .type_name("NAME:r,..");
  arguments
      .add_option("--size", options->size,
                  "Voxels along x, y and z; default: 64 and 32 tiles for meshes, those of a volume")
      .type_name("XxYxZ");
  arguments
      .add_option(
          "--box", options->box,
          "Lowest and highest corner of what is baked [m]; default: all, of meshes with a voxel around")
      .type_name("POINTS");
  declare_units(arguments, options->units, "numbered files, such as smoke_%04d.vdb");
  declare_json(arguments, options->json);
  // A sequence has one range of values and one box, so that its frames fit together: measure all of it first.
  command.run = [options, arguments, common = command.common] {
    expect_suffix("-o", options->atlas.output, {".png", ".exr"});
    std::optional<SequenceBake> sequence;
    if (is_numbered("-o", to_path(options->atlas.output)) && grids::is_grid_file(to_path(options->input))) {
      check_atlas_options(options->atlas);
      sequence = measure_sequence(*options);
    }
    run_units(arguments, options->units, *common,
              {.input = options->input,
               .output_option = "-o",
               .output = options->atlas.output,
               .kind = target_file_kind(to_path(options->atlas.output)),
               .device = {},
               .beside = {kAtlasDescription},
               .holds_missing = true,
               .depends_on = sequence ? to_texts(*sequence) : std::vector<std::string>()},
              [&](const Unit& unit, Outputs& outputs) {
                SliceOptions one = *options;
                one.input = unit.input;
                one.atlas.output = unit.output;
                bake_slices(one, sequence ? &*sequence : nullptr, outputs);
              });
  };
  return command;
}

}  // namespace brume::cli
