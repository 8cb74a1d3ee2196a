#include "film/playback.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "image/metrics.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

/// The room, a light, and a wall from there to the camera.
scene::Scene small_scene(bool with_screen) {
  return room_of({scene_light({-2, 2, 0}, glm::vec3(20))},
                 with_screen ? Boxes{{{-0.1f, -0.1f, -3}, {0.1f, 4, 3}}} : Boxes());
}

scenario::Scenario small_stage(scene::Scene scene) {
  scene::Timeline timeline;
  timeline.sky = plain_sky(0, 0.001f);
  timeline.smoke.voxels = 3000;
  timeline.smoke.extinction = 4;
  timeline.smoke.erosion = 0;
  timeline.smokes = {{0.2, {5.5f, 3.5f, 5.5f}, {0, 0.2f, 0}}};  // from outside of the image
  return scenario_of(std::move(scene), std::move(timeline), kRoomLayout);
}

class PlaybackTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{64, 36};
  /// Mean brightness of a block of pixels around a place in the image, 0..255.
  static double brightness(const image::Image8& image, double x, double y) {
    const auto px = static_cast<std::uint32_t>(x * image.width),
               py = static_cast<std::uint32_t>(y * image.height);
    double sum = 0;
    for (std::uint32_t j = 0; j < 3; ++j)
      for (std::uint32_t i = 0; i < 3; ++i) sum += image.rgba[4 * (px + i + image.width * (py + j)) + 1];
    return sum / 9;
  }
  /// The largest difference of two images, in steps of 255; that of one image at two times without smoke is
  /// the noise against bands, which follows time: a step.
  static double difference(const image::Image8& a, const image::Image8& b) {
    return std::round(255 * image::difference(image::encoded_colours(a), image::encoded_colours(b)).max);
  }
};

TEST_F(PlaybackTest, TheSameTimeGivesTheSameImage) {
  const scenario::Scenario scenario = small_stage(small_scene(true));
  film::Playback playback(context(), scenario, kSize);
  const auto first = playback.draw(0.8, 5).rgba;
  const auto early = playback.draw(0.1, 1).rgba;
  EXPECT_NE(first, early);
  EXPECT_EQ(playback.draw(0.8, 5).rgba, first);
  film::Playback other(context(), scenario, kSize);
  EXPECT_EQ(other.draw(0.8, 5).rgba, first);
}

TEST_F(PlaybackTest, AwkwardSizes) {
  const scenario::Scenario scenario = small_stage(small_scene(false));
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(7, 5), glm::uvec2(33, 17)}) {
    film::Playback playback(context(), scenario, size);
    const auto image = playback.draw(1.2, 0);
    EXPECT_EQ(image.rgba.size(), std::size_t{4} * size.x * size.y);
  }
}

/// What a screen shows of grey radiance below the highlights: Khronos PBR Neutral, then sRGB; 0..255.
double shown(double radiance) {
  const double toned = radiance < 0.08 ? 6.25 * radiance * radiance : radiance - 0.04;
  return 255 * (toned <= 0.0031308 ? 12.92 * toned : 1.055 * std::pow(toned, 1 / 2.4) - 0.055);
}

/// What is shown at least of a white wall at z = -3 that faces the light, in the middle of a pixel: what it
/// scatters of the light's light, without the shine of its surface; the ambient light of small_stage.
double least_shown(const scene::Scene& scene, glm::dvec2 pixel, glm::dvec2 size) {
  const glm::dvec3 eye(scene.camera->position_world), light(scene.lights[0].position_world);
  const double half = std::tan(double{scene.camera->vertical_fov} / 2);
  const glm::dvec2 at((2 * pixel.x / size.x - 1) * half * size.x / size.y, (1 - 2 * pixel.y / size.y) * half);
  const glm::dvec3 point = eye + glm::dvec3(at, -1) * (eye.z + 3);
  const glm::dvec3 to_light = glm::normalize(light - point), to_eye = glm::normalize(eye - point);
  const double d2 = glm::dot(light - point, light - point);
  // The window that ends a light where it is below 1/100.
  const double brightest = scene.lights[0].intensity.g, x = 0.01 * d2 / brightest;
  const double window = std::max(0.0, 1 - x * x);
  const double irradiance = brightest * window * window / d2 * to_light.z;
  const double fresnel = 0.04 + 0.96 * std::pow(1 - glm::dot(glm::normalize(to_light + to_eye), to_eye), 5);
  return shown(irradiance * (1 - fresnel) / glm::pi<double>() + 0.75 * 0.001);
}

