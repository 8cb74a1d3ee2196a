#include "scene/timeline.hpp"

#include <algorithm>
#include <cmath>

#include "core/file.hpp"
#include "scene/files.hpp"
#include "scene/ray.hpp"
#include "scene/text_reader.hpp"
#include "scene/toml_table.hpp"

namespace brume::scene {
namespace {

constexpr double kLatest = 3600, kFarthest = 1e6, kDegree = 3.14159265358979323846 / 180;

constexpr std::size_t kMaxTextBytes = 1024;

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
    root.read("duration", timeline_.duration, 0.01, kLatest);
    root.read("exposure", timeline_.exposure, -20, 20);
    const toml::table* const grid = root.table("grid");
    const toml::table* const smoke = root.table("smoke");
    const toml::table* const sky = root.table("sky");
    const auto cameras = root.tables("camera");
    const auto events = root.tables("event");
    if (auto done = root.finish(); !done) return done.failure();

    timeline_.scene = path_.parent_path() / scene;
    Result<void> outcome;
    if (grid != nullptr && outcome) outcome = read_grid(*grid);
    if (smoke != nullptr && outcome) outcome = read_smoke(*smoke);
    if (sky != nullptr && outcome) outcome = read_sky(*sky);
    for (std::size_t i = 0; i < cameras.size() && outcome; ++i) outcome = read_camera(*cameras[i]);
    for (std::size_t i = 0; i < events.size() && outcome; ++i) outcome = read_event(*events[i]);
    if (!outcome) return outcome.failure();

    const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
    const auto sort = [&](auto& list) { std::stable_sort(list.begin(), list.end(), earlier); };
    sort(timeline_.smokes);
    sort(timeline_.shots);
    sort(timeline_.texts);
    sort(timeline_.blasts);
    sort(timeline_.moves);
    sort(timeline_.edits);
    sort(timeline_.doors);
    return std::move(timeline_);
  }

 private:
  Result<void> read_grid(const toml::table& source) {
    TomlTable table(source, "[grid]", file_);
    table.read("voxel", timeline_.grid.voxel, 0.015625, 10);
    table.read("size", timeline_.grid.size, 1, 4096);
    table.read("origin", timeline_.grid.origin_world, -kFarthest, kFarthest);
    return table.finish();
  }

  Result<void> read_smoke(const toml::table& source) {
    TomlTable table(source, "[smoke]", file_);
    SmokeOptions& smoke = timeline_.smoke;
    table.read("voxels", smoke.voxels, 1, 1 << 24);
    table.read("bloom", smoke.bloom, 0.05, 60);
    table.read("hold", smoke.hold, 0, kLatest);
    table.read("dissolve", smoke.dissolve, 0.05, 60);
    table.read("extinction", smoke.extinction, 0.01, 100);
    table.read("albedo", smoke.albedo, 0, 1);
    table.read("anisotropy", smoke.anisotropy, -0.9, 0.9);
    table.read("droplet", smoke.droplet, 0.1, 50);
    table.read("multiple_scattering", smoke.multiple_scattering, 0, 1);
    if (smoke.droplet && source.contains("anisotropy"))
      table.fail("droplet", "\"droplet\": expected either it or \"anisotropy\"; take one of them out");
    table.read("noise", smoke.noise, 0, 1);
    table.read("noise_size", smoke.noise_size, 0.05, 100);
    table.read("rim", smoke.rim, 0, 10);
    table.read("swirl", smoke.swirl, 0, 10);
    table.read("swirl_time", smoke.swirl_time, 0.1, kLatest);
    table.read("rise", smoke.rise, -10, 10);
    return table.finish();
  }

  Result<void> read_sky(const toml::table& source) {
    TomlTable table(source, "[sky]", file_);
    table.read("zenith", timeline_.sky.zenith, 0, 1000);
    table.read("horizon", timeline_.sky.horizon, 0, 1000);
    table.read("ambient", timeline_.sky.ambient, 0, 1000);
    table.read("stars", timeline_.sky.stars, 0, 1000);
    table.read("bounce", timeline_.sky.bounce, 0, 1);
    return table.finish();
  }

