// Indirect light where it is known: in rooms whose light is the same everywhere.
#include <cmath>
#include <memory>

#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/rooms.hpp"
#include "tests/render/studio.hpp"
#include "tests/worlds.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kRoomSize{48, 32};
constexpr float kEmission = 0.5f, kAlbedo = 0.6f;
constexpr std::uint32_t kBounces = 8;

/// What 8 bounces leave of the light that is to be found, at most: 1 / T8(15/13), T8 the Chebyshev
/// polynomial, where the eigenvalues of a bounce are from -0.4 to 0.9.
const float kLeft = 1 / std::cosh(8 * std::acosh(1.5f / 1.3f));

/// Where light is the same everywhere: the march leaves off at a transmittance of 0.004; each bounce rounds
/// to half floats, to within 2^-11 of radiance and of irradiance, and of an error a room of these walls keeps
/// less than nine tenths per bounce, so that ten times as much remains.
constexpr float kFurnaceError = 0.004f + 10 * 2 * 0.5f / 2048;

/// A room that is closed on all sides.
scene::Scene closed_room(float emission, float albedo, float wall = 0.3f) {
  Boxes walls;
  constexpr float kHalf = 2;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 low(-kHalf - wall), high(kHalf + wall);
      (side < 0 ? high : low)[axis] = side * kHalf;
      walls.push_back({low, high});
    }
  scene::Scene scene = scene_of(walls, {}, 0.02f);
  scene.materials[0].base_color = glm::vec3(albedo);
  scene.materials[0].emission = glm::vec3(emission);
  scene.camera = scene::Camera{{1.6f, 0.9f, 1.5f}, {-1.4f, -0.3f, -1}, 1.2f};
  return scene;
}

class IndirectLightTest : public gpu::GpuTest {
 protected:
  static std::unique_ptr<Studio> studio(scene::Scene scene, bool smoke, std::uint32_t bounces = kBounces,
                                        float sky = 0) {
    scene::Timeline timeline;
    timeline.bounces = bounces;
    timeline.sky = plain_sky(0, sky);
    timeline.smoke.voxels = 900;
    timeline.smoke.extinction = 1.5f;
    timeline.smoke.albedo = glm::vec3(1);
    if (smoke) timeline.smokes = {{0.0, {0, -1, 0}, {0, -1.6f, 0}}};
    return make_studio(
        context(), runner(),
        scenario_of(std::move(scene), std::move(timeline), {glm::ivec3(22), 0.25f, glm::vec3(-2.7f)}), 2,
        kRoomSize);
  }

  static std::vector<glm::vec4> radiance(Studio& studio) {
    studio.renderer->draw(studio.input);
    return passes::from_half(read_back<passes::Half4>(studio.renderer->targets().radiance));
  }
};

// In a closed room of walls that glow and reflect alike, light is e / (1 - albedo) everywhere.
TEST_F(IndirectLightTest, AClosedRoomIsAsBrightAsItsWallsMakeIt) {
  const auto room = studio(closed_room(kEmission, kAlbedo), false);
  const float expected = kEmission / (1 - kAlbedo);
  // What the bounces leave, and four roundings to half floats.
  const float bound = expected * (kLeft + 4.0f / 2048);
  for (const glm::vec4& pixel : radiance(*room)) EXPECT_NEAR(pixel.g, expected, bound);
}

TEST_F(IndirectLightTest, WithoutBouncesOnlyTheWallsOwnLightShows) {
  const auto room = studio(closed_room(kEmission, kAlbedo), false, 0);
  for (const glm::vec4& pixel : radiance(*room)) EXPECT_NEAR(pixel.g, kEmission, kEmission / 1024);
}

// Walls of one voxel, whose cells have light on both sides.
TEST_F(IndirectLightTest, TheSkyDoesNotShowInTheCornersOfAClosedRoom) {
  const auto room = studio(closed_room(0, kAlbedo, 0.1f), false, kBounces, 1);
  for (const glm::vec4& pixel : radiance(*room)) EXPECT_LT(pixel.g, 0.01f);
}

// Smoke that only scatters is invisible in light that is the same everywhere (the furnace test).
TEST_F(IndirectLightTest, SmokeIsInvisibleInAnEvenlyLitRoom) {
  // As many bounces as leave nothing even where nearly all light is passed on.
  const auto smoky = studio(closed_room(kEmission, kAlbedo), true, 64);
  const std::vector<glm::vec4> pixels = radiance(*smoky);
  // There is smoke in the picture.
  float least = 1;
  for (const passes::Half4& texel : read_back<passes::Half4>(smoky->renderer->media()))
    least = std::min(least, passes::from_half(texel).a);
  EXPECT_LT(least, 0.3f);
  const float expected = kEmission / (1 - kAlbedo);
  for (const glm::vec4& pixel : pixels) EXPECT_NEAR(pixel.g, expected, kFurnaceError * expected);
}

// Light that is found over several frames ends where light at once is, bit for bit.
TEST_F(IndirectLightTest, SlicedLightArrivesWhereLightAtOnceIs) {
  scene::Scene scene = closed_room(0, kAlbedo);
  scene::Light& light = scene.lights.emplace_back();
  light.position_world = {0.3f, 1, -0.4f};
  light.intensity = {3, 2, 1};
  const auto sliced = studio(scene, true), whole = studio(scene, true);
  const std::vector<glm::vec4> before = radiance(*sliced);
  const shared::Light flash = point_light({-1, 0.5f, 1}, glm::vec3(4));
  for (Studio* const each : {sliced.get(), whole.get()}) each->input.environment.flashes = {flash};
  const std::vector<glm::vec4> after = radiance(*whole);
  EXPECT_NE(before, after);
  // Of the smoke's light a sixteenth is the least, of the indirect light an eighth.
  sliced->input.quality.light_update_fraction = 0.0625f;
  sliced->input.quality.indirect_update_fraction = 0.125f;
  EXPECT_NE(radiance(*sliced), after) << "it shows when it is complete";
  std::vector<glm::vec4> pixels;
  for (int frame = 0; frame < 2 * 16 + 1; ++frame) pixels = radiance(*sliced);
  EXPECT_EQ(pixels, after);
}

}  // namespace
}  // namespace brume::render
