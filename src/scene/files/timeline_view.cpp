// What timelines and scenes of tanks both have: camera, sky, tone curve.
#include "scene/files/scene_files.hpp"
#include "scene/files/timeline_parts.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {

void read_file_name(TomlTable& table, const std::filesystem::path& path, const char* key,
                    std::filesystem::path& file) {
  std::string name;
  table.read(key, name);
  if (name.empty()) return;
  if (!is_safe_relative(name)) table.fail(key, in_quotes(key) + kExpectedFile);
  file = path.parent_path() / name;
}

void read_tone(TomlTable& root, ToneCurve& tone) {
  std::string name = "neutral";
  root.read("tone", name);
  if (name == "standard") {
    tone = ToneCurve::standard;
  } else if (name != "neutral") {
    root.fail("tone", "\"tone\": expected \"neutral\" or \"standard\"");
  }
}

Result<void> read_sky(const toml::table& source, const std::filesystem::path& path, SkyOptions& sky) {
  TomlTable table(source, "[sky]", path.string());
  visit_sky_options(sky, OptionReader{table});
  return table.finish();
}

Result<void> read_camera_key(const toml::table& source, const std::filesystem::path& path,
                             std::vector<CameraKey>& keys) {
  TomlTable table(source, "[[camera]]", path.string());
  CameraKey key;
  for (const char* name : {"time", "position", "target"}) table.require(name);
  read_key_time(table, keys, key.time);
  table.read("position", key.camera.position_world, -kFarthestPoint, kFarthestPoint);
  table.read("target", key.camera.target_world, -kFarthestPoint, kFarthestPoint);
  visit_camera_options(key.camera, OptionReader{table});
  read_file_name(table, path, "opening", key.camera.lens.opening);
  key.place = table.place("opening");
  if (key.camera.position_world == key.camera.target_world)
    table.fail("target", "\"target\": expected a point other than the position");
  keys.push_back(std::move(key));
  return table.finish();
}

}  // namespace brume::scene
