// Tanks in frames of a level of the renderer's own: between its surfaces and its smoke, as over those of a
// host. The tank is a ball of one known radiance, the level glows, so that all pixels are known.
#include <algorithm>
#include <cmath>
#include <set>

#include "planning/device_camera.hpp"
#include "scenario/lens.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/path_tracer/tank_fixture.hpp"
#include "tests/render/studio.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{48, 32};
constexpr float kVoxel = 0.05f, kRadius = 11 * kVoxel;
constexpr glm::vec3 kMiddle{0, 1, 0}, kBall{0.5f, 0.25f, 0.125f}, kWall{0.25f, 0.5f, 1};
constexpr double kSeconds = 2;
/// A half is rounded or truncated.
constexpr double kHalf = 1.0 / 1024;

using Pixels = std::vector<glm::vec4>;

/// Of the level: it glows evenly, or reflects the sky.
scene::Material wall_material(bool glows) {
  scene::Material material;
  material.base_color = glows ? glm::vec3(0) : kWall;
  material.emission = glows ? kWall : glm::vec3(0);
  return material;
}

/// What is in the level besides the tank.
struct Stage {
  std::optional<float> smoke_z = {}, pane_z = {};
  bool glows = true;
};

class TankFramesTest : public gpu::GpuTest {
 protected:
  TankFramesTest() {
    spheres::Tank tank = reference::tank_of(glm::uvec3(32), kVoxel);
    reference::put(tank, glm::vec3(16), kRadius / kVoxel, reference::kWhite);
    set_tank(std::move(tank), {});
  }

  /// Lit by an even sky alone: what is white has its radiance.
  void set_tank(spheres::Tank tank, std::optional<scene::TankGlass> glass) {
    auto content = std::make_shared<scene::TankContent>();
    content->bricks = spheres::list_bricks(tank);
    content->tank = std::move(tank);
    auto light = std::make_shared<scene::TankIllumination>();
    light->scene = reference::dark_scene();
    light->scene.sky.ambient = kBall;
    light->scene.bounces = 0;
    light->scene.glass = std::move(glass);
    content_ = std::move(content);
    light_ = std::move(light);
  }
  planning::TankInput tank(const glm::vec3& at = kMiddle, std::uint32_t samples = 4) const {
    planning::TankInput tank;
    tank.content = content_;
    tank.light = light_;
    tank.placement.position_world = at;
    tank.samples = samples;
    return tank;
  }

