#include "scene/files/tank_writer.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/file.hpp"
#include "scene/files/tank_reader.hpp"
#include "scene/tank_options.hpp"
#include "tests/scene/bits.hpp"
#include "tests/scene/random_timeline.hpp"
#include "tests/work_folder.hpp"

namespace brume::scene {
namespace {

constexpr std::array kPalettes{"", "viridis", "viridis:0.2-0.6", "viridis:1-0"};

/// A random scene that the reader accepts.
TankScene random_scene(std::uint32_t seed) {
  Drawing draw(seed);
  TankScene scene;
  visit_film_options(scene, draw);
  visit_tone_options(scene, draw);
  visit_tank_picture_options(scene, draw);
  scene.view = TankView{draw.below(2)};
  scene.lighting = TankLighting{draw.below(2)};
  scene.lens_points = LensPoints{draw.below(2)};
  if (draw.below(3) == 0) {
    scene.file = "scenes/a tank.spheres";
  } else {
    visit_pack_options(scene.pack, draw);
    scene.pack.arrangement = spheres::Arrangement{draw.below(kArrangements)};
    scene.pack.coloring = spheres::Coloring{draw.below(kColorings)};
    if (draw.below(2) == 0) scene.pack.seed = draw.below(UINT32_MAX);
    if (draw.below(2) == 0)
      scene.pack.size = {100 + draw.below(500), 100 + draw.below(500), 64 + draw.below(300)};
    if (draw.below(2) == 0) scene.pack.radius = {draw.real(0.01, 2), draw.real(2, 32)};
    scene.palette = kPalettes[draw.below(kPalettes.size())];
    if (draw.below(2) == 0) scene.palette_space = "nearest";
  }
  visit_sky_options(scene.sky, draw);
  visit_fog_options(scene.fog, draw);
  for (std::uint32_t i = draw.below(4); i > 0; --i) {
    TankLight light;
    visit_tank_light_options(light, draw);
    for (std::uint32_t key = draw.below(3); key > 0; --key)
      light.keys.push_back({light.keys.empty() ? 0.1 : light.keys.back().time + draw.share() + 0.01,
                            draw.point(-kFarthestPoint, kFarthestPoint)});
    scene.lights.push_back(light);
  }
  if (draw.below(2) == 0) {
    scene.glass.emplace();
    visit_glass_options(*scene.glass, draw);
    for (std::uint32_t key = draw.below(3); key > 0; --key)
      scene.glass->keys.push_back(
          {scene.glass->keys.empty() ? 0.0 : scene.glass->keys.back().time + draw.share() + 0.01,
           draw.point(-kFarthestPoint, kFarthestPoint), draw.point(1e-4, 1e4)});
  }
  for (std::uint32_t i = draw.below(3); i > 0; --i) {
    CameraKey key;
    key.time = scene.camera.empty() ? draw.share() : scene.camera.back().time + draw.share() + 0.01;
    key.camera.position_world = draw.point(-10, 10);
    key.camera.target_world = key.camera.position_world + glm::vec3(0, 0, -1 - static_cast<float>(i));
    visit_camera_options(key.camera, draw);
    scene.camera.push_back(key);
  }
  return scene;
}

std::vector<std::uint64_t> bits_of(const TankScene& scene) {
  Bits b;
  visit_film_options(scene, b);
  visit_tone_options(scene, b);
  visit_tank_picture_options(scene, b);
  b.add(static_cast<std::uint32_t>(scene.view));
  b.add(static_cast<std::uint32_t>(scene.lighting)), b.add(static_cast<std::uint32_t>(scene.lens_points)),
      b.add(scene.file.string());
  visit_pack_options(scene.pack, b);
  b.add(static_cast<std::uint32_t>(scene.pack.arrangement)), b.add(std::size_t{scene.pack.seed});
  b.add(static_cast<std::uint32_t>(scene.pack.coloring));
  b.add(glm::vec3(scene.pack.size)), b.add(scene.pack.radius.x), b.add(scene.pack.radius.y);
  b.add(scene.palette), b.add(scene.palette_space);
  visit_sky_options(scene.sky, b);
  visit_fog_options(scene.fog, b);
  b.add(scene.lights.size());
  for (const TankLight& light : scene.lights) {
    visit_tank_light_options(light, b);
    b.add(light.keys.size());
    for (const PlaceKey& key : light.keys) b.add(key.time), b.add(key.position_world);
  }
  b.add(std::size_t{scene.glass.has_value()});
  if (scene.glass) {
    visit_glass_options(*scene.glass, b);
    b.add(scene.glass->keys.size());
    for (const GlassKey& key : scene.glass->keys)
      b.add(key.time), b.add(key.position_world), b.add(key.radii);
  }
  add_camera(b, scene.camera);
  return b.bits;
}

TEST(TankWriter, RandomScenesRoundTripBitForBit) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    const TankScene scene = random_scene(seed);
    const std::string text = format_tank_scene(scene, "scenes");
    const auto read = parse_tank_scene(text, "scenes/t.toml").value_or_throw();
    ASSERT_EQ(bits_of(read), bits_of(scene)) << "seed " << seed << "\n" << text;
    ASSERT_EQ(format_tank_scene(read, "scenes"), text);
  }
}