TEST_F(PlaybackTest, AWallCastsAShadow) {
  const scenario::Scenario open = small_stage(small_scene(false)), screened = small_stage(small_scene(true));
  film::Playback without(context(), open, kSize), with(context(), screened, kSize);
  const auto a = without.draw(0, 0), b = with.draw(0, 0);
  // Right of the screen the light, which hangs left of it, does not reach the back wall: there is the ambient
  // light alone. A step of 255 for rounding and the noise against bands.
  double least = 0;
  const scene::Scene scene = small_scene(false);
  for (int i = 0; i < 9; ++i)
    least += least_shown(scene, glm::dvec2(48.5 + i % 3, 14.5 + i / 3), glm::dvec2(kSize)) / 9;
  EXPECT_GT(least, 10 * (shown(0.75 * 0.001) + 1)) << "the bounds tell light from shadow";
  EXPECT_GT(brightness(a, 0.75, 0.4), least - 1);
  EXPECT_LE(brightness(b, 0.75, 0.4), shown(0.75 * 0.001) + 1);
  EXPECT_NEAR(brightness(a, 0.2, 0.4), brightness(b, 0.2, 0.4), 3);
}

TEST_F(PlaybackTest, SmokeHidesTheWallAndAShotOpensIt) {
  scene::Scene scene = small_scene(false);
  scene.materials[0].emission =
      glm::vec3(0.3f);  // the wall shines by itself: smoke also takes the light's light
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smoke.albedo = glm::vec3(0);  // black smoke: what is bright is the wall
  scenario.timeline.shots = {{3, {0, 1.5f, 5.4f}, {0, 1.5f, 0}, 0.5f, {0.1f, 0.05f, 1.0f, 0.2f}}};
  film::Playback playback(context(), scenario, kSize);
  const double clear = brightness(playback.draw(0.1, 0), 0.5, 0.47);
  const double hidden = brightness(playback.draw(2.9, 0), 0.5, 0.47);
  const double open = brightness(playback.draw(3.6, 0), 0.5, 0.47);
  const double beside = brightness(playback.draw(3.6, 0), 0.3, 0.47);
  const double closed = brightness(playback.draw(5.0, 0), 0.5, 0.47);
  EXPECT_GT(clear, 60);
  EXPECT_LT(hidden, 5);
  EXPECT_GT(open, hidden + 20);
  EXPECT_LT(beside, 5);
  EXPECT_LT(closed, 5);
}

TEST_F(PlaybackTest, SmokeDimsTheSurfacesBehindIt) {
  // A puff on the floor, a low light left of it, and a place on the floor to its right.
  scene::Scene scene = small_scene(false);
  scene.lights[0].position_world = {-3, 1, 0};
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smoke.voxels = 150;
  scenario.timeline.smokes = {{0.2, {5.5f, 3.5f, 5.5f}, {-0.9f, 0, 0}}};
  film::Playback playback(context(), scenario, kSize);
  const auto before = playback.draw(0, 0), after = playback.draw(2.5, 0);
  EXPECT_GT(brightness(before, 0.585, 0.79), 30);
  EXPECT_LT(brightness(after, 0.585, 0.79), 0.5 * brightness(before, 0.585, 0.79));
  // The back wall is lit over the puff.
  EXPECT_NEAR(brightness(after, 0.2, 0.25), brightness(before, 0.2, 0.25), 3);
}

/// Where a camera sees the wall at z = -3 through a place of the image, in pixels.
glm::vec3 on_the_wall(const scene::Camera& camera, glm::vec2 pixel, glm::vec2 size) {
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  const glm::vec3 right = glm::normalize(glm::cross(forward, {0, 1, 0})), up = glm::cross(right, forward);
  const float half = std::tan(0.5f * camera.vertical_fov);
  const glm::vec2 at((2 * pixel.x / size.x - 1) * half * size.x / size.y, (1 - 2 * pixel.y / size.y) * half);
  const glm::vec3 ray = forward + at.x * right + at.y * up;
  return camera.position_world + ray * ((-3 - camera.position_world.z) / ray.z);
}

