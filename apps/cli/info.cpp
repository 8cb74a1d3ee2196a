#include "apps/cli/info.hpp"

#include "apps/cli/command.hpp"
#include "apps/cli/tank_options.hpp"
#include "apps/cli/tanks.hpp"
#include "apps/command_line/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "image/decode.hpp"
#include "image/exr.hpp"
#include "scene/files/load.hpp"
#include "scene/files/tank_reader.hpp"
#include "spheres/file.hpp"
#include "vxl/file.hpp"
#include "wire/replay.hpp"

namespace brume::cli {
namespace {

Summary image_summary(const std::filesystem::path& path) {
  const image::Image8 image = image::load_image(path).value_or_throw();
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque = opaque && image.rgba[i] == 255;
  Summary summary("image");
  summary.add("width", image.width);
  summary.add("height", image.height);
  summary.add("opaque", opaque);
  return summary;
}

Summary layers_summary(const std::filesystem::path& path) {
  const auto bytes = read_file(path).value_or_throw();
  const auto parts = image::decode_exr_parts(bytes, path.string()).value_or_throw();
  Summary summary("layers");
  Json list = Json::list({});
  for (const image::ExrPart& part : parts) {
    Json layers = Json::list({});
    if (!part.name.empty()) summary.add_line("part", printable(part.name));
    summary.add_line("size", std::to_string(part.width) + "x" + std::to_string(part.height));
    for (const auto& [name, type] : part.channels) {
      summary.add_line(printable(name), type);
      layers.push_back({{"name", name}, {"type", type}});
    }
    list.push_back({{"name", part.name}, {"width", part.width}, {"height", part.height}, {"layers", layers}});
  }
  summary.set("parts", list);
  return summary;
}

Summary voxel_summary(const std::filesystem::path& path) {
  const auto contents = vxl::load(path, std::nullopt).value_or_throw();
  BRUME_ASSERT(contents.has_value(), "loading without a key accepts any file");
  Summary summary("voxels");
  add_layout(summary, contents->grid.layout());
  const voxel::Solids solids(contents->grid, contents->roles);
  const std::uint64_t solid = solids.smoke.count_solid();
  summary.add("solid", solid);
  if (!contents->roles.empty()) {
    summary.add("glass", solid - solids.sight.count_solid());
    summary.add("grilles", solids.bodies.count_solid() - solid);
  }
  summary.add("planes", contents->planes.plane_count());
  summary.add("triangles", contents->triangles);
  return summary;
}

Summary replay_summary(const std::filesystem::path& path) {
  const wire::Replay replay = wire::load_replay(path).value_or_throw();
  Summary summary("recording");
  summary.add("ticks", replay.checksums.size());
  summary.add("ticks_per_second", replay.settings.ticks_per_second);
  summary.add("events", replay.events.size());
  add_layout(summary, replay.level.layout());
  return summary;
}

bool is_scene_file(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  return extension == ".txt" || extension == ".gltf" || extension == ".glb" || extension == ".obj";
}

struct Choices {
  bool check = false, objects = false;
};

Summary summarize(const std::filesystem::path& path, const Choices& choices, Outputs& outputs) {
  expect_suffix("", path.string(),
                {".txt", ".gltf", ".glb", ".obj", ".toml", ".vxl", ".brp", ".brv", ".vdb", ".nvdb", ".json",
                 ".png", ".exr", ".jpg", ".jpeg", ".webp", ".spheres"});
  const std::string extension = scene::lower_extension(path);
  if (scene::is_tank_scene(path)) return tank_scene_summary(path, choices.check);
  if (extension == ".toml") return timeline_summary(path, choices.check, outputs);
  if (extension == ".vxl") return voxel_summary(path);
  if (extension == ".brp") return replay_summary(path);
  if (spheres::is_tank_file(path)) return tank_summary(path);
  if (grids::is_grid_file(path)) return volume_summary(path, outputs);
  if (extension == ".exr") return layers_summary(path);
  if (is_scene_file(path)) return scene_summary(path, choices.objects, outputs);
  return image_summary(path);
}

}  // namespace

Command add_info(CommandLine& program) {
  struct Options {
    std::string input, json;
    Choices choices;
  };
  Command command =
      declare(program, "info", "Summarizes a scene, timeline, voxel, volume, tank, recording or image file.",
              "  brume info room.glb\n"
              "  brume info scenes/demo.toml --check\n"
              "  brume info room.vxl --json -\n"
              "  brume info smoke.vdb");
  auto options = std::make_shared<Options>();
  command.arguments.add_option("FILE", options->input, "The file to summarize").required().type_name("");
  command.arguments.add_flag(
      "--check", options->choices.check,
      "Fail (exit code 3) if a timeline cannot be rendered: its scene, masks, fonts or "
      "doors are missing or invalid; the same of a scene of a tank");
  command.arguments.add_flag("--objects", options->choices.objects,
                             "List the names of a scene's objects, by which timelines move them");
  declare_json(command.arguments, options->json, "the summary");
  command.run = [arguments = command.arguments, options, common = command.common] {
    // Refuse options of other kinds of files, and declare what is read.
    if (scene::lower_extension(to_path(options->input)) != ".toml")
      arguments.refuse("--check", "is for timelines and scenes of tanks (.toml)");
    if (!is_scene_file(to_path(options->input)))
      arguments.refuse("--objects", "is for scenes (.glb, .gltf, .obj, .txt)");
    declare_input(common->outputs, to_path(options->input));
    common->outputs.writes("--json", to_path(options->json), FileKind::json);
    // The same facts as JSON and as text.
    const Summary summary = summarize(to_path(options->input), options->choices, common->outputs);
    if (!options->json.empty()) {
      Json info{{"file", options->input}};
      info.update(summary.json());
      write_json(options->json, info);
    }
    if (options->json == "-") return;
    print("file            " + options->input + "\n");
    for (const auto& [name, text] : summary.lines())
      print(name + std::string(name.size() < 15 ? 16 - name.size() : 1, ' ') + text + "\n");
  };
  return command;
}

}  // namespace brume::cli
