#include "scene/files/tank_writer.hpp"

#include <utility>

#include "core/file.hpp"
#include "core/utf8.hpp"
#include "palettes/choice.hpp"
#include "scene/files/file_collector.hpp"
#include "scene/files/tank_reader.hpp"
#include "scene/files/toml_text.hpp"
#include "scene/tank_options.hpp"

namespace brume::scene {
namespace {

/// The file of a palette and the text behind it, ":0.2-0.6"; no file for a palette of the program.
std::pair<std::filesystem::path, std::string> palette_file(const std::string& palette) {
  const std::string_view file = palettes::file_of_choice(palette);
  if (file.empty()) return {};
  return {to_path(file), palette.substr(file.size())};
}

class TankWriter : private TomlText {
 public:
  explicit TankWriter(const std::filesystem::path& folder) : TomlText(folder) {}

  std::string write(const TankScene& scene) {
    text_ += "version = 1\n";
    options(scene, TankScene(), "", [](auto& o, auto& v) { visit_film_options(o, v); });
    options(scene, TankScene(), "", [](auto& o, auto& v) { visit_tone_options(o, v); });
    write_tank(scene);
    options(scene.sky, SkyOptions(), "\n[sky]\n", [](auto& o, auto& v) { visit_sky_options(o, v); });
    options(scene.fog, TankFog(), "\n[fog]\n", [](auto& o, auto& v) { visit_fog_options(o, v); });
    for (const TankLight& light : scene.lights) write_light(light);
    if (scene.glass) write_glass(*scene.glass);
    for (const CameraKey& key : scene.camera) camera(key);
    return std::move(text_);
  }

 private:
  void write_tank(const TankScene& scene) {
    text_ += "\n[tank]\n";
    if (!scene.file.empty()) line("file", path_from(scene.file, folder_).generic_string());
    const auto choice = [&](const char* key, const char* name, const char* usual) {
      if (std::string_view(name) != usual) line(key, std::string(name));
    };
    choice("view", view_name(scene.view), "spheres");
    choice("lighting", lighting_name(scene.lighting), "maps");
    choice("lens_points", lens_points_name(scene.lens_points), "remap");
    options(scene, TankScene(), "", [](auto& o, auto& v) { visit_tank_picture_options(o, v); });
    if (scene.file.empty()) write_pack(scene);
  }

  void write_pack(const TankScene& scene) {
    const spheres::PackOptions& pack = scene.pack;
    spheres::PackOptions usual;
    if (pack.size != usual.size) line("size", glm::ivec3(pack.size));
    if (pack.radius != spheres::default_radius(pack.size)) line("radius", pack.radius);
    usual.count = spheres::default_count(pack);
    options(pack, usual, "", [](auto& o, auto& v) { visit_pack_options(o, v); });
    if (pack.arrangement != usual.arrangement)
      line("arrangement", std::string(arrangement_name(pack.arrangement)));
    if (pack.coloring != usual.coloring) line("coloring", std::string(coloring_name(pack.coloring)));
    if (pack.seed != usual.seed) line("seed", static_cast<std::uint32_t>(pack.seed));
    if (!scene.palette.empty()) line("palette", palette_below(scene.palette));
    static const TankScene kUsualScene;
    if (scene.palette_space != kUsualScene.palette_space) line("palette_space", scene.palette_space);
  }

  /// A palette that is a file, relative to the folder.
  std::string palette_below(const std::string& palette) const {
    const auto [file, range] = palette_file(palette);
    return file.empty() ? palette : path_from(file, folder_).generic_string() + range;
  }

  void write_light(const TankLight& light) {
    text_ += "\n[[light]]\n";
    options(light, TankLight(), "", [](auto& o, auto& v) { visit_tank_light_options(o, v); });
    for (const PlaceKey& key : light.keys) {
      text_ += "\n[[light.key]]\n";
      line("time", key.time);
      line("position", key.position_world);
    }
  }

  void write_glass(const TankGlass& glass) {
    text_ += "\n[glass]\n";
    options(glass, TankGlass(), "", [](auto& o, auto& v) { visit_glass_options(o, v); });
    for (const GlassKey& key : glass.keys) {
      text_ += "\n[[glass.key]]\n";
      line("time", key.time);
      line("position", key.position_world);
      line("radii", key.radii);
    }
  }
};

}  // namespace

std::string format_tank_scene(const TankScene& scene, const std::filesystem::path& folder) {
  return TankWriter(folder).write(scene);
}

Result<void> save_tank_scene(const std::filesystem::path& path, const TankScene& scene) {
  TankScene saved = scene;
  FileCollector files(path);
  if (auto done = files.collect(saved.file); !done) return done;
  if (auto [file, range] = palette_file(saved.palette); !file.empty()) {
    if (auto done = files.collect(file); !done) return done;
    saved.palette = file.string() + range;
  }
  for (CameraKey& key : saved.camera)
    if (auto done = files.collect(key.camera.lens.opening); !done) return done;
  const std::string text = format_tank_scene(saved, path.parent_path());
  // Never write a scene that could not be read back; a palette's file must be there to be read.
  if (auto copied = files.copy_files(); !copied) return copied;
  if (const auto read = parse_tank_scene(text, path); !read) return not_saved(read.failure(), path);
  return write_file_atomic(path, text);
}

}  // namespace brume::scene