/// Least and most optical depth between the light and what the 3x3 pixels around a place of the image see
/// of the wall, and `around` metres beside it.
std::pair<float, float> depths_to_the_wall(const smoke::Sight& sight, const scenario::Scenario& scenario,
                                           const scene::Camera& camera, glm::vec2 place, glm::uvec2 size,
                                           float around) {
  const glm::vec2 first = glm::floor(place * glm::vec2(size));
  std::pair<float, float> depths{1e9f, 0.0f};
  for (int i = 0; i < 81; ++i) {
    const glm::vec3 on_wall =
        on_the_wall(camera, first + glm::vec2(i % 3, i / 3 % 3) + 0.5f, glm::vec2(size));
    const glm::vec3 beside = on_wall + around * glm::vec3(i / 9 % 3 - 1, i / 27 - 1, 0);
    const float depth = sight.optical_depth(scenario.scene.lights[0].position_world, beside).value_or_throw();
    depths = {std::min(depths.first, depth), std::max(depths.second, depth)};
  }
  return depths;
}

TEST_F(PlaybackTest, AHoleThrowsLightOnTheWallBehindTheSmoke) {
  // Black smoke between a light and the wall, and an eye beside it that sees the wall alone. A shot from the
  // light's place goes straight away from it.
  scene::Scene scene = small_scene(false);
  scene.lights[0].position_world = {0, 1, 4.5f};
  scene.lights[0].intensity = glm::vec3(60);
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smoke.albedo = glm::vec3(0);
  scenario.timeline.smoke.voxels = 700;
  scenario.timeline.smokes = {{0.2, {0, 1, 1.5f}, {0, 0.2f, 1.5f}}};
  scenario.timeline.shots = {{3, {0, 1, 4.6f}, {0, 1, 0}, 0.4f, {0.1f, 0.05f, 1.0f, 0.2f}}};
  scenario.timeline.shots[0].flash = 0;
  film::Playback playback(context(), scenario, kSize);
  const scene::Camera beside{{2, 1.2f, -0.7f}, {0, 1, -3}, 0.9f};
  playback.set_camera(beside);
  // The middle of the image looks at the wall where the shot hits it.
  const glm::vec2 spot(0.49f, 0.47f), around(0.85f, 0.47f);
  const auto brightness_at = [&](glm::vec2 place, double seconds) {
    return brightness(playback.draw(seconds, 0), static_cast<double>(place.x), static_cast<double>(place.y));
  };
  // What lies between the light and the wall, as a line of sight has it. The image mixes rays of the light
  // that are a texel apart. There are 2^16 of them or more, which grow by 1.2 until all fit, with half of
  // them in use at least, for what smoke is visible in: 9.5 m squared at its far end, 4.75 m from the light,
  // and 3.5 m squared on four more faces of the cube around it.
  const float texel = 1.2f * std::sqrt(2 * (9.5f * 9.5f + 4 * 3.5f * 3.5f) / 65536) * 7.5f / 4.75f;
  const auto depths = [&](glm::vec2 place) {
    const sim::World& world = playback.simulation().world();
    const auto holes = smoke::make_holes(world.state());
    const smoke::Sight sight(playback.simulation().volume(), world.grid(), holes,
                             world.state().seconds(world.tick()),
                             {.extinction = scenario.timeline.smoke.extinction});
    return depths_to_the_wall(sight, scenario, beside, place, kSize, texel);
  };
  const double clear = brightness_at(spot, 0), clear_around = brightness_at(around, 0), most_radiance = 0.4;
  EXPECT_GT(clear, 100);
  EXPECT_GT(clear_around, 100);
  EXPECT_LT(std::max(clear, clear_around), shown(most_radiance));
  // What the smoke leaves of the light, the ambient light, and a step for rounding and noise against bands.
  const auto expect_dark = [&](glm::vec2 place, double seconds) {
    const double value = brightness_at(place, seconds), left = std::exp(-double{depths(place).first});
    EXPECT_LT(left, 0.01);
    EXPECT_LE(value, shown(most_radiance * left + 0.75 * 0.001) + 1);
  };
  expect_dark(spot, 2.9);
  expect_dark(around, 2.9);
  // The hole takes all that lies between: the same light, up to the noise against bands.
  EXPECT_NEAR(brightness_at(spot, 3.6), clear, 1);
  EXPECT_EQ(depths(spot).second, 0);
  expect_dark(around, 3.6);
  expect_dark(spot, 5);
}

