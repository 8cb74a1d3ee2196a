// Reads [[volume]], [[carrier]], [[decal]] and [[tank]].
#include <algorithm>
#include <utility>

#include "core/similar.hpp"
#include "core/utf8.hpp"
#include "scene/files/timeline_parts.hpp"
#include "scene/tank_scene.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

/// The name of a carrier that the timeline has.
void read_carrier_name(TomlTable& table, const Timeline& timeline, std::string& name) {
  table.read("carrier", name);
  if (name.empty()) return;
  std::vector<std::string> known;
  for (const Carrier& carrier : timeline.carriers) known.push_back(carrier.name);
  if (std::ranges::find(known, name) == known.end())
    table.fail("carrier",
               "\"carrier\": there is no [[carrier]] " + in_quotes(name) + suggestion(name, known, "\""));
}

constexpr const char* kFileOfGrids = "a file of grids";

/// A file, which may lie anywhere.
void read_part_file(TomlTable& table, const std::filesystem::path& path, const std::string& what,
                    std::filesystem::path& file) {
  std::string name;
  table.require("file");
  table.read("file", name);
  if (name.empty() || name.find('\0') != std::string::npos)
    table.fail("file", "\"file\": expected the name of " + what);
  file = path.parent_path() / to_path(name);
}

Result<void> read_masks(TomlTable& volume_table, const std::filesystem::path& path, VolumeOptions& volume) {
  for (const toml::table* source : volume_table.tables("mask")) {
    TomlTable table(*source, "[[volume.mask]]", path.string());
    VolumeMask mask;
    table.require("grid");
    table.read("grid", mask.grid);
    visit_mask_options(mask, OptionReader{table});
    for (const toml::table* key_source : table.tables("key")) {
      TomlTable key_table(*key_source, "[[volume.mask.key]]", path.string());
      MaskKey key{0, mask.color, mask.intensity};
      read_key_time(key_table, mask.keys, key.time);
      visit_mask_options(key, OptionReader{key_table});
      mask.keys.push_back(key);
      if (auto done = key_table.finish(); !done) return done;
    }
    if (mask.grid.empty()) table.fail("grid", "\"grid\": expected the name of a grid");
    if (const std::string most = std::to_string(kMostMasks); volume.masks.size() >= kMostMasks)
      table.fail("grid", "[[volume.mask]]: expected at most " + most + " of them");
    volume.masks.push_back(std::move(mask));
    if (auto done = table.finish(); !done) return done;
  }
  // What only glows is not in the way of light.
  if (!volume.masks.empty() && !volume_table.has("extinction")) volume.extinction = kMaskedExtinction;
  if (!volume.masks.empty() && !volume.color.empty())
    volume_table.fail("color", "\"color\": cannot be combined with [[volume.mask]]; remove one of them");
  return {};
}

/// A table of noise, [volume.KEY], if there is one. It requires a strength.
template <typename Visit>
Result<void> read_noise(TomlTable& volume_table, const std::string& key, const std::filesystem::path& path,
                        const Visit& visit) {
  const toml::table* const source = volume_table.table(key.c_str());
  if (!source) return {};
  TomlTable table(*source, "[volume." + key + "]", path.string());
  table.require("strength");
  visit(OptionReader{table});
  return table.finish();
}

void read_display(TomlTable& table, VolumeOptions& volume) {
  visit_particle_options(volume, OptionReader{table});
  if (volume.particles > 0 && volume.masks.empty())
    table.fail("particles", "\"particles\": show masks; add a [[volume.mask]]");
}

void read_sequence(TomlTable& table, VolumeOptions& volume) {
  table.read("first", volume.first, 0, kLastFrame);
  table.read("last", volume.last, 0, kLastFrame);
  if (volume.first && volume.last && *volume.last < *volume.first)
    table.fail("last", "\"last\": expected no less than \"first\"");
  table.read("loop", volume.loop);
  table.read("clip", volume.clip);
  table.read("ping_pong", volume.ping_pong);
  if (volume.loop + volume.clip + volume.ping_pong > 1)
    table.fail(volume.clip ? "clip" : "ping_pong",
               "\"clip\", \"loop\" and \"ping_pong\": expected only one of them to be true");
}

void read_transfer(TomlTable& table, VolumeOptions& volume) {
  const auto fail = [&](const char* key, const std::optional<PointFault>& fault) {
    if (!fault) return;
    const std::string point = fault->point ? " point " + std::to_string(*fault->point + 1) : "";
    const std::string what = in_quotes(key) + point + ": " + fault->what;
    fault->point ? table.fail(key, *fault->point, what) : table.fail(key, what);
  };
  // Values between which the curves lie.
  table.read("range", volume.range, -kFarthestValue, kFarthestValue);
  if (volume.range)
    if (const auto fault = fault_of_range(*volume.range)) table.fail("range", "\"range\": " + *fault);

  // Opacity: points. The table has reported rows of other lengths.
  std::vector<std::vector<float>> rows;
  if (table.has("opacity")) {
    table.read("opacity", rows, 2);
    for (const auto& row : rows)
      if (row.size() == 2) volume.opacity.push_back({row[0], row[1]});
    fail("opacity", fault_of(std::span(std::as_const(volume.opacity))));
  }

  // Colours: the name of a map, or points.
  ColorMap& map = volume.color_map;
  if (table.is_text("color_map")) {
    table.read("color_map", map.name);
    if (map.name.empty()) table.fail("color_map", "\"color_map\": expected a name or points");
    fail("color_map", fault_of(map));
  } else if (table.has("color_map")) {
    rows.clear();
    table.read("color_map", rows, 4);
    for (const auto& row : rows)
      if (row.size() == 4) map.points.push_back({row[0], {row[1], row[2], row[3]}});
    fail("color_map", fault_of(std::span(std::as_const(map.points))));
  }
}

}  // namespace

