#include <algorithm>
#include <cstdio>

#include "apps/cli/command.hpp"
#include "apps/cli/convert_film.hpp"
#include "apps/cli/info.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/tanks.hpp"
#include "apps/cli/units.hpp"
#include "apps/cli/volumes.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/files/raw_file.hpp"
#include "scene/files/load.hpp"
#include "spheres/file.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string input, output, json, fps = "24";
  std::vector<std::string> grids;
  UnitOptions units;
};

FileKind kind_of(const fs::path& path) {
  const std::string suffix = scene::lower_extension(path);
  return suffix == kVdb    ? FileKind::vdb
         : suffix == kNvdb ? FileKind::nvdb
         : suffix == kBrv  ? FileKind::brv
                           : FileKind::json;
}

// Keeps the grids with these names. Several may have one name.
void select(grids::GridFile& file, const std::string& input, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::string known;
  for (const grids::Grid& grid : file.grids) known += (known.empty() ? "" : ", ") + printable(grid.name);
  for (const std::string& name : names)
    if (std::none_of(file.grids.begin(), file.grids.end(),
                     [&](const auto& grid) { return grid.name == name; }))
      throw Error(ErrorCode::usage, "--grid " + name + ": " + input + " has no such grid; it has " +
                                        (known.empty() ? "none" : known));
  std::erase_if(file.grids, [&](const grids::Grid& grid) {
    return std::find(names.begin(), names.end(), grid.name) == names.end();
  });
}

void save(const fs::path& path, const grids::GridFile& file) {
  if (!grids::is_raw_description(path)) return grids::save_grid_file(path, file).value_or_throw();
  const auto has_first_name = [&](const grids::Grid& grid) { return grid.name == file.grids.front().name; };
  if (file.grids.size() > 1 && std::ranges::all_of(file.grids, has_first_name))
    throw Error(ErrorCode::usage, path.string() + ": a raw file holds one grid, but " +
                                      std::to_string(file.grids.size()) + " have the name " +
                                      printable(file.grids.front().name) +
                                      "; convert to .vdb, .nvdb or .brv");
  if (file.grids.size() != 1)
    throw Error(ErrorCode::usage, path.string() + ": a raw file holds one grid, not " +
                                      std::to_string(file.grids.size()) + "; choose it with --grid");
  grids::save_raw(path, file.grids.front()).value_or_throw();
}

void convert(const ConvertOptions& options, Outputs& outputs) {
  const Stopwatch watch;
  // Check the files and declare all outputs before any work.
  expect_suffix("", options.input, {kVdb, kNvdb, kBrv, kJson, ".png", ".exr", ".spheres"});
  expect_suffix("", options.output, {kVdb, kNvdb, kBrv, kJson});
  const fs::path output = to_path(options.output);
  outputs.reads(to_path(options.input));
  outputs.writes("", output, kind_of(output));
  if (grids::is_raw_description(output)) outputs.writes("", grids::raw_path_of(output), FileKind::raw);
  outputs.writes("--json", to_path(options.json), FileKind::json);

  // Convert.
  grids::GridFile file = load_volumes(to_path(options.input), outputs);
  stop_if_interrupted();
  select(file, options.input, options.grids);
  save(output, file);

  // Report.
  const double seconds = watch.seconds();
  std::uint64_t active = 0;
  for (const grids::Grid& grid : file.grids) active += count_active(grid);
  if (!options.json.empty()) {
    Json grids = Json::list({});
    for (const grids::Grid& grid : file.grids) grids.push_back(grid.name);
    write_json(options.json, {{"input", options.input},
                              {"output", options.output},
                              {"grids", grids},
                              {"active_voxels", active},
                              {"bytes", std::uint64_t{fs::file_size(output)}},
                              {"milliseconds", 1000 * seconds}});
  }
  if (options.json == "-") return;
  char text[120];
  std::snprintf(text, sizeof text, "%zu %s, %llu active voxels, in %.3g s\n", file.grids.size(),
                file.grids.size() == 1 ? "grid" : "grids", static_cast<unsigned long long>(active), seconds);
  print(text);
}