TEST_F(PlaybackTest, SmokeShadowsTheSunUnderIt) {
  // A sun from above, a puff that touches the wall, the floor before it and the floor beside.
  scene::Scene scene = small_scene(false);
  scene.lights[0].kind = scene::LightKind::directional;
  scene.lights[0].direction_world = {0, -1, 0};
  scene.lights[0].intensity = glm::vec3(1);
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smoke.albedo = glm::vec3(0);
  scenario.timeline.smoke.voxels = 700;
  scenario.timeline.smokes = {{0.2, {0, 3, 1.5f}, {0, 3, 1.5f}}};
  scenario.timeline.edits = {
      {0.0, {-1.3f, 2.4f, 0.2f}, {1.3f, 2.6f, 2.8f}, true}};  // a shelf for it, not drawn
  film::Playback playback(context(), scenario, kSize);
  // An eye on the floor that looks at the floor, first under the shelf, then beside.
  const auto floor_at = [&](glm::vec3 target_world, double seconds) {
    playback.set_camera(scene::Camera{target_world + glm::vec3(0, 0.8f, 0.5f), target_world, 0.9f});
    return brightness(playback.draw(seconds, 0), 0.49, 0.47);
  };
  const glm::vec3 under{0, -0.1f, 1.5f}, beside{-5.2f, -0.1f, 4.5f};
  const double clear = floor_at(under, 0);
  EXPECT_GT(clear, 100);
  EXPECT_LE(floor_at(under, 2.5), 2);
  EXPECT_NEAR(floor_at(beside, 2.5), floor_at(beside, 0), 3);
}

TEST_F(PlaybackTest, TheSunLightsAGroundBeyondTheScene) {
  scene::Scene scene = small_scene(false);
  scene.lights[0].kind = scene::LightKind::directional;
  scene.lights[0].direction_world = {0, -0.6f, 0.8f};
  scene.lights[0].intensity = glm::vec3(1);
  scene::Mesh ground;
  add_box(ground, {-90, -0.5f, -90}, {90, -0.4f, 90});
  scene.meshes.push_back(ground);
  scene.objects.push_back({"ground", 2, 0, glm::mat4(1)});
  scene.objects.back().backdrop = true;
  const scenario::Scenario scenario = small_stage(std::move(scene));
  film::Playback playback(context(), scenario, kSize);
  const auto ground_at = [&](float z) {
    const glm::vec3 target(0, -0.4f, z);
    playback.set_camera(scene::Camera{target + glm::vec3(0, 0.8f, 0.5f), target, 0.9f});
    return brightness(playback.draw(0, 0), 0.49, 0.47);
  };
  // The bounds are a sphere of radius 7.9 around z = 1.4, the wall's shadow ends before 3: at 12 the ground
  // is behind them as the sun sees it, at 60 beside them.
  EXPECT_GT(ground_at(60), 100);
  EXPECT_NEAR(ground_at(12), ground_at(60), 1);
}

TEST_F(PlaybackTest, TheSkyLightsAGroundBeyondTheGrid) {
  scene::Scene scene = small_scene(false);
  scene.lights.clear();
  scene::Mesh ground;
  add_box(ground, {-90, -0.5f, -90}, {90, -0.4f, 90});
  scene.meshes.push_back(ground);
  scene.objects.push_back({"ground", 2, 0, glm::mat4(1)});
  scene.objects.back().backdrop = true;
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.sky.ambient = glm::vec3(0.4f);
  film::Playback playback(context(), scenario, kSize);
  const glm::vec3 target(-40, -0.4f, 60);
  playback.set_camera(scene::Camera{target + glm::vec3(0, 0.8f, 0.5f), target, 0.9f});
  // Upwards 0.75 + 0.25 of the ambient light.
  EXPECT_NEAR(brightness(playback.draw(0, 0), 0.49, 0.47), shown(0.4), 1);
}

TEST_F(PlaybackTest, AFlashLightsWhatNoWallHides) {
  // Behind the screen it is dark, before it the muzzle shines.
  scene::Scene scene = small_scene(true);
  scene.lights.clear();
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smokes.clear();
  scenario.timeline.shots = {{1, {-2, 2, 0.3f}, {-2, 2, -1}}};
  film::Playback playback(context(), scenario, kSize);
  const auto before = playback.draw(0.95, 0), flash = playback.draw(1.01, 0), after = playback.draw(1.1, 0);
  EXPECT_LE(brightness(before, 0.2, 0.4), 2);
  EXPECT_GT(brightness(flash, 0.2, 0.4), 50);
  EXPECT_LE(brightness(flash, 0.75, 0.4), 2);
  EXPECT_LE(difference(after, playback.draw(1.5, 0)), 1);
}