  static std::unique_ptr<Studio> studio(const Stage& stage = {}) {
    scene::Scene scene;
    add_box(scene.meshes.emplace_back(), {-8, -0.4f, -5}, {8, 0, 7});
    add_box(scene.meshes.emplace_back(), {-8, 0, -4.4f}, {8, 8, -4});
    add_box(scene.meshes.emplace_back(), glm::vec3(-0.01f), glm::vec3(0.01f));
    scene.materials = {wall_material(stage.glows), {}};
    scene.objects = {{"floor", 0, 0, glm::mat4(1)}, {"wall", 1, 0, glm::mat4(1)}};
    scene.grenade = {"grenade", 2, 0, glm::mat4(1), Role::ghost};
    if (stage.pane_z) {
      scene.materials[1].base_color = glm::vec3(0.5f);
      scene.materials[1].roughness = 0;
      scene::Mesh& pane = scene.meshes.emplace_back();
      for (const glm::vec2 at : {glm::vec2(-8, 0), glm::vec2(8, 0), glm::vec2(8, 8), glm::vec2(-8, 8)}) {
        scene::Vertex& vertex = pane.vertices.emplace_back();
        vertex.position = glm::vec3(at, *stage.pane_z);
        vertex.normal = {0, 0, 1};
      }
      pane.indices = {0, 1, 2, 0, 2, 3};
      scene.objects.push_back({"pane", 3, 1, glm::mat4(1), Role::glass});
    }
    scene.camera = scene::Camera{{0, 1, 6}, kMiddle, 0.4f};
    scene::Timeline timeline;
    timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0.3f), 0, 0};
    timeline.smoke.voxels = 400;
    timeline.smoke.extinction = 1;
    if (const auto z = stage.smoke_z) timeline.smokes = {{0.0, {0, 1, *z}, {0, 0.9f, *z}}};
    return make_studio(
        context(), runner(),
        scenario_of(std::move(scene), std::move(timeline), {{52, 20, 44}, 0.25f, {-6.5f, -0.6f, -4.6f}}),
        kSeconds, kSize);
  }
  static RendererOptions sized() { return RendererOptions{.size_px = kSize}; }

  static Pixels pixels_of(const gpu::Image& image) {
    Pixels pixels;
    for (const passes::Half4& texel : read_back<passes::Half4>(image))
      pixels.push_back(passes::from_half(texel));
    return pixels;
  }
  static Pixels drawn(Studio& studio) {
    studio.renderer->draw(studio.input);
    return pixels_of(studio.renderer->radiance());
  }

  /// Distance of the ball along the camera's axis in a pixel of a frame; infinity: its ray misses it by more
  /// than a hundredth of its radius; nothing: within that.
  static std::optional<double> distance_to_ball(const FrameInput& input, std::size_t i) {
    const shared::Camera camera = planning::device_camera(input.view.camera, kSize, input.view.sample);
    const glm::dvec2 ndc = (glm::dvec2(i % kSize.x, i / kSize.x) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
    const glm::dvec2 at = ndc + glm::dvec2(camera.shift) * glm::dvec2(1, -1);
    const glm::dvec3 along =
        glm::dvec3(camera.forward) + at.x * glm::dvec3(camera.right) - at.y * glm::dvec3(camera.up);
    const glm::dvec3 ray = glm::normalize(along), apart = glm::dvec3(kMiddle) - glm::dvec3(camera.eye_world);
    const double t = glm::dot(apart, ray), r = double{kRadius}, aside = glm::length(apart - t * ray);
    if (std::abs(aside / r - 1) < 0.01) return {};
    if (aside > r) return INFINITY;
    return (t - std::sqrt(r * r - aside * aside)) * glm::dot(ray, glm::dvec3(camera.forward));
  }
  /// Pixels all around which, two pixels wide, the ball is, or is not.
  static std::vector<std::size_t> where(const FrameInput& input, bool is_ball) {
    std::vector<std::size_t> found;
    const glm::ivec2 size(kSize);
    for (int i = 0; i < size.x * size.y; ++i) {
      bool all = true;
      for (int k = 0; k < 25; ++k) {
        const glm::ivec2 px = glm::ivec2(i % size.x, i / size.x) + glm::ivec2(k % 5, k / 5) - 2;
        if (px != glm::clamp(px, glm::ivec2(0), size - 1)) continue;
        const auto distance = distance_to_ball(input, static_cast<std::size_t>(px.y * size.x + px.x));
        all = all && distance && std::isfinite(*distance) == is_ball;
      }
      if (all) found.push_back(static_cast<std::size_t>(i));
    }
    EXPECT_GT(found.size(), 40u);
    return found;
  }
  static std::vector<std::size_t> inside(const FrameInput& input) { return where(input, true); }
  static void expect_color(const Pixels& pixels, const std::vector<std::size_t>& at, const glm::vec3& color,
                           const std::string& what) {
    for (const std::size_t i : at)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixels[i][c], color[c], 2 * kHalf * double{color[c]}) << what << ", pixel " << i;
  }
  static void expect_ball(const Pixels& pixels, const FrameInput& input, const std::string& what) {
    expect_color(pixels, inside(input), kBall, what);
  }
  /// Whether all pixels are between the ball and the wall: nothing is brighter or darker beside an edge.
  static void expect_no_halo(const Pixels& pixels, const std::string& what) {
    for (std::size_t i = 0; i < pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        EXPECT_LE(double{pixels[i][c]}, (1 + 4 * kHalf) * double{std::max(kBall[c], kWall[c])})
            << what << ", pixel " << i;
        EXPECT_GE(double{pixels[i][c]}, (1 - 4 * kHalf) * double{std::min(kBall[c], kWall[c])})
            << what << ", pixel " << i;
      }
  }

  std::shared_ptr<const scene::TankContent> content_;
  std::shared_ptr<const scene::TankIllumination> light_;
};

