// Random timelines with all kinds of contents.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "scene/event_fields.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// Draws settings from their whole ranges, including the ends, tiny numbers and -0; keeps some defaults.
class Drawing {
 public:
  explicit Drawing(std::uint32_t seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double share() { return static_cast<double>(random_()) / 4294967296.0; }
  double number(double low, double high) {
    switch (below(6)) {
      case 0:
        return low;
      case 1:
        return high;
      case 2:
        return std::clamp(-0.0, low, high);
      case 3:
        return std::clamp(std::ldexp(share() - 0.5, -static_cast<int>(below(160))), low, high);
      default:
        return low + (high - low) * share();
    }
  }
  float real(double low, double high) {
    auto value = static_cast<float>(number(low, high));
    if (double{value} > high) value = std::nextafter(value, -INFINITY);
    if (double{value} < low) value = std::nextafter(value, INFINITY);
    return value;
  }
  glm::vec3 point(double low, double high) { return {real(low, high), real(low, high), real(low, high)}; }
  glm::vec3 place() { return point(-kFarthestEvent, kFarthestEvent); }
  double time() { return below(4) == 0 ? below(8) * 0.125 : number(0, kLatestTime); }
  std::string text() {
    const char* const letters[] = {"a",  "Z",    " ",    "\"",       "\\",           "\n",
                                   "\t", "\x01", "\x7f", "\xc9\x8c", "\xe6\xbc\xa2", "#"};
    std::string text = letters[below(12)];
    for (std::uint32_t more = below(12); more > 0; --more) text += letters[below(12)];
    return text;
  }

  void operator()(const OptionInfo& info, float& member) {
    if (below(4) == 0) return;
    // An angle that the reader gets from degrees, or a neighbouring float.
    if (!is_angle(info)) return void(member = real(info.low, info.high));
    member = static_cast<float>(number(info.low, info.high) * kRadiansOfDegree);
    const double degrees = double{member} / kRadiansOfDegree;
    if (degrees > info.low + 1 && degrees < info.high - 1 && below(2) == 0)
      member = std::nextafter(member, below(2) == 0 ? -INFINITY : INFINITY);
  }
  void operator()(const OptionInfo& info, std::uint32_t& member) {
    member = static_cast<std::uint32_t>(std::lround(number(info.low, info.high)));
  }
  void operator()(const OptionInfo& info, glm::vec3& member) {
    if (below(4) != 0) member = point(info.low, info.high);
  }
  void operator()(const OptionInfo& info, std::optional<float>& member) {
    if (below(2) == 0) member = real(info.low, info.high);
  }
  void operator()(const OptionInfo& info, std::optional<glm::vec3>& member) {
    if (below(2) == 0) member = point(info.low, info.high);
  }
  void operator()(const OptionInfo& info, std::optional<glm::ivec3>& member) {
    if (below(2) == 0) member = glm::ivec3(point(info.low, info.high));
  }
  template <typename Choice>
  void operator()(const ChoiceField& field, Choice& choice) {
    choice = static_cast<Choice>(below(static_cast<std::uint32_t>(field.names.size())));
  }

 private:
  std::mt19937 random_;
};

/// Draws the fields of an event, within its rules: a visitor of scene/event_fields.hpp.
struct EventDrawing {
  Drawing& draw;

  void operator()(const PointField&, glm::vec3& point) { point = draw.place(); }
  void operator()(const TextField& field, std::string& text) {
    do text = draw.text();
    while (fault_of(field, text));
  }
  void operator()(const FlagField&, bool& flag) { flag = draw.below(2) == 0; }
  void operator()(const FileField& field, std::filesystem::path& file) {
    if (draw.below(2) == 0) file = file_of(field.key);
  }
  void operator()(const ChoiceField& field, auto& choice) {
    const auto drawn = draw.below(static_cast<std::uint32_t>(field.names.size()));
    choice = static_cast<std::remove_reference_t<decltype(choice)>>(drawn);
  }
  void operator()(const OptionInfo& info, auto& member) { draw(info, member); }

