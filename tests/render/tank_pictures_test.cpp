// Pictures of tanks against the reference, which traces their paths in double (docs/how/path-tracer.md).
#include <array>

#include "core/tasks.hpp"
#include "film/tank_playback.hpp"
#include "reference/tank_tracer.hpp"
#include "tests/render/tank_fixture.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kTruthSize{48, 32};
constexpr std::uint32_t kBatches = reference::kFewer > 1 ? 8 : 48;
constexpr std::uint32_t kSamplesOfBatch = film::TankPhotons::kSamplesOfBatch;
constexpr std::uint32_t kPixels = kTruthSize.x * kTruthSize.y;
constexpr std::uint32_t kPhotonsOfBatch = 100000;

enum class Matter { opaque, media, mixed };

/// A tank, and a camera that shows all of it.
struct Example {
  scenario::TankScenario scenario;
  scene::Camera camera;
};

spheres::Tank six_spheres(Matter matter) {
  spheres::Tank tank = tank_of({60, 60, 40});
  const std::array<glm::vec4, 6> balls{{{15, 15, 14, 13},
                                        {44, 16, 20, 14},
                                        {16, 45, 22, 13},
                                        {45, 45, 15, 13},
                                        {30, 30, 30, 7},
                                        {30, 30, 8, 7}}};
  const std::array<spheres::Color, 6> colors{0xf0e0d0, 0x40c0ff, 0xd0ff60, 0xb070e0, 0xffffff, 0x60f0f0};
  for (std::size_t i = 0; i < 6; ++i) {
    const bool is_medium = matter == Matter::media || (matter == Matter::mixed && i % 2 == 1);
    // Optical depths of 1.3 along a diameter, and of 4 in the small ones.
    const std::uint32_t opacity = !is_medium ? 255 : i < 4 ? 12 : 60;
    put(tank, glm::vec3(balls[i]), balls[i].w, colors[i] | opacity << 24);
  }
  return tank;
}

Example example(Matter matter, std::uint32_t bounces) {
  Example made{{{}, six_spheres(matter)}, {{0.5f, 0.4f, 0.9f}, {0, 0, 0}, 0.55f}};
  scene::TankScene& scene = made.scenario.scene;
  scene.bounces = bounces;
  // Most of the light is that of the lights.
  scene.sky.zenith = {0.02f, 0.03f, 0.05f};
  scene.sky.horizon = {0.04f, 0.03f, 0.02f};
  scene.sky.ambient = {0.06f, 0.05f, 0.04f};
  scene.fog = {0.5f, {0.03f, 0.02f, 0.01f}};
  if (matter != Matter::mixed) {
    scene.lights = {{{0.6f, 0.8f, 0.9f}, {1, 0.8f, 0.6f}, 3, 0},
                    {{-0.5f, 0.3f, 0.7f}, {0.4f, 0.7f, 1}, 2, 0.2f}};
    return made;
  }
  // Large lights, which the reference finds through the glass.
  scene.glass = scene::TankGlass{{0, 0, 0.6f}, {0.3f, 0.25f, 0.2f}, 1.5f};
  scene.lights = {{{0.1f, 0.2f, 1.8f}, glm::vec3(1), 6, 0.5f}, {{-0.8f, 0.3f, 1.4f}, {0.2f, 1, 1}, 4, 0.45f}};
  scene.photons = kPhotonsOfBatch;
  made.camera.position_world = {0.8f, 0.5f, 0.7f};
  made.camera.lens = {.aperture = 0.03f, .focus = 0.9f};
  return made;
}

/// Means over a picture: its red, its green and its blue, and the green of its quarters.
using Numbers = std::array<double, 7>;
struct Means {
  std::array<Mean, 7> of;
  void add(const Numbers& numbers) {
    for (std::size_t i = 0; i < of.size(); ++i) of[i].add(numbers[i]);
  }
};

/// Adds what is seen at a place of the picture, in [0, 1]^2, one of `count`.
void add_seen(Numbers& numbers, const glm::dvec2& place, const glm::dvec3& seen, double count) {
  for (std::size_t c = 0; c < 3; ++c) numbers[c] += seen[static_cast<int>(c)] / count;
  numbers[3 + (place.x > 0.5 ? 1u : 0u) + (place.y > 0.5 ? 2u : 0u)] += 4 * seen.y / count;
}

spheres::LightPaths light_paths(const spheres::Tank& tank, const spheres::LightPathScene& scene,
                                std::uint32_t seed) {
  spheres::LightPathOptions options;
  options.count = kPhotonsOfBatch;
  options.seed = seed;
  return spheres::trace_light_paths(tank, spheres::list_bricks(tank), scene, options);
}

