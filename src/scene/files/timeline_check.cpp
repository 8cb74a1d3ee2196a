#include "scene/files/timeline_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/utf8.hpp"
#include "scene/event_fields.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

/// Checks the members of one event or table; keeps the first failure. A visitor of scene/options.hpp.
class Checker {
 public:
  explicit Checker(std::string subject) : subject_(std::move(subject)) {}
  template <typename Event>
  Checker(const char* kind, const Event& event) : subject_(kind) {
    number("time", event.time, 0, kLatestTime);
    subject_ += " at " + shown(event.time) + " s";
  }

  void operator()(const OptionInfo& info, const float& member) {
    if (is_in_range(info, member)) return;
    out_of_range(info.key, double{member} / (is_angle(info) ? kRadiansOfDegree : 1), info.low, info.high);
  }
  void operator()(const OptionInfo& info, const std::uint32_t& member) {
    number(info.key, member, info.low, info.high);
  }
  template <typename Vector>
  requires(Vector::length() == 3) void operator()(const OptionInfo& info, const Vector& member) {
    for (int axis = 0; axis < 3; ++axis) number(info.key, double(member[axis]), info.low, info.high);
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const std::optional<Member>& member) {
    if (member) (*this)(info, *member);
  }
  void operator()(const ChoiceField&, const auto&) {}

  void number(const char* key, double value, double low, double high) {
    if (!(value >= low && value <= high)) out_of_range(key, value, low, high);
  }
  void point(const char* key, glm::vec3 point, double farthest) {
    for (int axis = 0; axis < 3; ++axis) number(key, double{point[axis]}, -farthest, farthest);
  }
  void place(const char* key, glm::vec3 place) { point(key, place, kFarthestEvent); }
  void direction(const char* key, glm::vec3 from, glm::vec3 to, const char* other) {
    if (from == to) fail(key, "expected a point other than " + std::string(other));
  }
  void text(const char* key, const std::string& text) {
    if (!is_utf8(text)) fail(key, "expected UTF-8");
  }
  void fail(const char* key, const std::string& what) {
    if (failed_) return;
    failed_ = true;
    failure_ = {ErrorCode::bad_input, subject_ + ": \"" + key + "\": " + what};
  }
  Result<void> done() const { return failed_ ? Result<void>(failure_) : Result<void>(); }

 private:
  void out_of_range(const char* key, double value, double low, double high) {
    fail(key, "expected a number from " + shown(low) + " to " + shown(high) + ", found " + shown(value));
  }

  std::string subject_;
  bool failed_ = false;
  Failure failure_;
};

/// Checks the fields of an event: the visitor of scene/event_fields.hpp.
struct EventCheck {
  Checker& look;

  void operator()(const OptionInfo& info, const auto& member) { look(info, member); }
  void operator()(const PointField& field, const glm::vec3& point) { look.place(field.key, point); }
  void operator()(const TextField& field, const std::string& text) {
    if (const auto fault = fault_of(field, text)) look.fail(field.key, "expected " + *fault);
    look.text(field.key, text);
  }
  void operator()(const FileField& field, const std::filesystem::path& file) {
    look.text(field.key, file.string());
  }
  void operator()(const EventRule& rule, const auto& value, const auto& other) {
    if (!holds(rule, value, other)) look.fail(rule.key, "expected " + expectation(rule));
  }
  void operator()(const FlagField&, bool) {}
  void operator()(const ChoiceField&, const auto&) {}
};

template <typename Event>
Result<void> check(const char* kind, const Event& event) {
  Checker look(kind, event);
  visit_event(event, EventCheck{look});
  return look.done();
}

void check_transfer(const VolumeOptions& volume, Checker& look) {
  const auto expect_none = [&](const char* key, const std::optional<PointFault>& fault) {
    if (fault)
      look.fail(key, (fault->point ? "point " + std::to_string(*fault->point + 1) + ": " : "") + fault->what);
  };
  if (volume.range)
    if (const auto fault = fault_of_range(*volume.range)) look.fail("range", *fault);
  if (!volume.opacity.empty()) expect_none("opacity", fault_of(std::span(volume.opacity)));
  expect_none("color_map", fault_of(volume.color_map));
}