// Balls that are opaque or not, and glass: layers are the same to the bit, and the level is behind them.
TEST_F(TankFramesTest, AreTheLayersOverAHostsSurfacesInFrontOfTheLevel) {
  spheres::Tank tank = reference::tank_of({40, 30, 20}, kVoxel);
  reference::pack_at_random(tank, 200, {1.5f, 5}, 200, 90, 3);
  set_tank(std::move(tank), scene::TankGlass{{0, 0, 0.9f}, {0.4f, 0.3f, 0.2f}, 1.5f, {}});
  const auto one = studio({.smoke_z = 0.6f, .glows = false});
  const auto empty = studio({.glows = false});
  const Pixels level = drawn(*empty);
  for (const std::uint32_t scale : {1u, 2u}) {
    one->renderer->set_march_scale(scale);
    RendererOptions options = sized();
    options.media_alone = true;
    options.smoke.march_scale = scale;
    Renderer host(context(), runner(), one->scenario.scene, options);
    one->input.tanks = {this->tank()};
    const Pixels whole = drawn(*one);
    const gpu::Image& depth = one->renderer->targets().gbuffer.depth;
    const gpu::Image lent(
        {depth.handle(), depth.view(), depth.info().format, kSize, depth.last_use.get(context()).layout});
    host.reserve_over({.tanks = true});
    const FramePlan plan = host.plan(one->input);
    runner().run([&](gpu::Recorder& recorder) {
      host.record_over(recorder, plan, {.surfaces = {lent, {planning::kNearPlane, INFINITY, true}}});
    });
    const Pixels layers = pixels_of(host.layers());
    EXPECT_EQ(pixels_of(one->renderer->layers()), layers) << scale;
    for (std::size_t i = 0; i < whole.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        // The level and the sum are rounded.
        const double over = double{layers[i][c]} + double{layers[i].a * level[i][c]};
        EXPECT_NEAR(whole[i][c], over, 2 * kHalf * over + 1e-6) << scale << ", pixel " << i;
      }
    const auto through = [](const glm::vec4& pixel) { return pixel.a > 0.05f && pixel.a < 0.9f; };
    EXPECT_GT(std::ranges::count_if(layers, through), 50);
  }
}

TEST_F(TankFramesTest, ATankStopsSmokeThatIsBehindIt) {
  const auto one = studio({.smoke_z = -2.4f});
  one->input.tanks = {tank()};
  for (const std::uint32_t scale : {1u, 2u, 4u}) {
    one->renderer->set_march_scale(scale);
    const Pixels both = drawn(*one), media = pixels_of(one->renderer->media());
    expect_ball(both, one->input, "scale " + std::to_string(scale));
    int smoky = 0;
    for (const glm::vec4& pixel : media) smoky += pixel.a < 0.8f;
    EXPECT_GT(smoky, 30) << "beside it";
  }
}

TEST_F(TankFramesTest, SmokeInFrontOfATankHidesItAndSmokeAroundItInPart) {
  for (const float z : {3.2f, 0.0f}) {
    const auto one = studio({.smoke_z = z});
    drawn(*one);
    const Pixels smoke = pixels_of(one->renderer->media());
    one->input.tanks = {tank()};
    const Pixels both = drawn(*one), media = pixels_of(one->renderer->media());
    int hidden = 0;
    for (const std::size_t i : inside(one->input)) {
      // In front all of the smoke is met, in steps of the same places; around it the part up to the ball.
      if (z > 0)
        EXPECT_NEAR(media[i].a, smoke[i].a, 4 * kHalf) << i;
      else
        EXPECT_GE(media[i].a, smoke[i].a - 4 * float(kHalf)) << i;
      hidden += media[i].a < 0.9f;
      for (int c = 0; c < 3; ++c) {
        const double over = double{media[i][c]} + double{media[i].a * kBall[c]};
        EXPECT_NEAR(both[i][c], over, 3 * kHalf * over) << z << ", pixel " << i;
      }
    }
    EXPECT_GT(hidden, 30) << z;
  }
}

