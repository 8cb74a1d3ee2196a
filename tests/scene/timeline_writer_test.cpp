#include "scene/files/timeline_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/file.hpp"
#include "scene/event_fields.hpp"
#include "scene/files/timeline_reader.hpp"
#include "tests/sanitized.hpp"
#include "tests/scene/bits.hpp"
#include "tests/scene/random_timeline.hpp"
#include "tests/work_folder.hpp"

namespace brume::scene {
namespace {

namespace fs = std::filesystem;

/// The fields of an event: a visitor of scene/event_fields.hpp.
struct EventBits {
  Bits& b;
  void operator()(const FileField&, const fs::path& file) { b.add(file.string()); }
  void operator()(const ChoiceField& field, const auto& choice) { b(field, choice); }
  void operator()(const EventRule&, const auto&, const auto&) {}
  void operator()(const auto&, const auto& member) { b.add(member); }
};

template <typename Event>
void add_event(Bits& b, const Event& e) {
  visit_event(e, EventBits{b});
}

void add_transfer(Bits& b, const VolumeOptions& volume) {
  b.add(volume.color), b.add(volume.range.has_value()), b.add(volume.color_map.name);
  if (volume.range) b.add(volume.range->x), b.add(volume.range->y);
  b.add(static_cast<std::uint32_t>(volume.opacity.size()));
  for (const OpacityPoint& point : volume.opacity) b.add(point.at), b.add(point.opacity);
  b.add(static_cast<std::uint32_t>(volume.color_map.points.size()));
  for (const ColorPoint& point : volume.color_map.points) b.add(point.at), b.add(point.color);
}

template <typename Key, typename AddRest>
void add_keys(Bits& b, const std::vector<Key>& keys, AddRest add_rest) {
  b.add(static_cast<std::uint32_t>(keys.size()));
  for (const Key& key : keys) b.add(key.time), add_rest(key);
}

void add_carriers(Bits& b, const std::vector<Carrier>& carriers) {
  b.add(static_cast<std::uint32_t>(carriers.size()));
  for (const Carrier& carrier : carriers) {
    b.add(carrier.name), b.add(carrier.object);
    add_keys(b, carrier.keys, [&](const CarrierKey& key) {
      b.add(key.position_world);
      visit_carrier_options(key, b);
    });
  }
}

void add_effects(Bits& b, const VolumeOptions& volume) {
  b.add(volume.carrier), b.add(static_cast<std::uint32_t>(volume.masks.size()));
  for (const VolumeMask& mask : volume.masks) {
    b.add(mask.grid);
    visit_mask_options(mask, b);
    add_keys(b, mask.keys, [&](const MaskKey& key) { visit_mask_options(key, b); });
  }
  visit_disturbance_options(volume.disturbance, b);
  visit_detail_options(volume.detail, b);
  visit_particle_options(volume, b);
}

void add_decals(Bits& b, const std::vector<DecalOptions>& decals) {
  b.add(static_cast<std::uint32_t>(decals.size()));
  for (const DecalOptions& decal : decals) {
    b.add(decal.file.string()), b.add(decal.grid), b.add(decal.carrier), b.add(decal.position_world);
    visit_decal_options(decal, b);
  }
}

void add_tanks(Bits& b, const std::vector<TankOptions>& tanks) {
  b.add(static_cast<std::uint32_t>(tanks.size()));
  for (const TankOptions& tank : tanks) {
    b.add(tank.file.string()), b.add(tank.carrier), b.add(tank.position_world);
    visit_tank_options(tank, b);
    b.add(tank.view ? static_cast<std::uint32_t>(*tank.view) : 9u);
  }
}

std::vector<std::uint64_t> bits_of(const Timeline& timeline) {
  Bits b;
  b.add(timeline.scene.string());
  visit_timeline_options(timeline, b);
  visit_grid_options(timeline.grid, b);
  visit_smoke_options(timeline.smoke, b);
  visit_sky_options(timeline.sky, b);
  b.add(timeline.sun.has_value());
  if (timeline.sun) visit_sun_options(*timeline.sun, b);
  b.add(static_cast<std::uint32_t>(timeline.volumes.size()));
  for (const VolumeOptions& volume : timeline.volumes) {
    b.add(volume.file.string()), b.add(volume.density), b.add(volume.heat), b.add(volume.position_world);
    visit_volume_options(volume, b);
    b.add(volume.loop), b.add(volume.clip), b.add(volume.ping_pong);
    b.add(volume.first.value_or(kLastFrame + 1)), b.add(volume.last.value_or(kLastFrame + 1));
    add_transfer(b, volume);
    add_effects(b, volume);
  }
  add_carriers(b, timeline.carriers);
  add_decals(b, timeline.decals);
  add_tanks(b, timeline.tanks);
  b.add(static_cast<std::uint32_t>(timeline.roles.size()));
  for (const RoleOptions& role : timeline.roles)
    b.add(role.object), b.add(static_cast<std::uint32_t>(role.role));
  const auto add_all = [&](const auto& list) {
    b.add(static_cast<std::uint32_t>(list.size()));
    for (const auto& event : list) b.add(event.time), add_event(b, event);
  };
  add_camera(b, timeline.camera);
  for_each_event_list(timeline, [&](const char*, const auto& list) { add_all(list); });
  return b.bits;
}

TEST(TimelineWriter, RandomTimelinesRoundTripBitForBit) {
  for (std::uint32_t seed = 0; seed < (kSanitized ? 400 : 2000); ++seed) {
    const Timeline timeline = random_timeline(seed);
    const std::string text = format_timeline(timeline, "scenes");
    const auto read = parse_timeline(text, "scenes/t.toml").value_or_throw();
    ASSERT_EQ(bits_of(read), bits_of(timeline)) << "seed " << seed << "\n" << text;
    ASSERT_EQ(format_timeline(read, "scenes"), text);
  }
}

TEST(TimelineWriter, TheExtinctionOfAVolumeWithMasksRoundTrips) {
  // Its default in files differs from that of the struct.
  for (const float extinction : {0.0f, 1.0f, 2.0f}) {
    Timeline timeline;
    timeline.scene = "a.glb";
    timeline.volumes.resize(1);
    timeline.volumes[0].file = "a.vdb";
    timeline.volumes[0].extinction = extinction;
    timeline.volumes[0].masks.resize(1);
    timeline.volumes[0].masks[0].grid = "fire";
    const auto read = parse_timeline(format_timeline(timeline, ""), "t.toml").value_or_throw();
    EXPECT_EQ(read.volumes[0].extinction, extinction);
  }
}

TEST(TimelineWriter, ADisturbanceWithoutStrengthKeepsItsOtherSettings) {
  Timeline timeline;
  timeline.scene = "a.glb";
  timeline.volumes.resize(1);
  timeline.volumes[0].file = "a.vdb";
  timeline.volumes[0].disturbance.size = 0.5f;
  const auto read = parse_timeline(format_timeline(timeline, ""), "t.toml").value_or_throw();
  EXPECT_EQ(read.volumes[0].disturbance, timeline.volumes[0].disturbance);
}

TEST(TimelineWriter, EveryAngleRoundTripsBitForBit) {
  // Whole degrees and their neighbours, and floats all over the range.
  Timeline timeline;
  timeline.scene = "a.obj";
  Drawing draw(1);
  for (int degrees = -360; degrees <= 360; degrees += 5) {
    const auto radians = static_cast<float>(degrees * kRadiansOfDegree);
    for (const float roll : {radians, std::nextafter(radians, 0.0f), std::nextafter(0.5f * radians, 9.0f)}) {
      ShotEvent shot;
      shot.roll = roll;
      timeline.shots.push_back(shot);
    }
  }
  for (int i = 0; i < 20000; ++i) {
    ShotEvent shot;
    shot.roll = static_cast<float>((draw.share() - 0.5) * 12.56);
    timeline.shots.push_back(shot);
  }
  const auto read = parse_timeline(format_timeline(timeline, ""), "t.toml").value_or_throw();
  ASSERT_EQ(read.shots.size(), timeline.shots.size());
  for (std::size_t i = 0; i < timeline.shots.size(); ++i)
    ASSERT_EQ(read.shots[i].roll, timeline.shots[i].roll) << i;
}

TEST(TimelineWriter, WritesReadableText) {
  Timeline timeline;
  timeline.scene = "scenes/demo.glb";
  timeline.duration = 6;
  timeline.smoke.voxels = 24000;
  timeline.smoke.bloom = 2.8f;
  timeline.camera = {{0, {{-6, 1.45f, 11.4f}, {0, 1, 0}, static_cast<float>(50 * kRadiansOfDegree)}}};
  ShotEvent shot;
  shot.time = 3.3;
  shot.from_world = {0, 1, 0};
  shot.radius = 0.26f;
  shot.roll = static_cast<float>(12.5 * kRadiansOfDegree);
  timeline.shots = {shot};
  timeline.smokes = {{0.3, {1, 2, 3}, {-1000, 0.1f, 0}}};
  timeline.doors = {{3.3, "front \"door\"", true}};
  EXPECT_EQ(format_timeline(timeline, "scenes"), R"(version = 1
scene = "demo.glb"
duration = 6.0

[smoke]
voxels = 24000
bloom = 2.8

[[camera]]
time = 0.0
position = [-6.0, 1.45, 11.4]
target = [0.0, 1.0, 0.0]
fov = 50.0

[[event]]
type = "smoke"
time = 0.3
from = [1.0, 2.0, 3.0]
at = [-1000.0, 0.1, 0.0]

[[event]]
type = "door"
time = 3.3
object = "front \"door\""
open = true

[[event]]
type = "shot"
time = 3.3
from = [0.0, 1.0, 0.0]
toward = [0.0, 0.0, -1.0]
radius = 0.26
roll = 12.5
)");
}

class TimelineFile : public testing::Test {
 protected:
  TimelineFile() {
    fs::create_directories(folder / "out");
    fs::create_directories(folder / "one");
    fs::create_directories(folder / "two");
    put(folder / "one/star.png", "first");
    put(folder / "two/star.png", "second");
    put(folder / "out/near.png", "third");
  }
  static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string contents(const fs::path& path) { return read_text_file(path).value_or_throw(); }
  static ShotEvent masked(const fs::path& mask) {
    ShotEvent shot;
    shot.shape = ShotShape::mask;
    shot.mask = mask;
    return shot;
  }
  const cli::WorkFolder work_folder;
  const fs::path folder = fs::canonical(work_folder.path());
};

TEST_F(TimelineFile, CopiesItsImagesAndFonts) {
  Timeline timeline;
  timeline.scene = folder / "one/level.glb";
  timeline.shots = {masked(folder / "one/star.png"), masked(folder / "two/star.png"),
                    masked(folder / "one/star.png"), masked(folder / "out/near.png")};
  timeline.texts.resize(1);
  timeline.texts[0].text = "x";
  timeline.texts[0].font = folder / "two/star.png";
  timeline.camera = {{0, {{0, 0, 0}, {0, 0, 1}, 1}}};
  timeline.camera[0].camera.lens.opening = folder / "one/star.png";
  const fs::path file = folder / "out/take 1.toml";
  for (int times = 0; times < 2; ++times) {  // the second time overwrites
    ASSERT_TRUE(save_timeline(file, timeline));
    const Timeline read = load_timeline(file).value_or_throw();
    EXPECT_TRUE(read.scene.lexically_normal() == folder / "one/level.glb");
    ASSERT_EQ(read.shots.size(), 4u);
    EXPECT_EQ(read.shots[0].mask, folder / "out/take 1_files/star.png");
    EXPECT_EQ(contents(read.shots[0].mask), "first");
    EXPECT_EQ(contents(read.shots[1].mask), "second");
    EXPECT_EQ(read.shots[2].mask, read.shots[0].mask);
    EXPECT_EQ(read.shots[3].mask, folder / "out/near.png");
    EXPECT_EQ(read.texts[0].font, read.shots[1].mask);
    EXPECT_EQ(read.camera[0].camera.lens.opening, read.shots[0].mask);
    // A timeline that was read is written unchanged, to another folder too.
    ASSERT_TRUE(save_timeline(folder / "again.toml", read));
    const Timeline moved = load_timeline(folder / "again.toml").value_or_throw();
    EXPECT_EQ(moved.shots[0].mask, folder / "out/take 1_files/star.png");
    EXPECT_EQ(contents(folder / "again.toml").find("../"), std::string::npos);
  }
  int files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "out/take 1_files")) ++files;
  EXPECT_EQ(files, 2);