Result<void> read_carrier(const toml::table& source, const std::filesystem::path& path, Timeline& timeline) {
  TomlTable table(source, "[[carrier]]", path.string());
  Carrier carrier;
  table.require("name");
  table.read("name", carrier.name);
  table.read("object", carrier.object);
  table.require("key");
  for (const toml::table* key_source : table.tables("key")) {
    TomlTable key_table(*key_source, "[[carrier.key]]", path.string());
    CarrierKey key;
    read_key_time(key_table, carrier.keys, key.time);
    key_table.require("position");
    key_table.read("position", key.position_world, -kFarthestPoint, kFarthestPoint);
    visit_carrier_options(key, OptionReader{key_table});
    carrier.keys.push_back(key);
    if (auto done = key_table.finish(); !done) return done;
  }

  // Events and volumes name carriers, and an object moves with one.
  if (carrier.name.empty()) table.fail("name", "\"name\": expected a name");
  if (carrier.keys.empty()) table.fail("key", "\"key\": expected at least one [[carrier.key]]");
  for (const Carrier& other : timeline.carriers) {
    if (other.name == carrier.name)
      table.fail("name", "\"name\": there is another [[carrier]] " + in_quotes(carrier.name));
    if (!carrier.object.empty() && other.object == carrier.object)
      table.fail("object", "\"object\": moves with [[carrier]] " + in_quotes(other.name) + " already");
  }
  carrier.place = table.place(carrier.object.empty() ? "name" : "object");
  timeline.carriers.push_back(std::move(carrier));
  return table.finish();
}

Result<void> read_decal(const toml::table& source, const std::filesystem::path& path, Timeline& timeline) {
  TomlTable table(source, "[[decal]]", path.string());
  DecalOptions decal;
  read_part_file(table, path, kFileOfGrids, decal.file);
  if (timeline.decals.size() >= kMostDecals)
    table.fail("file", "[[decal]]: expected at most " + std::to_string(kMostDecals) + " of them");
  table.read("grid", decal.grid);
  read_carrier_name(table, timeline, decal.carrier);
  table.read("position", decal.position_world, -kFarthestPoint, kFarthestPoint);
  visit_decal_options(decal, OptionReader{table});
  decal.place = table.place("file");
  timeline.decals.push_back(std::move(decal));
  return table.finish();
}

Result<void> read_tank(const toml::table& source, const std::filesystem::path& path, Timeline& timeline) {
  TomlTable table(source, "[[tank]]", path.string());
  TankOptions tank;
  read_part_file(table, path, "a tank's scene or a .spheres file", tank.file);
  if (timeline.tanks.size() >= kMostTanks)
    table.fail("file", "[[tank]]: expected at most " + std::to_string(kMostTanks) + " of them");
  read_carrier_name(table, timeline, tank.carrier);
  table.read("position", tank.position_world, -kFarthestPoint, kFarthestPoint);
  visit_tank_options(tank, OptionReader{table});
  if (table.has("view")) {
    std::string name;
    table.read("view", name);
    if (const auto view = choice_of(name, 2, view_name))
      tank.view = *view;
    else
      table.fail("view", "\"view\": " + view.failure().message);
  }
  tank.place = table.place("file");
  timeline.tanks.push_back(std::move(tank));
  return table.finish();
}

Result<void> read_volume(const toml::table& source, const std::filesystem::path& path, Timeline& timeline) {
  TomlTable table(source, "[[volume]]", path.string());
  VolumeOptions volume;
  read_part_file(table, path, kFileOfGrids, volume.file);
  if (timeline.volumes.size() >= kMostVolumes)
    table.fail("file", "[[volume]]: expected at most " + std::to_string(kMostVolumes) + " of them");
  read_sequence(table, volume);
  table.read("density", volume.density);
  table.read("heat", volume.heat);
  table.read("position", volume.position_world, -kFarthestPoint, kFarthestPoint);
  table.read("color", volume.color);
  visit_volume_options(volume, OptionReader{table});
  read_transfer(table, volume);
  volume.place = table.place("file");
  if (auto done = read_masks(table, path, volume); !done) return done;
  const auto disturb = [&](auto&& reader) { visit_disturbance_options(volume.disturbance, reader); };
  if (auto done = read_noise(table, "disturb", path, disturb); !done) return done;
  const auto detail = [&](auto&& reader) { visit_detail_options(volume.detail, reader); };
  if (auto done = read_noise(table, "detail", path, detail); !done) return done;
  read_display(table, volume);
  read_carrier_name(table, timeline, volume.carrier);
  timeline.volumes.push_back(std::move(volume));
  return table.finish();
}

}  // namespace brume::scene
