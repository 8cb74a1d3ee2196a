#include <algorithm>
#include <cctype>

#include "apps/cli/command.hpp"
#include "apps/cli/console.hpp"
#include "apps/cli/json.hpp"
#include "core/error.hpp"
#include "image/decode.hpp"
#include "scene/load.hpp"
#include "scene/timeline.hpp"
#include "voxel/vxl_file.hpp"

namespace brume::cli {
namespace {

Json point(glm::vec3 p) {
  return Json::list({p.x, p.y, p.z});
}

Json scene_info(const std::filesystem::path& path, Outputs& outputs) {
  const scene::Scene scene = scene::load_scene(path).value_or_throw();
  outputs.reads(scene.files);
  std::uint64_t triangles = 0;
  for (const scene::Object& object : scene.objects) triangles += scene.meshes[object.mesh].indices.size() / 3;
  // A grenade from the file counts as one of its objects, although it is not placed in the world.
  const bool own_grenade = scene.grenade.has_value();
  if (own_grenade) triangles += scene.meshes[scene.grenade->mesh].indices.size() / 3;
  Json info{{"kind", "scene"},
            {"objects", scene.objects.size() + own_grenade},
            {"grenade", own_grenade ? "from the file" : "built in"},
            {"meshes", scene.meshes.size()},
            {"materials", scene.materials.size()},
            {"images", scene.images.size()},
            {"lights", scene.lights.size()},
            {"triangles", triangles},
            {"camera", scene.camera.has_value()}};
  if (const Box<float> bounds = scene::world_bounds(scene); !bounds.empty()) {
    info.set("bounds_min", point(bounds.low));
    info.set("bounds_max", point(bounds.high));
  }
  return info;
}

Json timeline_info(const std::filesystem::path& path) {
  const scene::Timeline timeline = scene::load_timeline(path).value_or_throw();
  Json info{{"kind", "timeline"},
            {"scene", timeline.scene.string()},
            {"seconds", timeline.duration},
            {"voxel_size", timeline.grid.voxel},
            {"camera_keys", timeline.camera.size()}};
  scene::for_each_event_list(timeline, [&](const char* type, const auto& events) {
    info.set(type + std::string("s"), events.size());
  });
  return info;
}

Json image_info(const std::filesystem::path& path) {
  const image::Image8 image = image::load_image(path).value_or_throw();
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque = opaque && image.rgba[i] == 255;
  return {{"kind", "image"}, {"width", image.width}, {"height", image.height}, {"opaque", opaque}};
}

Json voxel_info(const std::filesystem::path& path) {
  const auto contents = voxel::load_vxl(path, std::nullopt).value_or_throw();
  BRUME_ASSERT(contents.has_value(), "loading without a key accepts any file");
  const voxel::GridLayout& frame = contents->grid.layout();
  return {{"kind", "voxels"},
          {"size", Json::list({frame.size.x, frame.size.y, frame.size.z})},
          {"voxel_size", frame.voxel_size},
          {"origin", point(frame.origin_world)},
          {"solid", contents->grid.count_solid()},
          {"planes", contents->planes.plane_count()},
          {"triangles", contents->triangles}};
}

Json info_of(const std::filesystem::path& path, Outputs& outputs) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto is_one_of = [&](std::initializer_list<const char*> known) {
    return std::find(known.begin(), known.end(), extension) != known.end();
  };
  if (is_one_of({".txt", ".gltf", ".glb", ".obj"})) return scene_info(path, outputs);
  if (is_one_of({".toml"})) return timeline_info(path);
  if (is_one_of({".vxl"})) return voxel_info(path);
  if (is_one_of({".png", ".jpg", ".jpeg"})) return image_info(path);
  throw Error(ErrorCode::usage, path.string() +
                                    ": unknown file extension; expected .txt, .gltf, .glb, .obj, "
                                    ".vxl, .toml, .png or .jpg");
}

}  // namespace

Command add_info(CommandLine& program) {
  struct Options {
    std::string input, json;
  };
  Command command = declare(program, "info", "Summarizes a scene, timeline, voxel or image file.",
                            "  brume info room.glb\n"
                            "  brume info room.vxl --json -");
  auto options = std::make_shared<Options>();
  command.arguments.add_option("FILE", options->input, "The file to summarize").required().type_name("");
  command.arguments.add_option("--json", options->json, "Write the summary as JSON; - for standard output")
      .type_name("FILE");
  command.run = [options, common = command.common] {
    common->outputs.reads(std::filesystem::path(options->input));
    common->outputs.writes("--json", options->json, FileKind::json);
    Json info{{"file", options->input}};
    info.update(info_of(options->input, common->outputs));
    if (!options->json.empty()) write_json(options->json, info);
    if (options->json == "-") return;
    for (const auto& [key, value] : info.fields())
      print(key + std::string(14 - std::min<std::size_t>(13, key.size()), ' ') + value + "\n");
  };
  return command;
}

}  // namespace brume::cli
