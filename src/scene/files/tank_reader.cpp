#include "scene/files/tank_reader.hpp"

#include <cmath>

#include "core/file.hpp"
#include "core/utf8.hpp"
#include "palettes/choice.hpp"
#include "palettes/sample.hpp"
#include "scene/files/load.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/files/timeline_parts.hpp"
#include "scene/key_path.hpp"
#include "scene/tank_options.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 24;

/// Keys that say how a tank is packed, and have no place beside a file of one.
constexpr const char* kPackKeys[]{"size",         "voxel",       "spheres",  "radius",
                                  "distribution", "arrangement", "coloring", "noise_size",
                                  "opacity",      "seed",        "palette",  "palette_space"};

class TankReader {
 public:
  explicit TankReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

  Result<TankScene> read(const toml::table& document) {
    TomlTable root(document, "the scene of a tank", file_);
    std::uint32_t version = 0;
    root.require("version");
    root.read("version", version, 1, 1);
    visit_film_options(scene_, OptionReader{root});
    visit_tone_options(scene_, OptionReader{root});
    root.require("tank");
    // Find all tables before any is read: unknown keys are the first failure.
    const toml::table* const tank = root.table("tank");
    const toml::table* const sky = root.table("sky");
    const toml::table* const fog = root.table("fog");
    const toml::table* const glass = root.table("glass");
    const auto lights = root.tables("light"), cameras = root.tables("camera");
    if (lights.size() > kMostTankLights)
      root.fail("light", "[[light]]: expected at most " + std::to_string(kMostTankLights));
    if (auto done = root.finish(); !done) return done.failure();

    // Read them in order, and stop at the first failure.
    Result<void> outcome;
    const auto then = [&](const toml::table* table, auto read_table) {
      if (table != nullptr && outcome) outcome = read_table(*table);
    };
    then(tank, [&](const toml::table& source) { return read_tank(source); });
    then(sky, [&](const toml::table& source) { return read_sky(source, path_, scene_.sky); });
    then(fog, [&](const toml::table& source) { return read_fog(source); });
    then(glass, [&](const toml::table& source) { return read_glass(source); });
    for (const toml::table* light : lights)
      then(light, [&](const toml::table& source) { return read_light(source); });
    for (const toml::table* camera : cameras)
      then(camera, [&](const toml::table& source) { return read_camera_key(source, path_, scene_.camera); });
    if (!outcome) return outcome.failure();
    return std::move(scene_);
  }

 private:
  Result<void> read_tank(const toml::table& source) {
    TomlTable table(source, "[tank]", file_);
    read_file_name(table, path_, "file", scene_.file);
    read_choice(table, "view", scene_.view, 2, view_name);
    read_choice(table, "lighting", scene_.lighting, 2, lighting_name);
    read_choice(table, "lens_points", scene_.lens_points, 2, lens_points_name);
    visit_tank_picture_options(scene_, OptionReader{table});
    if (!scene_.file.empty())
      for (const char* key : kPackKeys)
        if (table.has(key)) table.fail(key, in_quotes(key) + ": belongs to a tank without \"file\"");
    read_pack(table);
    return table.finish();
  }