  Result<void> read_camera(const toml::table& source) {
    TomlTable table(source, "[[camera]]", file_);
    CameraKey key;
    double degrees = double{key.camera.vertical_fov} / kDegree;
    for (const char* name : {"time", "position", "target"}) table.require(name);
    table.read("time", key.time, 0, kLatest);
    table.read("position", key.camera.position_world, -kFarthest, kFarthest);
    table.read("target", key.camera.target_world, -kFarthest, kFarthest);
    table.read("fov", degrees, 1, 170);
    key.camera.vertical_fov = static_cast<float>(degrees * kDegree);
    if (key.camera.position_world == key.camera.target_world)
      table.fail("target", "\"target\": expected a point other than the position");
    if (!timeline_.camera.empty() && !(key.time > timeline_.camera.back().time))
      table.fail("time", "\"time\": expected a later time than that of the [[camera]] before");
    timeline_.camera.push_back(key);
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
    table.read("time", event.time, 0, kLatest);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("at", event.at_world, -kFarthestEvent, kFarthestEvent);
    event.place = table.place();
    timeline_.smokes.push_back(event);
    return table.finish();
  }

  Result<void> read_shot_event(TomlTable& table) {
    ShotEvent event;
    for (const char* name : {"from", "toward"}) table.require(name);
    table.read("time", event.time, 0, kLatest);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("toward", event.toward_world, -kFarthestEvent, kFarthestEvent);
    table.read("radius", event.radius, 0.01, 10);
    read_times(table, event.times);
    read_shape(table, event);
    table.read("flash", event.flash, 0, 1e6);
    if (event.from_world == event.toward_world)
      table.fail("toward", "\"toward\": expected a point other than \"from\"");
    event.place = table.place();
    timeline_.shots.push_back(event);
    return table.finish();
  }

  Result<void> read_text_event(TomlTable& table) {
    TextEvent event;
    for (const char* name : {"text", "from", "toward"}) table.require(name);
    table.read("time", event.time, 0, kLatest);
    table.read("text", event.text);
    table.read("from", event.from_world, -kFarthestEvent, kFarthestEvent);
    table.read("toward", event.toward_world, -kFarthestEvent, kFarthestEvent);
    table.read("size", event.size, 0.02, 10);
    table.read("spacing", event.spacing, -0.5, 10);
    table.read("interval", event.interval, 0, 10);
    read_times(table, event.times);
    read_roll(table, event.roll);
    read_file_name(table, "font", event.font);
    if (event.text.empty() || event.text.size() > kMaxTextBytes)
      table.fail("text", "\"text\": expected 1 to 1024 bytes");
    if (event.from_world == event.toward_world)
      table.fail("toward", "\"toward\": expected a point other than \"from\"");
    event.place = table.place();
    timeline_.texts.push_back(std::move(event));
    return table.finish();
  }

  static void read_times(TomlTable& table, HoleTimes& times) {
    table.read("reach", times.reach, 0, 60);
    table.read("expand", times.expand, 0, 60);
    table.read("stay", times.stay, 0, 600);
    table.read("fade", times.fade, 0, 60);
  }

  static void read_roll(TomlTable& table, float& roll) {
    double degrees = 0;
    table.read("roll", degrees, -360, 360);
    roll = static_cast<float>(degrees * kDegree);
  }

  /// A file below the timeline's folder.
  void read_file_name(TomlTable& table, const char* key, std::filesystem::path& file) const {
    std::string name;
    table.read(key, name);
    if (name.empty()) return;
    if (!is_safe_relative(name))
      table.fail(key, in_quotes(key) + ": expected the name of a file below the timeline's folder");
    file = path_.parent_path() / name;
  }