TEST_F(TankFramesTest, AWallHidesWhatIsBehindIt) {
  const auto one = studio({.smoke_z = 1.0f});
  const Pixels without = drawn(*one);
  one->input.tanks = {tank({0, 1, -6})};
  EXPECT_EQ(drawn(*one), without);
}

// A renderer that has shown tanks draws frames without them as one that never did, and records as much.
TEST_F(TankFramesTest, AFrameWithoutTanksCostsNothing) {
  const auto one = studio({.smoke_z = 1.0f});
  const auto commands = [&] {
    one->renderer->draw(one->input);
    std::vector<std::string> names;
    for (const auto& scope : runner().timings()) names.emplace_back(scope.name);
    return names;
  };
  const std::vector<std::string> expected = commands();
  const Pixels without = drawn(*one);
  one->input.tanks = {tank()};
  EXPECT_GT(commands().size(), expected.size());
  EXPECT_NE(drawn(*one), without);
  // Without any, and with one that is out of view.
  for (const auto& tanks : {std::vector<planning::TankInput>(), std::vector{tank({0, 1, 40})}}) {
    one->input.tanks = tanks;
    EXPECT_EQ(commands(), expected);
    EXPECT_EQ(drawn(*one), without);
  }
}

// Each sample of a picture shows the ball where its own ray through the pixel and the lens meets it.
TEST_F(TankFramesTest, TheViewOfDepthShowsItAndNoOtherView) {
  const auto drawn_view = [](Studio& studio, planning::DebugView view) {
    studio.input.debug.view = view;
    studio.renderer->draw(studio.input);
    return read_back<glm::u8vec4>(studio.renderer->targets().display);
  };
  const auto made = studio();
  const auto normals = drawn_view(*made, planning::DebugView::normals);
  made->input.tanks = {tank()};
  EXPECT_EQ(drawn_view(*made, planning::DebugView::normals), normals);
  const auto depth = drawn_view(*made, planning::DebugView::depth);
  for (const std::size_t i : inside(made->input)) {
    const auto metres = static_cast<float>(distance_to_ball(made->input, i).value());
    const glm::vec3 color =
        shared::ramp_colour(shared::ramp_of_view(shared::kViewDepth), shared::depth_fraction(metres));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(depth[i][c], 255 * color[c], 1) << "pixel " << i;
  }
}

TEST_F(TankFramesTest, EachSampleOfALensSeesItFromItsPlace) {
  const auto one = studio();
  one->input.view.camera.lens.aperture = 0.2f;
  one->input.view.camera.lens.focus = 9;
  one->input.tanks = {tank()};
  for (const scenario::CameraSample& sample :
       scenario::camera_samples(3, one->input.view.camera.lens, nullptr)) {
    one->input.view.sample = sample.view;
    one->renderer->draw(one->input);
    const std::vector<float> depth = read_back<float>(one->renderer->surfaces());
    const Pixels layers = pixels_of(one->renderer->layers());
    int hits = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const auto expected = distance_to_ball(one->input, i);
      if (!expected) continue;
      EXPECT_EQ(layers[i].a, std::isfinite(*expected) ? 0 : 1) << i;
      if (!std::isfinite(*expected)) continue;
      // Beside the rim, 0.01 of the radius, a ray is as long as that root says: 1e-5 of it are far less.
      EXPECT_NEAR(planning::kNearPlane / depth[i], *expected, 1e-3) << i;
      ++hits;
    }
    EXPECT_GT(hits, 100);
  }
}

TEST_F(TankFramesTest, TheMeanOfSeveralSamplesHasNoHalo) {
  const auto one = studio();
  one->input.tanks = {tank(kMiddle, 1)};
  const auto samples = scenario::camera_samples(8, {}, nullptr);
  for (const scenario::CameraSample& sample : samples) {
    one->input.view.sample = sample.view;
    one->renderer->draw(one->input);
  }
  const Pixels mean = pixels_of(one->renderer->radiance());
  one->input.view.sample = {};
  expect_ball(mean, one->input, "mean");
  expect_no_halo(mean, "mean");
}