/// Whether a list has several entries of one name; empty names do not count.
template <typename Entry>
bool has_twice(const std::vector<Entry>& list, std::string Entry::*name) {
  std::vector<std::string> names;
  for (const Entry& entry : list)
    if (!(entry.*name).empty()) names.push_back(entry.*name);
  std::ranges::sort(names);
  return std::ranges::adjacent_find(names) != names.end();
}

/// Keys in strictly rising order of time; `check_one(key, checker)` checks the rest of each.
template <typename Key, typename CheckOne>
Result<void> check_keys(const char* kind, const std::vector<Key>& keys, CheckOne check_one) {
  double last = -1;
  for (const Key& key : keys) {
    Checker of_key(kind, key);
    check_one(key, of_key);
    if (!(key.time > last)) of_key.fail("time", "expected a later time than the previous key's");
    last = key.time;
    if (auto done = of_key.done(); !done) return done;
  }
  return {};
}

Result<void> check_carriers(const std::vector<Carrier>& carriers) {
  for (const Carrier& carrier : carriers) {
    Checker of_carrier("[[carrier]] " + carrier.name);
    of_carrier.text("name", carrier.name);
    of_carrier.text("object", carrier.object);
    if (carrier.name.empty()) of_carrier.fail("name", "expected a name");
    if (carrier.keys.empty()) of_carrier.fail("key", "expected at least one");
    if (auto done = of_carrier.done(); !done) return done;
    auto keys = check_keys(("[[carrier]] " + carrier.name + ": key").c_str(), carrier.keys,
                           [](const CarrierKey& key, Checker& look) {
                             look.point("position", key.position_world, kFarthestPoint);
                             visit_carrier_options(key, look);
                           });
    if (!keys) return keys;
  }
  Checker all("[[carrier]]");
  if (has_twice(carriers, &Carrier::name)) all.fail("name", "expected a name of its own for each");
  if (has_twice(carriers, &Carrier::object)) all.fail("object", "expected one carrier for each object");
  return all.done();
}

void check_carrier_name(const Timeline& timeline, const std::string& name, Checker& look) {
  if (!name.empty() && std::ranges::find(timeline.carriers, name, &Carrier::name) == timeline.carriers.end())
    look.fail("carrier", "expected the name of a [[carrier]]");
}

Result<void> check_masks(const VolumeOptions& volume, const std::string& subject) {
  for (const VolumeMask& mask : volume.masks) {
    Checker of_mask(subject + ": mask " + mask.grid);
    of_mask.text("grid", mask.grid);
    if (mask.grid.empty()) of_mask.fail("grid", "expected the name of a grid");
    visit_mask_options(mask, of_mask);
    if (auto done = of_mask.done(); !done) return done;
    auto keys = check_keys((subject + ": mask " + mask.grid + ": key").c_str(), mask.keys,
                           [](const MaskKey& key, Checker& look) { visit_mask_options(key, look); });
    if (!keys) return keys;
  }
  Checker all(subject);
  if (volume.masks.size() > kMostMasks)
    all.fail("mask", "expected at most " + std::to_string(kMostMasks) + " of them");
  if (!volume.masks.empty() && !volume.color.empty())
    all.fail("color", "cannot be combined with [[volume.mask]]");
  visit_particle_options(volume, all);
  if (volume.particles > 0 && volume.masks.empty()) all.fail("particles", "expected a [[volume.mask]]");
  return all.done();
}

Result<void> check_volume(const Timeline& timeline, const VolumeOptions& volume) {
  const std::string subject = "[[volume]] " + volume.file.filename().string();
  Checker look(subject);
  look.text("file", volume.file.string());
  look.text("density", volume.density);
  look.text("heat", volume.heat);
  look.text("color", volume.color);
  check_transfer(volume, look);
  look.point("position", volume.position_world, kFarthestPoint);
  visit_volume_options(volume, look);
  if (volume.first) look.number("first", *volume.first, 0, kLastFrame);
  if (volume.last) look.number("last", *volume.last, volume.first.value_or(0), kLastFrame);
  if (volume.clip + volume.loop + volume.ping_pong > 1)
    look.fail("clip", "expected only one of \"clip\", \"loop\" and \"ping_pong\" to be true");
  check_carrier_name(timeline, volume.carrier, look);
  if (auto done = look.done(); !done) return done;
  Checker disturbance(subject + ": [volume.disturb]");
  visit_disturbance_options(volume.disturbance, disturbance);
  if (auto done = disturbance.done(); !done) return done;
  Checker detail(subject + ": [volume.detail]");
  visit_detail_options(volume.detail, detail);
  if (auto done = detail.done(); !done) return done;
  return check_masks(volume, subject);
}