TEST_F(PlaybackTest, TheGrenadeFlies) {
  scenario::Scenario scenario = small_stage(small_scene(false));
  scenario.timeline.smokes = {{0.5, {-2, 1.5f, 2}, {2, 1.5f, 2}}};
  film::Playback playback(context(), scenario, kSize);
  const auto before = playback.draw(0.4, 0), flying = playback.draw(0.6, 0);
  EXPECT_NE(before.rgba, flying.rgba);
}

/// A dark screen across the room, with a door in its middle that hides the bright wall behind; or with the
/// door taken out for good.
scenario::Scenario stage_with_door(bool with_door = true) {
  scene::Scene scene = small_scene(false);
  scene.materials[0].emission = glm::vec3(0.3f);
  scene.materials.push_back({});
  scene.materials[1].base_color = glm::vec3(0.01f);
  scene.meshes.resize(4);
  add_box(scene.meshes[2], {-6, -0.1f, 0.45f}, {-0.8f, 4, 0.65f});
  add_box(scene.meshes[2], {0.8f, -0.1f, 0.45f}, {6, 4, 0.65f});
  add_box(scene.meshes[3], {-0.8f, -0.1f, 0.5f}, {0.8f, 4, 0.6f});
  scene.objects.push_back({"screen", 2, 1, glm::mat4(1)});
  if (with_door) scene.objects.push_back({"door", 3, 1, glm::mat4(1)});
  scene.lights[0].position_world = {0, 2, 3};
  scenario::Scenario scenario = small_stage(std::move(scene));
  scenario.timeline.smokes.clear();
  if (with_door) scenario.timeline.doors = {{1.0, "door", true, ""}, {2.0, "door", false, ""}};
  return scenario;
}

TEST_F(PlaybackTest, AnOpenDoorShowsWhatIsBehindItAndLetsTheLightThrough) {
  const scenario::Scenario scenario = stage_with_door();
  scenario::Scenario lightless = stage_with_door();
  lightless.scene.lights.clear();
  film::Playback playback(context(), scenario, kSize), unlit(context(), lightless, kSize);
  const auto shut = playback.draw(0.5, 0), open = playback.draw(1.5, 0), again = playback.draw(2.5, 0);
  EXPECT_LT(brightness(shut, 0.5, 0.47), 30);
  EXPECT_GT(brightness(open, 0.5, 0.47), 60);
  EXPECT_LE(difference(again, shut), 1);
  EXPECT_EQ(playback.draw(1.5, 0).rgba, open.rgba);  // and backwards
  // The light is on this side: what it adds to the wall behind came through the door.
  EXPECT_GT(brightness(open, 0.5, 0.47), brightness(unlit.draw(1.5, 0), 0.5, 0.47) + 10);
  // A door that never was is one that is open.
  const scenario::Scenario without = stage_with_door(false);
  film::Playback never(context(), without, kSize);
  EXPECT_EQ(never.draw(1.5, 0).rgba, open.rgba);
}

TEST_F(PlaybackTest, SmokeStaysBehindADoorThatIsShutAndComesThroughWhenItOpens) {
  scenario::Scenario scenario = stage_with_door();
  scenario.timeline.smokes = {{0.0, {0, 3.5f, -1}, {0, 0, -1}}};  // behind the screen
  scenario.timeline.smoke.voxels = 3000;
  scenario.timeline.doors = {{1.5, "door", true, ""}};
  film::Playback playback(context(), scenario, kSize);
  const auto in_front = [&](double seconds) {
    (void)playback.draw(seconds, 0);
    const sim::State& state = playback.simulation().world().state();
    int sum = 0;
    for (int x = 20; x < 32; ++x) sum += state.density({x, 8, 18});  // z = 1.0 .. 1.25 m
    return sum;
  };
  EXPECT_EQ(in_front(1.48), 0);
  EXPECT_GT(in_front(4.0), 0);
  EXPECT_EQ(in_front(1.48), 0);
}

TEST_F(PlaybackTest, MoreHolesThanAreDrawnAreNoError) {
  scenario::Scenario scenario = small_stage(small_scene(false));
  for (int i = 0; i < 100; ++i) {
    scenario.timeline.shots.push_back(
        {2, {0, 1.5f, 5.4f}, {0.01f * static_cast<float>(i), 1.5f, 0}, 0.1f, {0.1f, 0.05f, 5.0f, 0.2f}});
  }
  film::Playback playback(context(), scenario, kSize);
  EXPECT_EQ(playback.draw(2.5, 0).width, kSize.x);
}

}  // namespace
}  // namespace brume::render
