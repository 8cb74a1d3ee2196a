#include "scene/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/file.hpp"
#include "core/similar.hpp"
#include "scene/files.hpp"
#include "scene/ray.hpp"
#include "scene/text_reader.hpp"
#include "scene/timeline_parts.hpp"

namespace brume::scene {
namespace {

class TimelineReader {
 public:
  explicit TimelineReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

  Result<Timeline> read(const toml::table& document) {
    TomlTable root(document, "the timeline", file_);
    std::uint32_t version = 0;
    std::string scene;
    root.require("version");
    root.read("version", version, 1, 1);
    root.require("scene");
    root.read("scene", scene);
    if (scene.empty() || scene.find('\0') != std::string::npos)
      root.fail("scene", "\"scene\": expected the name of a scene file");
    visit_timeline_options(timeline_, OptionReader{root});
    visit_bounce_options(timeline_, OptionReader{root});
    visit_level_options(timeline_, OptionReader{root});
    read_tone(root, timeline_.tone);
    const toml::table* const grid = root.table("grid");
    const toml::table* const smoke = root.table("smoke");
    const toml::table* const sky = root.table("sky");
    const toml::table* const sun = root.table("sun");
    const auto carriers = root.tables("carrier");
    const auto volumes = root.tables("volume");
    const auto decals = root.tables("decal");
    const auto roles = root.tables("role");
    const auto cameras = root.tables("camera");
    const auto events = root.tables("event");
    if (auto done = root.finish(); !done) return done.failure();

    timeline_.scene = path_.parent_path() / scene;
    Result<void> outcome;
    if (grid != nullptr && outcome) outcome = read_grid(*grid);
    if (smoke != nullptr && outcome) outcome = read_smoke(*smoke);
    if (sky != nullptr && outcome) outcome = read_sky(*sky, path_, timeline_.sky);
    if (sun != nullptr && outcome) outcome = read_sun(*sun);
    const auto read_all = [&](const auto& tables, auto read_one) {
      for (std::size_t i = 0; i < tables.size() && outcome; ++i)
        outcome = read_one(*tables[i], path_, timeline_);
    };
    read_all(carriers, read_carrier);
    read_all(volumes, read_volume);
    read_all(decals, read_decal);
    read_all(roles, read_role);
    for (std::size_t i = 0; i < cameras.size() && outcome; ++i)
      outcome = read_camera_key(*cameras[i], path_, timeline_.camera);
    for (std::size_t i = 0; i < events.size() && outcome; ++i) outcome = read_event(*events[i]);
    if (!outcome) return outcome.failure();

    sort_events(timeline_);
    return std::move(timeline_);
  }

 private:
  Result<void> read_grid(const toml::table& source) {
    TomlTable table(source, "[grid]", file_);
    visit_grid_options(timeline_.grid, OptionReader{table});
    return table.finish();
  }

  Result<void> read_smoke(const toml::table& source) {
    TomlTable table(source, "[smoke]", file_);
    visit_smoke_options(timeline_.smoke, OptionReader{table});
    if (timeline_.smoke.droplet && source.contains("anisotropy"))
      table.fail("droplet", "\"droplet\": cannot be combined with \"anisotropy\"; remove one of them");
    return table.finish();
  }

  Result<void> read_sun(const toml::table& source) {
    TomlTable table(source, "[sun]", file_);
    visit_sun_options(timeline_.sun.emplace(), OptionReader{table});
    return table.finish();
  }

  Result<void> read_event(const toml::table& source) {
    TomlTable table(source, "[[event]]", file_);
    std::string type;
    for (const char* name : {"type", "time"}) table.require(name);
    table.read("type", type);
    if (type == "smoke") return read_smoke_event(table);
    if (type == "shot") return read_shot_event(table);
    if (type == "text") return read_text_event(table);
    if (type == "blast") return read_blast_event(table);
    if (type == "move") return read_move_event(table);
    if (type == "edit") return read_edit_event(table);
    if (type == "door") return read_door_event(table);
    table.fail("type",
               "\"type\": expected \"smoke\", \"shot\", \"text\", \"blast\", \"move\", \"edit\" or \"door\"");
    return table.finish();
  }