  void read_shape(TomlTable& table, ShotEvent& event) const {
    std::string shape = "cylinder";
    table.read("shape", shape);
    read_roll(table, event.roll);
    read_file_name(table, "mask", event.mask);
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
    table.read("time", event.time, 0, kLatest);
    table.read("at", event.at_world, -kFarthestEvent, kFarthestEvent);
    table.read("radius", event.radius, 0.1, 100);
    table.read("speed", event.speed, 1, 10000);
    table.read("left", event.left, 0, 1);
    table.read("refill_rim", event.refill_rim, 0.01, 60);
    table.read("refill_middle", event.refill_middle, 0.01, 60);
    table.read("flash", event.flash, 0, 1e6);
    if (event.refill_middle < event.refill_rim)
      table.fail("refill_middle", "\"refill_middle\": expected no less than \"refill_rim\"");
    event.place = table.place();
    timeline_.blasts.push_back(event);
    return table.finish();
  }

  Result<void> read_move_event(TomlTable& table) {
    MoveEvent event;
    for (const char* name : {"body", "to"}) table.require(name);
    table.read("time", event.time, 0, kLatest);
    table.read("body", event.body);
    table.read("to", event.to_world, -kFarthestEvent, kFarthestEvent);
    event.place = table.place();
    timeline_.moves.push_back(event);
    return table.finish();
  }

  Result<void> read_edit_event(TomlTable& table) {
    EditEvent event;
    for (const char* name : {"low", "high", "solid"}) table.require(name);
    table.read("time", event.time, 0, kLatest);
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
    table.read("time", event.time, 0, kLatest);
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

Result<void> check_doors(const Timeline& timeline, const Scene& scene) {
  for (const DoorEvent& door : timeline.doors) {
    const auto& objects = scene.objects;
    if (std::any_of(objects.begin(), objects.end(), [&](const Object& o) { return o.name == door.object; }))
      continue;
    std::string message =
        (door.place.empty() ? "" : door.place + ": ") + "the scene has no object " + in_quotes(door.object);
    const auto distance = [&](const Object& o) { return edit_distance(o.name, door.object); };
    const auto nearest =
        std::min_element(objects.begin(), objects.end(),
                         [&](const Object& a, const Object& b) { return distance(a) < distance(b); });
    if (nearest != objects.end()) message += "; the nearest name is " + in_quotes(nearest->name);
    return Failure{ErrorCode::bad_input, message};
  }
  return {};
}

Timeline timeline_for_scene(const std::filesystem::path& path, const Scene& scene) {
  Timeline timeline;
  timeline.scene = path;
  const Camera camera = default_camera(scene);
  // A scene smaller than a room gets voxels to its size.
  const Bounds bounds = world_bounds(scene);
  const glm::vec3 extent = bounds.empty() ? glm::vec3(10) : bounds.max - bounds.min;
  const float room_voxel = timeline.grid.voxel;
  timeline.grid.voxel = std::clamp(std::max({extent.x, extent.y, extent.z}) / 40, 0.015625f, room_voxel);
  // And smoke that looks as it would in a room: a ball that does not hide the whole scene.
  const float radius_voxels = 0.25f * std::max({extent.x, extent.y, extent.z}) / timeline.grid.voxel;
  const float ball = 4.19f * radius_voxels * radius_voxels * radius_voxels;
  timeline.smoke.voxels =
      static_cast<std::uint32_t>(std::clamp(ball, 50.0f, static_cast<float>(timeline.smoke.voxels)));
  const float scale = timeline.grid.voxel / room_voxel;
  timeline.smoke.extinction = std::min(timeline.smoke.extinction / scale, 100.0f);
  timeline.smoke.noise_size = std::max(timeline.smoke.noise_size * scale, 0.05f);
  timeline.smoke.swirl *= scale;
  timeline.smoke.rise *= scale;
  SmokeEvent smoke;
  smoke.from_world = camera.position_world;
  smoke.at_world = first_hit(scene, camera.position_world, camera.target_world - camera.position_world)
                       .value_or(camera.target_world);
  timeline.smokes.push_back(smoke);
  return timeline;
}

}  // namespace brume::scene