TEST(TankWriter, TheSceneOfTheProgramRoundTrips) {
  const std::filesystem::path file = BRUME_SOURCE_DIR "/scenes/aquaria.toml";
  const TankScene scene = load_tank_scene(file).value_or_throw();
  const std::string text = format_tank_scene(scene, file.parent_path());
  EXPECT_EQ(bits_of(parse_tank_scene(text, file).value_or_throw()), bits_of(scene)) << text;
}

TEST(TankWriter, DefaultsAreOmitted) {
  EXPECT_EQ(format_tank_scene(TankScene(), ""), "version = 1\n\n[tank]\n");
}

TEST(TankWriter, ATankAndAPaletteFromElsewhereAreCopied) {
  const cli::WorkFolder folder;
  std::filesystem::create_directories(folder.path() / "from");
  std::filesystem::create_directories(folder.path() / "to");
  folder.write("from/a.spheres", "a tank");
  folder.write("from/p.gpl", "GIMP Palette\n0 0 0\n255 255 255\n");
  TankScene scene;
  scene.file = folder.path() / "from/a.spheres";
  ASSERT_TRUE(save_tank_scene(folder.path() / "to/t.toml", scene));
  const TankScene read = load_tank_scene(folder.path() / "to/t.toml").value_or_throw();
  EXPECT_EQ(read.file, folder.path() / "to/t_files/a.spheres");
  EXPECT_EQ(read_text_file(read.file).value_or_throw(), "a tank");

  scene.file.clear();
  scene.palette = (folder.path() / "from/p.gpl").string() + ":0.5-1";
  ASSERT_TRUE(save_tank_scene(folder.path() / "to/u.toml", scene));
  EXPECT_EQ(load_tank_scene(folder.path() / "to/u.toml").value_or_throw().palette,
            (folder.path() / "to/u_files/p.gpl").string() + ":0.5-1");
}

TEST(TankWriter, NeverWritesWhatCannotBeReadBack) {
  const cli::WorkFolder folder;
  TankScene scene;
  scene.pack.radius = {3, 2};
  const auto saved = save_tank_scene(folder.path() / "t.toml", scene);
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.failure().message.find("radius"), std::string::npos) << saved.failure().message;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "t.toml"));
}

// What the window shows: there is no file whose line it could name.
TEST(TankWriter, NamesTheSettingThatCannotBeSaved) {
  const cli::WorkFolder folder;
  TankScene scene;
  scene.palette = "nosuch" + std::string(300, 'x');
  const auto saved = save_tank_scene(folder.path() / "t.toml", scene);
  ASSERT_FALSE(saved);
  const std::string& message = saved.failure().message;
  EXPECT_EQ(message.rfind("not saved: \"palette\": palette \"nosuchx", 0), 0u) << message;
  EXPECT_EQ(message.find("t.toml"), std::string::npos) << message;
  EXPECT_LT(message.size(), 160u) << message;
}

}  // namespace
}  // namespace brume::scene
