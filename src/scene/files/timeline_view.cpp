// What timelines and scenes of tanks both have: choices, files, camera, sky.
#include <algorithm>

#include "core/utf8.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/files/timeline_parts.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {

std::string in_words(std::span<const char* const> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + in_quotes(names[i]);
  return text;
}

std::size_t read_choice(TomlTable& table, const ChoiceField& field, std::size_t usual) {
  std::string name = field.names[usual];
  table.read(field.key, name);
  const auto found = std::ranges::find(field.names, name);
  if (found != field.names.end()) return static_cast<std::size_t>(found - field.names.begin());
  table.fail(field.key, in_quotes(field.key) + ": expected " + in_words(field.names));
  return usual;
}

void read_file_name(TomlTable& table, const std::filesystem::path& path, const char* key,
                    std::filesystem::path& file) {
  std::string name;
  table.read(key, name);
  if (name.empty()) return;
  if (!is_safe_relative(name)) table.fail(key, in_quotes(key) + kExpectedFile);
  file = path.parent_path() / to_path(name);
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