  // What breaks a rule changes.
  void operator()(const EventRule& rule, glm::vec3& value, glm::vec3& other) {
    if (rule.kind == RuleKind::differs) {
      value = other.x > 0 ? glm::vec3(-1.5f, 0, 0) : glm::vec3(1.5f, 0, 0);
    } else {
      other = draw.point(-kFarthestEvent, -0.001);
      value = draw.point(0, kFarthestEvent);
    }
  }
  void operator()(const EventRule&, float& value, float other) { value = std::max(value, other); }
  void operator()(const EventRule& rule, std::filesystem::path& file, ShotShape shape) {
    file.clear();
    if (!holds(rule, file, shape)) file = file_of(rule.key);
  }

 private:
  std::string file_of(const char* key) {
    return std::string("scenes/") + key + "/a " + std::to_string(draw.below(3)) + ".png";
  }
};

template <typename Event>
std::vector<Event> random_events(Drawing& draw) {
  std::vector<Event> events(draw.below(6));
  for (Event& event : events) {
    visit_event(event, EventDrawing{draw});
    event.time = draw.time();
  }
  std::ranges::stable_sort(events, {}, &Event::time);
  return events;
}

/// Positions that rise, some of them twice.
inline std::vector<float> random_positions(Drawing& draw) {
  std::vector<float> positions;
  for (std::uint32_t count = 2 + draw.below(5); count > 0; --count) positions.push_back(draw.real(0, 1));
  std::sort(positions.begin(), positions.end());
  return positions;
}

inline void draw_transfer(Drawing& draw, VolumeOptions& volume) {
  if (draw.below(2) == 0) volume.range = glm::vec2(draw.real(-1e30, -1e-20), draw.real(0, 1e30));
  if (draw.below(2) == 0)
    for (const float at : random_positions(draw)) volume.opacity.push_back({at, draw.real(0, 1)});
  if (draw.below(3) == 0) {
    const auto names = color_map_names();
    volume.color_map.name = names[draw.below(static_cast<std::uint32_t>(names.size()))];
  } else if (draw.below(2) == 0) {
    for (const float at : random_positions(draw)) volume.color_map.points.push_back({at, draw.point(0, 1)});
  }
}

/// Some text of its own, with an ending that no other has.
inline std::string random_name(Drawing& draw, std::size_t number) {
  return draw.text() + std::to_string(number);
}

/// A carrier, or none.
inline std::string random_carrier_name(Drawing& draw, const std::vector<Carrier>& carriers) {
  const std::uint32_t chosen = draw.below(static_cast<std::uint32_t>(carriers.size()) + 1);
  return chosen < carriers.size() ? carriers[chosen].name : "";
}

/// Calls add(time) for at least `fewest` times that rise.
inline void some_keys(Drawing& draw, std::uint32_t fewest, const std::function<void(double)>& add) {
  double time = draw.below(2) == 0 ? 0 : draw.share();
  for (std::uint32_t keys = fewest + draw.below(4); keys > 0; --keys, time += 0.01 + draw.share()) add(time);
}

inline Carrier random_carrier(Drawing& draw, std::size_t number) {
  Carrier carrier;
  carrier.name = random_name(draw, number);
  if (draw.below(2) == 0) carrier.object = random_name(draw, number);
  some_keys(draw, 1, [&](double time) {
    CarrierKey key{time, draw.point(-kFarthestPoint, kFarthestPoint)};
    visit_carrier_options(key, draw);
    carrier.keys.push_back(key);
  });
  return carrier;
}

inline VolumeMask random_mask(Drawing& draw) {
  VolumeMask mask;
  mask.grid = draw.text();
  visit_mask_options(mask, draw);
  if (draw.below(2) == 0)
    some_keys(draw, 1, [&](double time) {
      MaskKey key{time};
      visit_mask_options(key, draw);
      mask.keys.push_back(key);
    });
  return mask;
}

/// What a volume glows and moves with.
inline void draw_effects(Drawing& draw, const std::vector<Carrier>& carriers, VolumeOptions& volume) {
  volume.carrier = random_carrier_name(draw, carriers);
  if (volume.color.empty())
    for (std::uint32_t masks = draw.below(kMostMasks + 1); masks > 0; --masks)
      volume.masks.push_back(random_mask(draw));
  if (draw.below(2) == 0) visit_disturbance_options(volume.disturbance, draw);
  if (draw.below(2) == 0) visit_detail_options(volume.detail, draw);
  if (draw.below(2) == 0) visit_particle_options(volume, draw);
  if (volume.masks.empty()) volume.particles = 0;
}

inline DecalOptions random_decal(Drawing& draw, const std::vector<Carrier>& carriers) {
  DecalOptions decal;
  decal.file = "scenes/" + std::to_string(draw.below(3)) + ".vdb";
  if (draw.below(2) == 0) decal.grid = draw.text();
  decal.carrier = random_carrier_name(draw, carriers);
  decal.position_world = draw.point(-kFarthestPoint, kFarthestPoint);
  visit_decal_options(decal, draw);
  return decal;
}

inline TankOptions random_tank(Drawing& draw, const std::vector<Carrier>& carriers) {
  TankOptions tank;
  tank.file = "scenes/" + std::to_string(draw.below(3)) + ".toml";
  tank.carrier = random_carrier_name(draw, carriers);
  tank.position_world = draw.point(-kFarthestPoint, kFarthestPoint);
  visit_tank_options(tank, draw);
  if (draw.below(2) == 0) tank.view = TankView{draw.below(2)};
  return tank;
}

inline Timeline random_timeline(std::uint32_t seed) {
  Drawing draw(seed);
  Timeline timeline;
  timeline.scene = "scenes/" + std::string(draw.below(2) == 0 ? "demo.gltf" : "level \"1\"/Scene.txt");
  visit_timeline_options(timeline, draw);
  visit_grid_options(timeline.grid, draw);
  visit_smoke_options(timeline.smoke, draw);
  if (timeline.smoke.droplet) timeline.smoke.anisotropy = SmokeOptions().anisotropy;
  visit_sky_options(timeline.sky, draw);
  if (draw.below(2) == 0) visit_sun_options(timeline.sun.emplace(), draw);
  for (std::uint32_t carriers = draw.below(3); carriers > 0; --carriers)
    timeline.carriers.push_back(random_carrier(draw, carriers));
  for (std::uint32_t decals = draw.below(3); decals > 0; --decals)
    timeline.decals.push_back(random_decal(draw, timeline.carriers));
  for (std::uint32_t tanks = draw.below(3); tanks > 0; --tanks)
    timeline.tanks.push_back(random_tank(draw, timeline.carriers));
  for (std::uint32_t roles = draw.below(3); roles > 0; --roles)
    timeline.roles.push_back({random_name(draw, roles), static_cast<Role>(draw.below(4))});
  for (std::uint32_t volumes = draw.below(3); volumes > 0; --volumes) {
    VolumeOptions& volume = timeline.volumes.emplace_back();
    volume.file = "scenes/" + std::to_string(volumes) + "_%04d.vdb";
    if (draw.below(2) == 0) volume.density = draw.text();
    if (draw.below(2) == 0) volume.heat = draw.text();
    if (draw.below(2) == 0) volume.color = draw.text();
    volume.position_world = draw.place();
    visit_volume_options(volume, draw);
    draw_transfer(draw, volume);
    draw_effects(draw, timeline.carriers, volume);
    volume.loop = draw.below(2) == 0;
    volume.clip = !volume.loop && draw.below(2) == 0;
    volume.ping_pong = !volume.loop && !volume.clip && draw.below(2) == 0;
    if (draw.below(2) == 0) volume.first = draw.below(1000);
    if (draw.below(2) == 0) volume.last = 1000 + draw.below(kLastFrame - 1000);
  }
  double time = draw.share();
  for (std::uint32_t keys = draw.below(4); keys > 0; --keys, time += 0.01 + draw.share()) {
    CameraKey key{time, {draw.place(), draw.place(), 1}};
    visit_camera_options(key.camera, draw);
    if (draw.below(2) == 0) key.camera.lens.opening = "scenes/opening.png";
    if (key.camera.position_world != key.camera.target_world) timeline.camera.push_back(key);
  }
  for_each_event_list(timeline, [&]<typename Event>(const char*, std::vector<Event>& list) {
    list = random_events<Event>(draw);
  });
  return timeline;
}

}  // namespace brume::scene