  void read_pack(TomlTable& table) {
    spheres::PackOptions& pack = scene_.pack;
    std::optional<glm::ivec3> size;
    std::optional<glm::vec2> radius;
    std::uint32_t seed = 0;
    table.read("size", size, 1, std::int64_t{spheres::kMostVoxelsPerAxis});
    table.read("radius", radius, kLeastRadius, double{spheres::kMostVoxelsPerAxis});
    table.read("seed", seed, 0, std::int64_t{UINT32_MAX});
    visit_pack_options(pack, OptionReader{table});
    // The size, and what must fit into it.
    if (size) pack.size = glm::uvec3(*size);
    if (std::uint64_t{pack.size.x} * pack.size.y * pack.size.z > spheres::kMostVoxels)
      table.fail("size", "\"size\": expected at most 2^28 voxels");
    pack.radius = radius.value_or(spheres::default_radius(pack.size));
    if (pack.radius.x > pack.radius.y)
      table.fail("radius", "\"radius\": expected the smaller radius before the larger one");
    const glm::uvec3 n = pack.size;
    if (2 * pack.radius.y > static_cast<float>(std::min({n.x, n.y, n.z})))
      table.fail("radius", "\"radius\": expected spheres that fit into the tank's " + std::to_string(n.x) +
                               " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " voxels");
    // The number of spheres depends on all of the above.
    if (!table.has("spheres")) pack.count = spheres::default_count(pack);
    pack.seed = seed;
    table.read("palette", scene_.palette);
    table.read("palette_space", scene_.palette_space);
    if (!palettes::space_of(scene_.palette_space))
      table.fail("palette_space",
                 "\"palette_space\": expected \"oklab\", \"linear\", \"srgb\" or \"nearest\"");
    read_palette(table);

    read_choice(table, "arrangement", pack.arrangement, kArrangements, arrangement_name);
    read_choice(table, "coloring", pack.coloring, kColorings, coloring_name);
  }

  /// One of `count` values by its name.
  template <typename Choice>
  void read_choice(TomlTable& table, const std::string& key, Choice& choice, std::uint32_t count,
                   const char* (*name_of)(Choice)) {
    std::string text = name_of(choice);
    table.read(key.c_str(), text);
    const auto found = choice_of(text, count, name_of);
    if (!found) return table.fail(key, in_quotes(key) + ": " + found.failure().message);
    choice = *found;
  }

  /// A palette that exists; a file of colours lies below the scene's folder.
  void read_palette(TomlTable& table) {
    if (scene_.palette.empty()) return;
    if (const std::string name(palettes::file_of_choice(scene_.palette)); !name.empty()) {
      if (!is_safe_relative(name)) {
        table.fail("palette", in_quotes("palette") + kExpectedFile);
        return;
      }
      scene_.palette = (path_.parent_path() / to_path(scene_.palette)).string();
    }
    if (const auto choice = palettes::parse_palette_choice(scene_.palette); !choice)
      table.fail("palette", "\"palette\": " + choice.failure().message);
  }

  Result<void> read_fog(const toml::table& source) {
    TomlTable table(source, "[fog]", file_);
    visit_fog_options(scene_.fog, OptionReader{table});
    return table.finish();
  }

  Result<void> read_light(const toml::table& source) {
    TomlTable table(source, "[[light]]", file_);
    TankLight light;
    visit_tank_light_options(light, OptionReader{table});
    const auto keys = table.tables("key");
    if (auto done = table.finish(); !done) return done;
    for (const toml::table* key : keys) {
      TomlTable at(*key, "[[light.key]]", file_);
      PlaceKey place;
      for (const char* name : {"time", "position"}) at.require(name);
      read_key_time(at, light.keys, place.time);
      at.read("position", place.position_world, -kFarthestPoint, kFarthestPoint);
      if (auto done = at.finish(); !done) return done;
      light.keys.push_back(place);
    }
    scene_.lights.push_back(std::move(light));
    return {};
  }

  Result<void> read_glass(const toml::table& source) {
    TomlTable table(source, "[glass]", file_);
    TankGlass glass;
    visit_glass_options(glass, OptionReader{table});
    const auto keys = table.tables("key");
    if (auto done = table.finish(); !done) return done;
    for (const toml::table* key : keys) {
      TomlTable at(*key, "[[glass.key]]", file_);
      GlassKey place{0, glass.position_world, glass.radii};
      read_key_time(at, glass.keys, place.time);
      at.read("position", place.position_world, -kFarthestPoint, kFarthestPoint);
      at.read("radii", place.radii, 1e-4, 1e4);
      if (auto done = at.finish(); !done) return done;
      glass.keys.push_back(place);
    }
    scene_.glass = std::move(glass);
    return {};
  }

  const std::filesystem::path& path_;
  std::string file_;
  TankScene scene_;
};

}  // namespace

TankScene scene_of_tank_file(const std::filesystem::path& tank) {
  TankScene scene;
  scene.file = tank;
  scene.sky.zenith = glm::vec3(0.05f, 0.06f, 0.08f);
  scene.sky.horizon = glm::vec3(0.02f);
  scene.sky.ambient = glm::vec3(0.6f);
  scene.lights.push_back({{1.5f, 2.5f, 2.0f}, glm::vec3(1, 0.94f, 0.85f), 30, 0.15f, {}});
  return scene;
}

bool is_tank_scene(const std::filesystem::path& path) {
  if (lower_extension(path) != ".toml") return false;
  const auto text = read_text_file(path, kMostFileBytes);
  if (!text) return false;
  const auto document = parse_toml(*text, path.string());
  // [[tank]] belongs to a timeline.
  return document && document->contains("tank") && !(*document)["tank"].is_array();
}

std::vector<std::filesystem::path> files_named_by_tank_scene(const std::filesystem::path& path) {
  const auto text = read_text_file(path, kMostFileBytes);
  if (!text) return {};
  const auto document = parse_toml(*text, path.string());
  if (!document) return {};
  std::vector<std::filesystem::path> files;
  const auto add = [&](std::string_view name) {
    if (!name.empty()) files.push_back(path.parent_path() / to_path(name));
  };
  const auto tank = (*document)["tank"];
  add(tank["file"].value_or(std::string_view()));
  add(palettes::file_of_choice(tank["palette"].value_or(std::string_view())));
  if (const toml::array* const cameras = (*document)["camera"].as_array())
    for (const toml::node& camera : *cameras)
      if (const toml::table* const key = camera.as_table())
        add((*key)["opening"].value_or(std::string_view()));
  return files;
}

Result<TankScene> parse_tank_scene(std::string_view text, const std::filesystem::path& path) {
  const auto document = parse_toml(text, path.string());
  if (!document) return document.failure();
  return TankReader(path).read(*document);
}

Result<TankScene> load_tank_scene(const std::filesystem::path& path) {
  const auto text = read_text_file(path, kMostFileBytes);
  if (!text) return text.failure();
  return parse_tank_scene(*text, path);
}

}  // namespace brume::scene
