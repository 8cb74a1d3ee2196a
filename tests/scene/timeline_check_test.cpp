#include "scene/files/timeline_check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "scene/files/timeline_reader.hpp"
#include "scene/files/timeline_writer.hpp"
#include "tests/sanitized.hpp"
#include "tests/scene/random_timeline.hpp"

namespace brume::scene {
namespace {

/// Sets a few numbers of a timeline near and beyond the ends of their ranges.
class Spoiler {
 public:
  Spoiler(Drawing& draw, std::uint32_t one_in) : draw_(draw), one_in_(one_in) {}

  void operator()(const OptionInfo& info, float& member) {
    const double unit = is_angle(info) ? kRadiansOfDegree : 1;
    if (draw_.below(one_in_) == 0) member = odd(info.low * unit, info.high * unit);
  }
  void operator()(const OptionInfo& info, std::uint32_t& member) {
    if (draw_.below(one_in_) == 0)
      member = draw_.below(2) == 0 ? 0 : static_cast<std::uint32_t>(info.high) + 1;
  }
  template <typename Vector>
  requires(Vector::length() == 3) void operator()(const OptionInfo& info, Vector& member) {
    if (draw_.below(one_in_) == 0)
      member[1] = static_cast<typename Vector::value_type>(draw_.below(2) == 0 ? info.high * 1.5 + 1
                                                                               : info.low * 0.99 - 0.5);
  }
  template <typename Member>
  void operator()(const OptionInfo& info, std::optional<Member>& member) {
    if (member) (*this)(info, *member);
  }
  void operator()(const ChoiceField&, const auto&) {}
  void place(glm::vec3& place) {
    if (draw_.below(one_in_) == 0) place.z = odd(-kFarthestEvent, kFarthestEvent);
  }
  void fraction(float& number) {
    if (draw_.below(one_in_) == 0) number = odd(0, 1);
  }
  void end(float& value) {
    if (draw_.below(one_in_) == 0) value = odd(-1e30, 1e30);
  }
  void time(double& time) {
    if (draw_.below(one_in_) == 0) time = double{odd(0, kLatestTime)};
  }