  Result<void> read_smoke_event(TomlTable& table) {
    SmokeEvent event;
    for (const char* name : {"from", "at"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("at", event.at_world, -kFarthestEvent, kFarthestEvent);
    event.place = table.place();
    timeline_.smokes.push_back(event);
    return table.finish();
  }

  Result<void> read_shot_event(TomlTable& table) {
    ShotEvent event;
    for (const char* name : {"from", "toward"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("toward", event.toward_world, -kFarthestEvent, kFarthestEvent);
    visit_shot_options(event, OptionReader{table});
    read_shape(table, event);
    if (event.from_world == event.toward_world)
      table.fail("toward", "\"toward\": expected a point other than \"from\"");
    event.place = table.place();
    timeline_.shots.push_back(event);
    return table.finish();
  }

  Result<void> read_text_event(TomlTable& table) {
    TextEvent event;
    for (const char* name : {"text", "from", "toward"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("text", event.text);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("toward", event.toward_world, -kFarthestEvent, kFarthestEvent);
    visit_text_options(event, OptionReader{table});
    read_file_name(table, path_, "font", event.font);
    if (event.text.empty() || event.text.size() > kMaxTextBytes)
      table.fail("text", "\"text\": expected 1 to 1024 bytes");
    if (event.from_world == event.toward_world)
      table.fail("toward", "\"toward\": expected a point other than \"from\"");
    event.place = table.place();
    timeline_.texts.push_back(std::move(event));
    return table.finish();
  }

  void read_shape(TomlTable& table, ShotEvent& event) const {
    std::string shape = "cylinder";
    table.read("shape", shape);
    read_file_name(table, path_, "mask", event.mask);
    if (shape == "box") {
      event.shape = ShotShape::box;
    } else if (shape == "mask") {
      event.shape = ShotShape::mask;
      table.require("mask");
    } else if (shape != "cylinder") {
      table.fail("shape", "\"shape\": expected \"cylinder\", \"box\" or \"mask\"");
    }
    if (event.shape != ShotShape::mask && !event.mask.empty())
      table.fail("mask", "\"mask\": belongs to shape = \"mask\"");
    if (event.shape == ShotShape::mask && event.mask.empty())
      table.fail("mask", "\"mask\": expected the name of a picture");
  }

  Result<void> read_blast_event(TomlTable& table) {
    BlastEvent event;
    table.require("at");
    table.read("time", event.time, 0, kLatestTime);
    table.read("at", event.at_world, -kFarthestEvent, kFarthestEvent);
    visit_blast_options(event, OptionReader{table});
    if (event.refill_middle < event.refill_rim)
      table.fail("refill_middle", "\"refill_middle\": expected no less than \"refill_rim\"");
    event.place = table.place();
    timeline_.blasts.push_back(event);
    return table.finish();
  }

  Result<void> read_move_event(TomlTable& table) {
    MoveEvent event;
    for (const char* name : {"body", "to"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("body", event.body);
    table.read("to", event.to_world, -kFarthestEvent, kFarthestEvent);
    event.place = table.place();
    timeline_.moves.push_back(event);
    return table.finish();
  }

  Result<void> read_edit_event(TomlTable& table) {
    EditEvent event;
    for (const char* name : {"low", "high", "solid"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("low", event.low_world, -kFarthestEvent, kFarthestEvent);
    table.read("high", event.high_world, -kFarthestEvent, kFarthestEvent);
    table.read("solid", event.solid);
    if (!glm::all(glm::lessThan(event.low_world, event.high_world)))
      table.fail("high", "\"high\": expected more than \"low\" along every axis");
    timeline_.edits.push_back(event);
    return table.finish();
  }

  Result<void> read_door_event(TomlTable& table) {
    DoorEvent event;
    for (const char* name : {"object", "open"}) table.require(name);
    table.read("time", event.time, 0, kLatestTime);
    table.read("object", event.object);
    table.read("open", event.open);
    event.place = table.place("object");
    timeline_.doors.push_back(std::move(event));
    return table.finish();
  }

  const std::filesystem::path& path_;
  std::string file_;
  Timeline timeline_;
};

}  // namespace

void sort_events(Timeline& timeline) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
  for_each_event_list(
      timeline, [&](const char*, auto& events) { std::stable_sort(events.begin(), events.end(), earlier); });
}

Result<Timeline> parse_timeline(std::string_view text, const std::filesystem::path& path) {
  const auto document = parse_toml(text, path.string());
  if (!document) return document.failure();
  return TimelineReader(path).read(*document);
}

Result<Timeline> load_timeline(const std::filesystem::path& path) {
  const auto text = read_text_file(path, 1u << 24);
  if (!text) return text.failure();
  return parse_timeline(*text, path);
}

namespace {

Result<void> check_object(const Scene& scene, const std::string& name, const std::string& place) {
  const auto& objects = scene.objects;
  if (std::any_of(objects.begin(), objects.end(), [&](const Object& o) { return o.name == name; })) return {};
  const std::string message =
      (place.empty() ? "" : place + ": ") + "the scene has no object " + in_quotes(name);
  std::vector<std::string> names;
  for (const Object& object : objects)
    if (!object.name.empty() && std::ranges::find(names, object.name) == names.end())
      names.push_back(object.name);
  return Failure{ErrorCode::bad_input, message + suggestion(name, names, "\"")};
}

}  // namespace

Result<void> read_role(const toml::table& source, const std::filesystem::path& path, Timeline& timeline) {
  TomlTable table(source, "[[role]]", path.string());
  RoleOptions options;
  std::string name;
  for (const char* key : {"object", "role"}) table.require(key);
  table.read("object", options.object);
  table.read("role", name);
  const auto role = role_of_name(name);
  if (!role) table.fail("role", "\"role\": expected \"wall\", \"glass\", \"grille\" or \"ghost\"");
  options.role = role.value_or(options.role);
  if (options.object.empty()) table.fail("object", "\"object\": expected the name of an object");
  options.place = table.place("object");
  for (const RoleOptions& other : timeline.roles)
    if (other.object == options.object)
      table.fail("object", "\"object\": there is another [[role]] of " + in_quotes(options.object));
  timeline.roles.push_back(std::move(options));
  return table.finish();
}

Result<void> check_objects(const Timeline& timeline, const Scene& scene) {
  for (const DoorEvent& door : timeline.doors)
    if (auto done = check_object(scene, door.object, door.place); !done) return done;
  for (const RoleOptions& role : timeline.roles)
    if (auto done = check_object(scene, role.object, role.place); !done) return done;
  for (const Carrier& carrier : timeline.carriers)
    if (!carrier.object.empty())
      if (auto done = check_object(scene, carrier.object, carrier.place); !done) return done;
  return {};
}

}  // namespace brume::scene