  // Existing files stay: another image of the same name is stored next to it.
  put(folder / "one/star.png", "other");
  ASSERT_TRUE(save_timeline(file, timeline));
  EXPECT_EQ(contents(folder / "out/take 1_files/star.png"), "first");
  EXPECT_EQ(contents(load_timeline(file).value_or_throw().shots[0].mask), "other");
}

TEST_F(TimelineFile, RejectsWhatTheReaderRejects) {
  Timeline timeline;
  timeline.scene = "level.glb";
  const fs::path file = folder / "out/t.toml";
  const auto refused = [&] {
    const auto saved = save_timeline(file, timeline);
    EXPECT_FALSE(fs::exists(file)) << "nothing half-written";
    EXPECT_FALSE(fs::exists(folder / "out/t_files"));
    return saved ? std::string() : saved.failure().message;
  };
  timeline.shots = {masked(folder / "one/no.png")};
  EXPECT_EQ(refused().find((folder / "one/no.png").string()), 0u);
  timeline.shots = {masked(folder / "one/star.png")};
  timeline.doors = {{1, "\xff", true}};  // invalid UTF-8
  EXPECT_EQ(refused().rfind("not saved: ", 0), 0u);
  EXPECT_EQ(refused().find(file.string()), std::string::npos) << "there is no such file";
  timeline.doors.clear();
  timeline.smoke.erosion = 2;
  EXPECT_NE(refused().find("\"erosion\": expected a number from 0 to 1, found 2"), std::string::npos);
  timeline.smoke.erosion = std::nanf("");
  EXPECT_NE(refused().find("\"erosion\""), std::string::npos);
  timeline.smoke.erosion = 0.5f;
  EXPECT_TRUE(save_timeline(file, timeline)) << "and is written without";
}

}  // namespace
}  // namespace brume::scene