 private:
  float odd(double low, double high) {
    const auto first = static_cast<float>(low), last = static_cast<float>(high);
    switch (draw_.below(6)) {
      case 0:
        return std::nextafter(first, -INFINITY);
      case 1:
        return first;
      case 2:
        return last;
      case 3:
        return std::nextafter(last, INFINITY);
      case 4:
        return std::numeric_limits<float>::quiet_NaN();
      default:
        return std::numeric_limits<float>::infinity();
    }
  }
  Drawing& draw_;
  std::uint32_t one_in_;
};

/// Spoils the points and numbers of an event: a visitor of scene/event_fields.hpp.
struct EventSpoiler {
  Spoiler& s;
  void operator()(const PointField&, glm::vec3& point) { s.place(point); }
  void operator()(const OptionInfo& info, auto& member) { s(info, member); }
  void operator()(const auto&, auto&...) {}
};

void spoil_effects(VolumeOptions& volume, Spoiler& s) {
  for (VolumeMask& mask : volume.masks) {
    visit_mask_options(mask, s);
    for (MaskKey& key : mask.keys) s.time(key.time), visit_mask_options(key, s);
  }
  visit_disturbance_options(volume.disturbance, s);
  visit_detail_options(volume.detail, s);
  visit_particle_options(volume, s);
}

void spoil(Timeline& t, Spoiler& s) {
  visit_timeline_options(t, s);
  visit_grid_options(t.grid, s);
  visit_smoke_options(t.smoke, s);
  visit_sky_options(t.sky, s);
  if (t.sun) visit_sun_options(*t.sun, s);
  for (VolumeOptions& v : t.volumes) {
    s.place(v.position_world), visit_volume_options(v, s);
    for (OpacityPoint& point : v.opacity) s.fraction(point.at), s.fraction(point.opacity);
    for (ColorPoint& point : v.color_map.points) s.fraction(point.at), s.fraction(point.color.g);
    if (v.range) s.end(v.range->y);
    spoil_effects(v, s);
  }
  for (Carrier& carrier : t.carriers)
    for (CarrierKey& key : carrier.keys)
      s.time(key.time), s.place(key.position_world), visit_carrier_options(key, s);
  for (DecalOptions& decal : t.decals) s.place(decal.position_world), visit_decal_options(decal, s);
  for (TankOptions& tank : t.tanks) s.place(tank.position_world), visit_tank_options(tank, s);
  for (CameraKey& key : t.camera) s.time(key.time), visit_camera_options(key.camera, s);
  for_each_event_list(t, [&](const char*, auto& list) {
    for (auto& e : list) s.time(e.time), visit_event(e, EventSpoiler{s});
  });
}

TEST(TimelineCheck, AcceptsExactlyWhatTheReaderAccepts) {
  constexpr int kTimelines = kSanitized ? 600 : 3000;
  int good = 0, bad = 0;
  for (std::uint32_t seed = 0; seed < kTimelines; ++seed) {
    Timeline timeline = random_timeline(seed);
    timeline.smoke.droplet.reset();  // with it the anisotropy is not written
    Drawing draw(seed);
    Spoiler spoiler(draw, 150);
    spoil(timeline, spoiler);
    const auto settings = check_settings(timeline), events = check_events(timeline);
    const auto read = parse_timeline(format_timeline(timeline, "scenes"), "scenes/t.toml");
    ASSERT_EQ(settings && events, static_cast<bool>(read))
        << "seed " << seed << ": " << settings.failure().message << events.failure().message
        << (read ? "" : read.failure().message);
    ++(read ? good : bad);
  }
  EXPECT_GT(good, kTimelines / 6);
  EXPECT_GT(bad, kTimelines / 6);
}

TEST(TimelineCheck, NamesTheEventAndTheNumber) {
  Timeline timeline;
  const auto message = [&] { return check_events(timeline).failure().message; };
  timeline.shots.resize(1);
  timeline.shots[0].time = 1.5;
  timeline.shots[0].radius = 11;
  EXPECT_EQ(message(), "shot at 1.5 s: \"radius\": expected a number from 0.01 to 10, found 11");
  timeline.shots[0] = {};
  timeline.shots[0].roll = 7;
  EXPECT_EQ(message(), "shot at 0 s: \"roll\": expected a number from -360 to 360, found 401.07");
  timeline.shots[0] = {};
  timeline.shots[0].toward_world = timeline.shots[0].from_world;
  EXPECT_EQ(message(), "shot at 0 s: \"toward\": expected a point other than \"from\"");
  timeline.shots[0] = {};
  timeline.shots[0].shape = ShotShape::mask;
  EXPECT_EQ(message(), "shot at 0 s: \"mask\": expected a picture if the shape is a mask, and only then");
  timeline.shots.clear();
  timeline.texts.resize(1);
  EXPECT_EQ(message(), "text at 0 s: \"text\": expected 1 to 1024 bytes");
  timeline.texts[0].text = "\xff";
  EXPECT_EQ(message(), "text at 0 s: \"text\": expected UTF-8");
  timeline.texts.clear();
  timeline.blasts.resize(1);
  timeline.blasts[0].time = std::nan("");
  EXPECT_EQ(message(), "blast: \"time\": expected a number from 0 to 3600, found nan");
  timeline.camera = {{1, {}}, {1, {}}};
  EXPECT_EQ(check_settings(timeline).failure().message,
            "camera at 1 s: \"time\": expected a later time than the previous key's");
}

/// A timeline with one of each: a carrier, a volume with a mask, a decal, a tank, a role.
Timeline with_effects() {
  Timeline timeline;
  timeline.scene = "a.glb";
  timeline.carriers.resize(1);
  timeline.carriers[0].name = "ship";
  timeline.carriers[0].object = "hull";
  timeline.carriers[0].keys.resize(2);
  timeline.carriers[0].keys[1].time = 1;
  timeline.volumes.resize(1);
  timeline.volumes[0].file = "f.vdb";
  timeline.volumes[0].carrier = "ship";
  timeline.volumes[0].masks.resize(1);
  timeline.volumes[0].masks[0].grid = "fire";
  timeline.decals.resize(1);
  timeline.decals[0].file = "ao.vdb";
  timeline.decals[0].carrier = "ship";
  timeline.tanks.resize(1);
  timeline.tanks[0].file = "reef.toml";
  timeline.tanks[0].carrier = "ship";
  timeline.roles = {{"fence", Role::grille}};
  return timeline;
}

TEST(TimelineCheck, NamesCarriersMasksDecalsAndTanks) {
  const auto expect = [](const auto& change, const std::string& message) {
    Timeline timeline = with_effects();
    ASSERT_TRUE(check_settings(timeline));
    change(timeline);
    EXPECT_EQ(check_settings(timeline).failure().message, message);
    // A file with the same fault is refused, too.
    EXPECT_FALSE(parse_timeline(format_timeline(timeline, ""), "t.toml")) << message;
  };
  expect([](Timeline& t) { t.decals[0].strength = 2; },
         "[[decal]] ao.vdb: \"strength\": expected a number from 0 to 1, found 2");
  expect([](Timeline& t) { t.decals[0].carrier = "shop"; },
         "[[decal]] ao.vdb: \"carrier\": expected the name of a [[carrier]]");
  expect([](Timeline& t) { t.decals.resize(kMostDecals + 1, t.decals[0]); },
         "[[decal]]: expected at most 32 of them");
  expect([](Timeline& t) { t.tanks[0].samples = 65; },
         "[[tank]] reef.toml: \"samples\": expected a number from 1 to 64, found 65");
  expect([](Timeline& t) { t.tanks[0].carrier = "shop"; },
         "[[tank]] reef.toml: \"carrier\": expected the name of a [[carrier]]");
  expect([](Timeline& t) { t.tanks.resize(kMostTanks + 1, t.tanks[0]); },
         "[[tank]]: expected at most 4 of them");
  expect([](Timeline& t) { t.carriers.clear(); },
         "[[volume]] f.vdb: \"carrier\": expected the name of a [[carrier]]");
  expect([](Timeline& t) { t.volumes[0].masks[0].intensity = -1; },
         "[[volume]] f.vdb: mask fire: \"intensity\": expected a number from 0 to 1e+06, found -1");
  expect(
      [](Timeline& t) {
        t.volumes[0].masks[0].keys.assign(2, {2, {}, 1});
      },
      "[[volume]] f.vdb: mask fire: key at 2 s: \"time\": expected a later time than the previous key's");
  expect([](Timeline& t) { t.volumes[0].masks.resize(kMostMasks + 1, t.volumes[0].masks[0]); },
         "[[volume]] f.vdb: \"mask\": expected at most 4 of them");
  expect([](Timeline& t) { t.volumes[0].color = "Cd"; },
         "[[volume]] f.vdb: \"color\": cannot be combined with [[volume.mask]]");
  expect([](Timeline& t) { t.volumes[0].masks.clear(), t.volumes[0].particles = 9; },
         "[[volume]] f.vdb: \"particles\": expected a [[volume.mask]]");
  expect([](Timeline& t) { t.volumes[0].disturbance.size = 0; },
         "[[volume]] f.vdb: [volume.disturb]: \"size\": expected a number from 1e-06 to 1e+06, found 0");
  expect([](Timeline& t) { t.carriers[0].keys.clear(); }, "[[carrier]] ship: \"key\": expected at least one");
  expect([](Timeline& t) { t.carriers[0].keys[1].time = 0; },
         "[[carrier]] ship: key at 0 s: \"time\": expected a later time than the previous key's");
  expect([](Timeline& t) { t.carriers[0].keys[1].rotation.z = 40000; },
         "[[carrier]] ship: key at 1 s: \"rotation\": expected a number from -36000 to 36000, found 40000");
  expect([](Timeline& t) { t.carriers.push_back(t.carriers[0]), t.carriers[1].object = ""; },
         "[[carrier]]: \"name\": expected a name of its own for each");
  expect([](Timeline& t) { t.carriers.push_back(t.carriers[0]), t.carriers[1].name = "tug"; },
         "[[carrier]]: \"object\": expected one carrier for each object");
  expect([](Timeline& t) { t.roles[0].object.clear(); },
         "[[role]]: \"object\": expected the name of an object");
  expect(
      [](Timeline& t) {
        t.roles.push_back({"fence", Role::wall});
      },
      "[[role]]: \"object\": expected one role for each object");
}

}  // namespace
}  // namespace brume::scene