void convert_one(ConvertOptions options, const Arguments& arguments, const Unit& unit, Outputs& outputs) {
  options.input = unit.input;
  options.output = unit.output;
  const std::string suffix = scene::lower_extension(to_path(options.output));
  const bool is_volume = suffix == kVdb || suffix == kNvdb || suffix == kBrv || suffix == kJson;
  if (is_volume || !spheres::is_tank_file(to_path(options.input))) return convert(options, outputs);
  arguments.refuse("--grid", "is for volumes");
  convert_tank(options.input, options.output, options.json, outputs);
}

FileKind output_kind(const fs::path& path) {
  const std::string suffix = scene::lower_extension(path);
  return suffix == ".obj" ? FileKind::obj : suffix == ".ply" ? FileKind::ply : kind_of(path);
}

// The array of a description.
std::vector<FileBeside> array_beside(const fs::path& output) {
  if (!grids::is_raw_description(output)) return {};
  return {{grids::raw_path_of(output).extension().string(), FileKind::raw}};
}

void refuse_idle_for_film(const Arguments& arguments) {
  for (const char* option : {"--shard", "--resume"})
    arguments.refuse(option, "a film is a single output; remove the option");
  for (const char* option : {"--grid", "--json"}) arguments.refuse(option, "is for volumes");
}

}  // namespace

Command add_convert(CommandLine& program) {
  Command command = declare(
      program, "convert",
      "Converts volumes among .vdb, .nvdb, .brv and raw arrays (.json), tanks, and numbered frames to films.",
      "  brume convert smoke.vdb smoke.brv\n"
      "  brume convert atlas.json smoke.vdb\n"
      "  brume convert smoke.vdb density.json --grid density\n"
      "  brume convert tank.spheres tank.ply\n"
      "  brume convert smoke_%04d.vdb smoke_%04d.brv --frames 0-1 --resume\n"
      "  brume convert frame_%04d.png film.mp4 --frames 0-1");
  auto options = std::make_shared<ConvertOptions>();
  const Arguments& arguments = command.arguments;
  arguments
      .add_option("INPUT", options->input,
                  "Volume file (.vdb, .nvdb, .brv, .json of a raw array or slice atlas), tank (.spheres), or "
                  "frames (.png with %04d)")
      .required()
      .type_name("");
  arguments
      .add_option(
          "OUTPUT", options->output,
          "Volume file to write; a .json file describes the .raw file written beside it. Of a tank, meshes "
          "(.obj) or points (.ply); of frames, a film (.mp4). With %04d: one file for each of the input")
      .required()
      .type_name("");
  arguments.add_option("--grid", options->grids, "Convert only the grids of this name; repeatable")
      .take_all()
      .type_name("NAME");
  arguments.add_option("--fps", options->fps, "Frames per second of a film; default 24").type_name("F");
  declare_units(arguments, options->units, "numbered files, such as smoke_%04d.vdb");
  declare_json(arguments, options->json);
  // A film, or units of volumes.
  command.run = [options, arguments, common = command.common] {
    if (scene::lower_extension(to_path(options->output)) == ".mp4") {
      refuse_idle_for_film(arguments);
      return convert_film({options->input, options->output, options->units.frames, options->fps}, *common);
    }
    arguments.refuse("--fps", "is for a film (.mp4)");
    run_units(arguments, options->units, *common,
              {.input = options->input,
               .output_option = "OUTPUT",
               .output = options->output,
               .kind = output_kind(to_path(options->output)),
               .beside = array_beside(to_path(options->output)),
               .skips_missing = true},
              [&](const Unit& unit, Outputs& outputs) { convert_one(*options, arguments, unit, outputs); });
  };
  return command;
}

}  // namespace brume::cli