/// The reference's ray through a place of the picture and a point of the round lens, in the unit disk.
reference::Ray ray_of(const scene::Camera& camera, const glm::dvec2& place, const glm::dvec2& on_lens) {
  const glm::dvec3 eye(camera.position_world);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target_world) - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, {0, 1, 0})), up = glm::cross(right, forward);
  const double high = std::tan(0.5 * double{camera.vertical_fov}), wide = high * kTruthSize.x / kTruthSize.y;
  const glm::dvec3 along = forward + (2 * place.x - 1) * wide * right + (1 - 2 * place.y) * high * up;
  const glm::dvec3 apart = double{camera.lens.aperture} * (on_lens.x * right + on_lens.y * up);
  const double sharp = camera.lens.focus > 0 ? double{camera.lens.focus} : 1;
  return {glm::vec3(eye + apart), glm::vec3(glm::normalize(sharp * along - apart))};
}

/// How the reference finds light through the glass: rays rarely do.
enum class Through { rays, light_paths, nothing };

Means means_of_reference(const Example& shown, Through through = Through::nothing) {
  const auto& [scene, tank] = shown.scenario;
  const reference::TankModel model(tank, scene);
  const std::uint32_t parts_of_batch = through == Through::rays ? 64 : 8, paths = parts_of_batch * kPixels;
  Means means;
  for (std::uint32_t batch = 0; batch < kBatches; ++batch) {
    spheres::LightPaths found;
    // Others than those of the device.
    if (through == Through::light_paths)
      found = light_paths(tank, reference::light_path_scene(model), 1000 + batch);
    std::vector<Numbers> parts(parts_of_batch, Numbers{});
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        for (std::uint32_t i = 0; i < kPixels; ++i) {
          const std::uint32_t path = batch * paths + static_cast<std::uint32_t>(part) * kPixels + i;
          const glm::dvec2 pixel(path % kTruthSize.x, path % kPixels / kTruthSize.x);
          const glm::dvec2 place = (pixel + glm::dvec2(shared::hash3({path, 1, 2}))) / glm::dvec2(kTruthSize);
          const glm::dvec2 on_lens(shared::hash3({path, 3, 4}));
          const double out = std::sqrt(on_lens.x), turn = 2 * kPi * on_lens.y;
          const reference::Ray ray =
              ray_of(shown.camera, place, {out * std::cos(turn), out * std::sin(turn)});
          reference::Sampler sampler = reference::path_sampler(path);
          const auto seen = trace_tank_path(model, ray, sampler, through == Through::rays ? nullptr : &found);
          add_seen(parts[part], place, glm::dvec3(reference::all_of(seen)), paths);
        }
    });
    Numbers all{};
    for (const Numbers& part : parts)
      for (std::size_t i = 0; i < all.size(); ++i) all[i] += part[i];
    means.add(all);
  }
  return means;
}

/// What is left of sums of floats.
constexpr double kFloats = 1e-4;
/// Photons are blurred over the radius in which they are gathered: the shadows of other spheres.
constexpr double kBlur = 0.01;

class TankTruthTest : public TankPicturesTest {
 protected:
  static Means means_of_device(TankPicture& picture, const Example& shown) {
    const auto& [scene, tank] = shown.scenario;
    const planning::TankPlan plan = planning::plan_tank(scene, tank, 0, kTruthSize, shown.camera);
    picture.show(plan, planning::plan_tank_display(scene, kTruthSize));
    Means means;
    std::vector<glm::vec4> before(kPixels, glm::vec4(0));
    for (std::uint32_t batch = 0; batch < kBatches; ++batch) {
      if (scene.photons > 0)
        picture.replace_photons(light_paths(tank, planning::light_path_scene(plan), batch));
      add_samples(picture, kSamplesOfBatch);
      const std::vector<glm::vec4> after = sums(picture);
      Numbers numbers{};
      for (std::uint32_t y = 0; y < kTruthSize.y; ++y)
        for (std::uint32_t x = 0; x < kTruthSize.x; ++x) {
          const std::size_t i = std::size_t{y} * kTruthSize.x + x;
          add_seen(numbers, (glm::dvec2(x, y) + 0.5) / glm::dvec2(kTruthSize),
                   (glm::dvec3(after[i]) - glm::dvec3(before[i])) / double{kSamplesOfBatch}, kPixels);
        }
      means.add(numbers);
      before = after;
    }
    return means;
  }
  /// `allowed`: what they may differ by besides their errors, relative.
  static void expect_same(const Means& device, const Means& truth, double allowed = kFloats) {
    for (std::size_t i = 0; i < truth.of.size(); ++i) {
      // The batches are independent. Four standard errors of the difference; five of the quarters, which are
      // many.
      const double deviation = std::hypot(device.of[i].error(), truth.of[i].error());
      const double expected = truth.of[i].value();
      EXPECT_NEAR(device.of[i].value(), expected, (i < 3 ? 4 : 5) * deviation + allowed * expected)
          << "number " << i;
      // What is known is known to 2 %; of a quarter of the picture, to 4 %.
      EXPECT_LT(4 * deviation, (i < 3 ? 0.02 : 0.04) * expected * kLooser) << "number " << i;
    }
  }
};

TEST_F(TankTruthTest, OpaqueSpheresAreThoseOfTheReference) {
  for (const std::uint32_t bounces : {0u, 2u}) {
    SCOPED_TRACE(bounces);
    const Example shown = example(Matter::opaque, bounces);
    TankPicture picture(context(), runner(), shown.scenario.tank);
    expect_same(means_of_device(picture, shown), means_of_reference(shown));
  }
}