// A film whose camera moves along the ball, with smoke behind it: two pixels from its edges there are no
// others.
TEST_F(TankFramesTest, FilmsHaveNoHaloAndNoLeak) {
  for (const bool smoky : {false, true})
    for (const std::uint32_t scale : {1u, 2u}) {
      const auto one = studio({.smoke_z = smoky ? std::optional(-2.4f) : std::nullopt});
      RendererOptions options = sized();
      options.antialias = true;
      options.smoke.temporal = true;
      options.smoke.march_scale = scale;
      one->renderer = std::make_unique<Renderer>(context(), runner(), one->scenario.scene, options);
      one->input.tanks = {tank(kMiddle, 1)};
      for (std::uint32_t frame = 0; frame < 10; ++frame) {
        one->input.view.camera.position_world.x = 0.02f * static_cast<float>(frame);
        one->input.view.frame_index = frame;
        one->input.view.continues = frame > 0;
        if (frame > 0) one->input.view.sample = planning::film_sample(frame);
        const Pixels film = drawn(*one);
        const std::string what = "frame " + std::to_string(frame) + ", scale " + std::to_string(scale);
        FrameInput middle = one->input;
        middle.view.sample = {};
        expect_ball(film, middle, what);
        if (!smoky) expect_color(film, where(middle, false), kWall, what);
      }
    }
}

// Samples are added while nothing moves, whatever the frame's point of the pixel: those of one frame.
TEST_F(TankFramesTest, SamplesAddUpWhileTheCameraStands) {
  const auto one = studio();
  one->input.tanks = {tank(kMiddle, 12)};
  one->renderer->draw(one->input);
  const Pixels at_once = pixels_of(one->renderer->layers());
  one->input.tanks = {tank(kMiddle, 4)};
  one->input.tanks[0].continues = true;
  one->input.view.camera.position_world.x = 0.5f;  // another picture
  one->renderer->draw(one->input);
  one->input.view.camera.position_world.x = 0;
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    one->input.view.sample = planning::film_sample(frame);
    one->renderer->draw(one->input);
    EXPECT_EQ(pixels_of(one->renderer->layers()) == at_once, frame == 2) << frame;
  }
  // A grenade that flies past begins it again.
  one->input.level.grenades.push_back(glm::mat4(1));
  one->renderer->draw(one->input);
  EXPECT_NE(pixels_of(one->renderer->layers()), at_once);
}

TEST_F(TankFramesTest, PanesInFrontOfATankTintItAndThoseBehindDoNot) {
  // Clear glass reflects 4 % of what falls straight on it; at these angles Schlick's approximation adds less
  // than 0.001 %.
  constexpr double kPasses = 0.96 * 0.5;
  const auto front = studio({.pane_z = 2}), behind = studio({.pane_z = -2});
  front->input.tanks = behind->input.tanks = {tank()};
  front->input.environment.sky = behind->input.environment.sky = {};  // which they reflect
  const Pixels tinted = drawn(*front);
  expect_ball(drawn(*behind), behind->input, "behind");
  for (const std::size_t i : inside(front->input))
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(tinted[i][c], kPasses * double{kBall[c]}, 4 * kHalf * double{kBall[c]}) << i;
}

TEST_F(TankFramesTest, ParticlesAreInFrontOfItOrBehind) {
  const auto one = studio();
  one->input.tanks = {tank()};
  grids::DenseGrid mask;
  mask.size = {4, 4, 4};
  mask.values.assign(64, 1);
  one->input.slices =
      std::make_shared<const grids::DenseVolumes>(1, std::make_shared<const grids::DenseVolume>(1, mask));
  for (const float z : {-2.0f, 2.0f}) {
    planning::ParticleInput cube;
    cube.world_from_uvw = glm::mat4(1);
    cube.world_from_uvw[3] = glm::vec4(glm::vec3(-0.5f, 0.5f, z), 1);
    cube.tints[0] = {4, 2, 1};
    one->input.particles = {cube};
    const Pixels pixels = drawn(*one);
    if (z < 0) expect_ball(pixels, one->input, "behind");
    const auto brighter = std::ranges::count_if(inside(one->input),
                                                [&](std::size_t i) { return pixels[i].r > 1.02f * kBall.r; });
    EXPECT_EQ(brighter > 20, z > 0) << z;
  }
}

}  // namespace
}  // namespace brume::render
