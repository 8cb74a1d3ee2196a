#include "scene/files/timeline_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/file.hpp"
#include "core/similar.hpp"
#include "core/utf8.hpp"
#include "scene/event_fields.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/files/timeline_parts.hpp"
#include "scene/ray.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

std::string kinds_in_words() {
  std::vector<const char*> kinds;
  for_each_event_kind([&](const char* kind, auto) { kinds.push_back(kind); });
  return in_words(kinds);
}

/// Reads the fields of an event: the visitor of scene/event_fields.hpp.
template <typename Event>
struct EventReader {
  TomlTable& table;
  const std::filesystem::path& path;
  Event& event;

  void operator()(const OptionInfo& info, auto& member) { OptionReader{table}(info, member); }
  void operator()(const ChoiceField& field, auto& choice) { OptionReader{table}(field, choice); }
  void operator()(const PointField& field, glm::vec3& point) {
    table.require(field.key);
    table.read(field.key, point, -kFarthestEvent, kFarthestEvent);
  }
  void operator()(const TextField& field, std::string& text) {
    table.require(field.key);
    table.read(field.key, text);
    if (const auto fault = fault_of(field, text)) fail(field.key, *fault);
    if constexpr (requires { event.place; })
      if (field.names_object) event.place = table.place(field.key);
  }
  void operator()(const FlagField& field, bool& flag) {
    table.require(field.key);
    table.read(field.key, flag);
  }
  void operator()(const FileField& field, std::filesystem::path& file) {
    read_file_name(table, path, field.key, file);
  }
  void operator()(const EventRule& rule, const auto& value, const auto& other) {
    if (!holds(rule, value, other)) fail(rule.key, expectation(rule));
  }
  void operator()(const EventRule& rule, const std::filesystem::path& file, ShotShape shape) {
    if (shape == ShotShape::mask) table.require(rule.key);
    if (holds(rule, file, shape)) return;
    const std::string key = rule.key;
    if (shape == ShotShape::mask) return fail(rule.key, "the name of a picture");
    table.fail(key, in_quotes(key) + ": belongs to " + rule.other + " = " + in_quotes(key));
  }

 private:
  void fail(const char* key, const std::string& what) {
    table.fail(key, in_quotes(key) + ": expected " + what);
  }
};

class TimelineReader {
 public:
  explicit TimelineReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

  Result<Timeline> read(const toml::table& document) {
    // The root, and which tables it has.
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
    const toml::table* const grid = root.table("grid");
    const toml::table* const smoke = root.table("smoke");
    const toml::table* const sky = root.table("sky");
    const toml::table* const sun = root.table("sun");
    const auto carriers = root.tables("carrier");
    const auto volumes = root.tables("volume");
    const auto decals = root.tables("decal");
    const auto tanks = root.tables("tank");
    const auto roles = root.tables("role");
    const auto cameras = root.tables("camera");
    const auto events = root.tables("event");
    if (auto done = root.finish(); !done) return done.failure();

    // The tables, up to the first fault.
    timeline_.scene = path_.parent_path() / to_path(scene);
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
    read_all(tanks, read_tank);
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
    bool known = false;
    for_each_event_kind([&](const char* kind, auto list) {
      if (type != kind) return;
      known = true;
      auto& event = (timeline_.*list).emplace_back();
      table.read("time", event.time, 0, kLatestTime);
      if constexpr (requires { event.place; }) event.place = table.place();
      visit_event(event, EventReader{table, path_, event});
    });
    if (!known) table.fail("type", "\"type\": expected " + kinds_in_words());
    return table.finish();
  }

  const std::filesystem::path& path_;
  std::string file_;
  Timeline timeline_;
};

}  // namespace

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

/// Checks the objects that events name.
template <typename Event>
struct ObjectCheck {
  const Scene& scene;
  const Event& event;
  Result<void>& outcome;
  void operator()(const TextField& field, const std::string& name) {
    if constexpr (requires { event.place; })
      if (field.names_object && outcome) outcome = check_object(scene, name, event.place);
  }
  void operator()(const auto&, const auto&...) {}
};

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
  Result<void> outcome;
  for_each_event_list(timeline, [&](const char*, const auto& events) {
    for (const auto& event : events) visit_event(event, ObjectCheck{scene, event, outcome});
  });
  if (!outcome) return outcome;
  for (const RoleOptions& role : timeline.roles)
    if (auto done = check_object(scene, role.object, role.place); !done) return done;
  for (const Carrier& carrier : timeline.carriers)
    if (!carrier.object.empty())
      if (auto done = check_object(scene, carrier.object, carrier.place); !done) return done;
  return {};
}

}  // namespace brume::scene