TEST_F(TankTruthTest, MediaAreThoseOfTheReference) {
  for (const std::uint32_t bounces : {0u, 2u}) {
    SCOPED_TRACE(bounces);
    const Example shown = example(Matter::media, bounces);
    TankPicture picture(context(), runner(), shown.scenario.tank);
    expect_same(means_of_device(picture, shown), means_of_reference(shown));
  }
}

TEST_F(TankTruthTest, LightThroughTheGlassIsThatOfTheReference) {
  for (const std::uint32_t bounces : {0u, 2u}) {
    SCOPED_TRACE(bounces);
    const Example shown = example(Matter::mixed, bounces);
    TankPicture picture(context(), runner(), shown.scenario.tank);
    const Means device = means_of_device(picture, shown),
                gathered = means_of_reference(shown, Through::light_paths);
    expect_same(device, gathered);
    // A third of the light or more.
    EXPECT_LT(means_of_reference(shown).of[1].value(), gathered.of[1].value() * 2 / 3);
    // Without any light paths; only a scattered ray meets a light.
    if (bounces > 0) expect_same(device, means_of_reference(shown, Through::rays), kBlur);
  }
}

TEST_F(TankTruthTest, PortionsOfSamplesAddUpToTheSameBits) {
  // A picture takes as many samples at once as its device manages in time.
  Example shown = example(Matter::media, 2);
  auto& [scene, tank] = shown.scenario;
  TankPicture whole(context(), runner(), tank), parts(context(), runner(), tank);
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    scene.view = view;
    for (TankPicture* picture : {&whole, &parts}) begin(*picture, scene, tank, shown.camera, kTruthSize);
    add_samples(whole, 13);
    for (const std::uint32_t count : {1u, 2u, 7u, 3u}) add_samples(parts, count);
    EXPECT_EQ(sums(whole), sums(parts));
  }
}

TEST_F(TankTruthTest, PicturesTakeNewLightPathsEverySixteenSamples) {
  Example shown = example(Matter::mixed, 2);
  shown.scenario.scene.samples = 3 * kSamplesOfBatch - 5;
  const auto& [scene, tank] = shown.scenario;
  film::TankPlayback playback(context(), shown.scenario, kTruthSize);
  playback.set_camera(shown.camera);
  const image::LayeredImage image = playback.draw_layers(0);

  TankPicture picture(context(), runner(), tank);
  const planning::TankPlan plan = planning::plan_tank(scene, tank, 0, kTruthSize, shown.camera);
  picture.show(plan, planning::plan_tank_display(scene, kTruthSize));
  for (std::uint32_t batch = 0; batch < 3; ++batch) {
    picture.replace_photons(light_paths(tank, planning::light_path_scene(plan), batch));
    add_samples(picture, batch < 2 ? kSamplesOfBatch : kSamplesOfBatch - 5);
  }
  const std::vector<glm::vec4> expected = sums(picture);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& values = std::get<std::vector<float>>(image.layers[c].values);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(values[i], expected[i][static_cast<int>(c)] / static_cast<float>(scene.samples));
  }
}

TEST_F(TankTruthTest, FramesOfAFilmAreThoseOfNewPictures) {
  // What moves: a light, the glass, or the camera alone, whose frames have the same light paths.
  for (const int moves : {0, 1, 2})
    for (const std::uint32_t samples : {kSamplesOfBatch - 6, kSamplesOfBatch + 4}) {
      SCOPED_TRACE(testing::Message() << moves << ", " << samples << " samples");
      Example shown = example(Matter::mixed, 1);
      scene::TankScene& scene = shown.scenario.scene;
      scene.samples = samples;
      scene.photons = 20000;
      scene.camera = {{0, shown.camera}};
      if (moves == 0) scene.lights[1].keys = {{0, {-0.8f, 0.3f, 1.4f}}, {2, {-0.8f, 0.5f, 1.4f}}};
      if (moves == 1)
        scene.glass->keys = {{0, {0, 0, 0.6f}, glm::vec3(0.2f)}, {2, {0, 0, 0.7f}, glm::vec3(0.3f)}};
      if (moves == 2) scene.camera.push_back({2, {{0.7f, 0.5f, 0.8f}, {0, 0, 0}, 0.6f}});
      film::TankPlayback film(context(), shown.scenario, {24, 16});
      std::vector<image::LayeredImage> frames;
      for (const double seconds : {0.0, 1.0, 0.0, 2.0}) {
        frames.push_back(film.draw_layers(seconds));
        const image::LayeredImage alone =
            film::TankPlayback(context(), shown.scenario, {24, 16}).draw_layers(seconds);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_TRUE(frames.back().layers[c].values == alone.layers[c].values) << seconds << " s";
      }
      EXPECT_FALSE(frames[1].layers[1].values == frames[0].layers[1].values);
      EXPECT_FALSE(frames[3].layers[1].values == frames[0].layers[1].values);
    }
}

}  // namespace
}  // namespace brume::render