Result<void> check_decal(const Timeline& timeline, const DecalOptions& decal) {
  Checker look("[[decal]] " + decal.file.filename().string());
  look.text("file", decal.file.string());
  look.text("grid", decal.grid);
  check_carrier_name(timeline, decal.carrier, look);
  look.point("position", decal.position_world, kFarthestPoint);
  visit_decal_options(decal, look);
  return look.done();
}

Result<void> check_tank(const Timeline& timeline, const TankOptions& tank) {
  Checker look("[[tank]] " + tank.file.filename().string());
  look.text("file", tank.file.string());
  check_carrier_name(timeline, tank.carrier, look);
  look.point("position", tank.position_world, kFarthestPoint);
  visit_tank_options(tank, look);
  return look.done();
}

Result<void> check_roles(const std::vector<RoleOptions>& roles) {
  Checker look("[[role]]");
  for (const RoleOptions& role : roles) {
    look.text("object", role.object);
    if (role.object.empty()) look.fail("object", "expected the name of an object");
  }
  if (has_twice(roles, &RoleOptions::object)) look.fail("object", "expected one role for each object");
  return look.done();
}

Result<void> check_count(const char* table, std::size_t count, std::size_t most) {
  if (count <= most) return {};
  return Failure{ErrorCode::bad_input,
                 std::string(table) + ": expected at most " + std::to_string(most) + " of them"};
}

}  // namespace

Result<void> check_events(const Timeline& timeline) {
  Result<void> outcome;
  for_each_event_list(timeline, [&](const char* kind, const auto& events) {
    for (auto event = events.begin(); event != events.end() && outcome; ++event)
      outcome = check(kind, *event);
  });
  return outcome;
}

Result<void> check_settings(const Timeline& timeline) {
  // The timeline's own settings, then its tables.
  Checker look("the timeline");
  visit_timeline_options(timeline, look);
  if (auto done = look.done(); !done) return done;
  Checker grid("[grid]"), smoke("[smoke]"), sky("[sky]"), sun("[sun]");
  visit_grid_options(timeline.grid, grid);
  visit_smoke_options(timeline.smoke, smoke);
  visit_sky_options(timeline.sky, sky);
  if (timeline.sun) visit_sun_options(*timeline.sun, sun);
  for (const Checker* checker : {&grid, &smoke, &sky, &sun})
    if (auto done = checker->done(); !done) return done;

  // Carriers, and what may move with them.
  if (auto done = check_carriers(timeline.carriers); !done) return done;
  if (auto done = check_count("[[volume]]", timeline.volumes.size(), kMostVolumes); !done) return done;
  if (auto done = check_count("[[decal]]", timeline.decals.size(), kMostDecals); !done) return done;
  for (const VolumeOptions& volume : timeline.volumes)
    if (auto done = check_volume(timeline, volume); !done) return done;
  for (const DecalOptions& decal : timeline.decals)
    if (auto done = check_decal(timeline, decal); !done) return done;
  if (auto done = check_count("[[tank]]", timeline.tanks.size(), kMostTanks); !done) return done;
  for (const TankOptions& tank : timeline.tanks)
    if (auto done = check_tank(timeline, tank); !done) return done;
  if (auto done = check_roles(timeline.roles); !done) return done;

  return check_keys("camera", timeline.camera, [](const CameraKey& key, Checker& of_key) {
    of_key.point("position", key.camera.position_world, kFarthestPoint);
    of_key.point("target", key.camera.target_world, kFarthestPoint);
    of_key.direction("target", key.camera.position_world, key.camera.target_world, "the position");
    visit_camera_options(key.camera, of_key);
    of_key.text("opening", key.camera.lens.opening.string());
  });
}

}  // namespace brume::scene
