// Tanks in an even light, and fog: pictures that are closed forms.
#include <array>
#include <cmath>

#include "tests/render/tank_fixture.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{16, 16};
/// Of sums of a few products of floats.
constexpr double kRounding = 1e-5;

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

using TankFurnaceTest = TankPicturesTest;

TEST_F(TankFurnaceTest, ASphereInAnEvenSkyHasItsAlbedoTimesTheAmbientLight) {
  spheres::Tank tank = tank_of({40, 40, 40});
  put(tank, {20, 20, 20}, 15, 0xff60a0d0);
  scene::TankScene scene = dark_scene();
  // Rays of the camera do not see the sky: nothing of it is in the picture.
  scene.sky.zenith = scene.sky.horizon = glm::vec3(100);
  scene.sky.ambient = glm::vec3(0.7f);
  const glm::dvec3 albedo = reference::TankModel(tank, scene).albedo(0);
  // All of the picture is sphere: a cone of 0.1 around the middle, at a distance of 1 m.
  const scene::Camera camera{{0.5f, 0.4f, 0.7f}, {0, 0, 0}, 0.1f};
  TankPicture picture(context(), runner(), tank);
  for (const std::uint32_t bounces : {0u, 1u, 2u, 16u}) {
    SCOPED_TRACE(bounces);
    scene.bounces = bounces;
    for (const glm::dvec3& pixel : draw(picture, scene, tank, camera, kSize, 16))
      expect_near(pixel, 0.7 * albedo, kRounding);
  }
  // Nine bits of each channel of a voxel's light.
  for (const scene::TankLighting lighting : {scene::TankLighting::maps, scene::TankLighting::exact}) {
    scene.view = scene::TankView::voxels;
    scene.lighting = lighting;
    for (const glm::dvec3& pixel : draw(picture, scene, tank, camera, kSize, 16))
      expect_near(pixel, 0.7 * albedo, 0x1p-9);
  }
}

TEST_F(TankFurnaceTest, WhiteSpheresVanishWithManyBounces) {
  // Nothing absorbs, and light of radiance 1 comes from everywhere. What a picture lacks are paths that meet
  // something after their last bounce.
  scene::TankScene scene = dark_scene();
  scene.sky.zenith = scene.sky.horizon = scene.sky.ambient = glm::vec3(1);
  const scene::Camera camera{{0.2f, 0.4f, 0.6f}, {0, 0, 0}, 0.6f};

  // Of two opaque ones with the radius r and the distance d of a surface to the other's middle, at most the
  // fraction (r / d)^2 of what leaves one meets the other: 1 / 4, and after 16 bounces 2e-10 of all. In a
  // medium with the optical depth 0.8 along its diameter, at most 1 - exp(-0.8) of what is scattered is
  // scattered again: 8e-5 of all after 16.
  spheres::Tank pair = tank_of({60, 40, 40});
  put(pair, {18, 20, 20}, 8, kWhite);
  put(pair, {42, 20, 20}, 8, kWhite);
  spheres::Tank cloud = tank_of({60, 40, 40});
  put(cloud, {30, 20, 20}, 10, grey(255, 10));
  const double depth = -2 * 10 * std::log1p(-10 / 255.0);
  struct Row {
    const spheres::Tank& tank;
    double most_again;  // of what is scattered, what is scattered again
  };
  for (const Row& row : {Row{pair, 0.25}, Row{cloud, 1 - std::exp(-depth)}}) {
    TankPicture picture(context(), runner(), row.tank);
    std::vector<double> lacking;
    for (const std::uint32_t bounces : {1u, 2u, 4u, 16u}) {
      scene.bounces = bounces;
      double sum = 0;
      for (const glm::dvec3& pixel : draw(picture, scene, row.tank, camera, kSize, 64)) {
        EXPECT_LE(pixel.g, 1 + kRounding);
        sum += 1 - pixel.g;
      }
      lacking.push_back(sum / (kSize.x * kSize.y));
      // Of 16,384 paths.
      const double most = std::pow(row.most_again, bounces);
      EXPECT_LE(lacking.back(), most + 4 * std::sqrt(most / 16384) + kRounding) << bounces;
    }
    // One bounce does not do.
    EXPECT_GT(lacking[0], 0.002);
    EXPECT_LT(lacking[1], lacking[0]);
    EXPECT_LT(lacking[2], lacking[1]);
    EXPECT_LE(lacking[3], 1e-4 + kRounding);
  }
}

TEST_F(TankFurnaceTest, AnotherSphereTakesItsPartOfTheSky) {
  // Of the light that arrives by Lambert's law at the point next to a sphere of radius r whose middle is at
  // the distance d, (r / d)^2 is what that sphere hides (e.g. Modest 2013, "Radiative Heat Transfer").
  spheres::Tank tank = tank_of({60, 40, 40});
  put(tank, {18, 20, 20}, 8, kWhite);
  put(tank, {42, 20, 20}, 8, kWhite);
  scene::TankScene scene = dark_scene();
  scene.sky.ambient = glm::vec3(1);
  // From between the two at that point of the first: the ray is on the second's axis.
  TankPicture picture(context(), runner(), tank);
  const scene::Camera camera = narrow_camera({0, 0, 0}, {-0.04, 0, 0});
  constexpr std::uint32_t kSamples = 256;
  double seen = 0;
  for (const glm::dvec3& pixel : draw(picture, scene, tank, camera, kSize, kSamples))
    seen += pixel.g / (kSize.x * kSize.y);
  const double hidden = 8.0 * 8 / (16 * 16);
  // Of as many independent rays, four deviations, 3 % of the hidden part.
  EXPECT_NEAR(1 - seen, hidden, 4 * std::sqrt(hidden * (1 - hidden) / (kSamples * kSize.x * kSize.y)));
}

// Fog along a ray, in metres and double.
struct FoggyRay {
  glm::dvec3 from, to;
  /// Length in a box around the origin, up to `end`.
  double length(const glm::dvec3& size, double end = 1e9) const {
    const glm::dvec3 direction = glm::normalize(to - from);
    double enter = 0, leave = end;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) {
        if (std::abs(from[axis]) > size[axis] / 2) return 0;
        continue;
      }
      const double a = (-size[axis] / 2 - from[axis]) / direction[axis];
      const double b = (size[axis] / 2 - from[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return std::max(0.0, leave - enter);
  }
};

class TankFogTest : public TankPicturesTest {
 protected:
  static constexpr double kExtinction = 2;
  static constexpr glm::vec3 kColor{0.1f, 0.2f, 0.3f};

  static scene::TankScene foggy() {
    scene::TankScene scene = dark_scene();
    scene.sky.zenith = scene.sky.horizon = glm::vec3(0.8f, 0.5f, 0.05f);
    scene.fog = {static_cast<float>(kExtinction), kColor};
    return scene;
  }
  static glm::dvec3 seen_through(const glm::dvec3& radiance, double length) {
    const double clear = std::exp(-kExtinction * length);
    return radiance * clear + glm::dvec3(kColor) * (1 - clear);
  }
};

/// Small spheres, one in each brick, in the same voxel of all: none where it is beyond the brick.
constexpr std::uint32_t kNoDots = 8;
spheres::Tank dotted_tank(const glm::uvec3& size, std::uint32_t phase) {
  spheres::Tank tank = tank_of(size);
  if (phase == kNoDots) return tank;
  for (std::uint32_t z = phase; z < size.z; z += 8)
    for (std::uint32_t y = phase; y < size.y; y += 8)
      for (std::uint32_t x = phase; x < size.x; x += 8) put(tank, glm::vec3(x, y, z) + 0.5f, 0.4f, kWhite);
  return tank;
}

/// Whether a ray passes at least 0.2 voxels from the voxels of all dots.
bool misses_dots(const FoggyRay& ray, const glm::uvec3& size, std::uint32_t phase) {
  const glm::dvec3 direction = glm::normalize(ray.to - ray.from);
  for (double t = 0; t < 4; t += 0.001) {
    const glm::dvec3 at =
        (ray.from + t * direction) * 100.0 + 0.5 * glm::dvec3(size) - static_cast<double>(phase);
    if (glm::all(glm::lessThan(glm::abs(at - 8.0 * glm::floor(at / 8.0 + 0.5) - 0.5), glm::dvec3(0.8))))
      return phase == kNoDots;
  }
  return true;
}

TEST_F(TankFogTest, DependsOnTheLengthOfTheRayAlone) {
  // From outside along an axis and at an angle, from inside, and past the tank.
  const std::vector<FoggyRay> rays{
      {{0.005, 0.016, 3}, {0.005, 0.016, 0}},    {{-2, 0.0171, 0.0323}, {0, 0.0171, 0.0323}},
      {{0.9, 0.7, 1.1}, {0.031, 0.012, -0.053}}, {{-0.8, 0.9, -0.7}, {0.012, -0.043, 0.021}},
      {{0.013, 0.011, 0.021}, {-0.3, 0.5, 0.9}}, {{1, 0.5, 0}, {1, 0.5, -1}}};
  scene::TankScene scene = foggy();
  const glm::dvec3 sky(scene.sky.zenith);
  double longest = 0;
  int compared = 0;
  for (const std::uint32_t phase : {0u, 1u, 4u, 6u, 7u, kNoDots}) {
    SCOPED_TRACE(phase);
    // Sizes that are multiples of a brick's, and others.
    const glm::uvec3 size(48 + phase % 5, 56 + phase % 3, 64 + phase % 7);
    const spheres::Tank tank = dotted_tank(size, phase);
    TankPicture picture(context(), runner(), tank);
    for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
      scene.view = view;
      for (const FoggyRay& ray : rays) {
        if (!misses_dots(ray, size, phase)) continue;
        const double length = ray.length(glm::dvec3(size) * 0.01);
        for (const glm::dvec3& pixel : draw(picture, scene, tank, narrow_camera(ray.from, ray.to), kSize, 2))
          expect_near(pixel, seen_through(sky, length), kRounding);
        longest = std::max(longest, length);
        ++compared;
      }
    }
  }
  EXPECT_GT(longest, 0.6);
  EXPECT_GE(compared, 36);  // of 72
}

TEST_F(TankFogTest, EndsWhereASphereBegins) {
  scene::TankScene scene = foggy();
  scene.sky.ambient = glm::vec3(0.7f);
  scene.bounces = 0;
  constexpr glm::uvec3 kTank(40, 40, 80);
  for (std::uint32_t phase = 0; phase < 8; ++phase) {
    spheres::Tank tank = tank_of(kTank);
    put(tank, {20, 20, 20 + phase}, 10, kWhite);
    const glm::dvec3 middle(0, 0, 0.01 * phase - 0.2);
    TankPicture picture(context(), runner(), tank);
    for (const glm::dvec3& from : {glm::dvec3(0, 0, 2), glm::dvec3(0.3, 0.2, 1.5)}) {
      const FoggyRay ray{from, middle};
      const glm::dvec3 expected = seen_through(
          glm::dvec3(0.7), ray.length(glm::dvec3(kTank) * 0.01, glm::distance(from, middle) - 0.1));
      for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
        scene.view = view;
        // Of voxels, the face is at most the diagonal of one off; light has nine bits.
        const double off = view == scene::TankView::voxels
                               ? 0.7 * (kExtinction * std::sqrt(3.0) * 0.01 + 0x1p-9)
                               : kRounding;
        for (const glm::dvec3& pixel : draw(picture, scene, tank, narrow_camera(from, middle), kSize, 2))
          expect_near(pixel, expected, off);
      }
    }
  }
}

TEST_F(TankFogTest, GoesOnInAMediumThatDimsIt) {
  // A black ball of medium on the way: of extinction a, in fog of extinction k. What the fog adds up to its
  // far side is color k / (k + a) (1 - exp(-(k + a) chord)); a ray that is scattered sees only the fog before
  // that.
  constexpr glm::uvec3 kTank(32, 32, 64);
  spheres::Tank tank = tank_of(kTank);
  put(tank, {16.5f, 16.5f, 30.5f}, 14, 4u << 24);
  const double a = -std::log1p(-4 / 255.0) / 0.01, k = kExtinction, chord = 0.28;
  scene::TankScene scene = foggy();
  const glm::dvec3 color(kColor), sky(scene.sky.zenith);
  // From 0.195 m before the ball to 0.165 m behind it.
  const glm::dvec3 behind = std::exp(-(k + a) * chord) * seen_through(sky, 0.165);
  const glm::dvec3 expected =
      seen_through(color * (k / (k + a) * (1 - std::exp(-(k + a) * chord))) + behind, 0.195);
  TankPicture picture(context(), runner(), tank);
  const scene::Camera camera = narrow_camera({0.005, 0.005, 2}, {0.005, 0.005, 0});
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    scene.view = view;
    glm::dvec3 mean(0);
    for (const glm::dvec3& pixel : draw(picture, scene, tank, camera, kSize, 64))
      mean += pixel / static_cast<double>(kSize.x * kSize.y);
    // Spheres: events at random, of which none changes the radiance by more than 0.8. Voxels: at both ends of
    // the ball one may be painted that is not in it, and a voxel does not dim the fog that is in itself.
    const double off = view == scene::TankView::spheres ? 4 * 0.8 / 2 / std::sqrt(64.0 * kSize.x * kSize.y)
                                                        : 2 * a * 0.01 * 0.8 + a * 0.01 * 0.3;
    expect_near(mean, expected, off);
  }
}

TEST_F(TankFogTest, IsNotInTheGlass) {
  // Of an index that bends and reflects nothing: from 0.1 m behind the tank's middle on.
  scene::TankScene scene = foggy();
  scene.glass = scene::TankGlass{{0, 0, 0.2f}, glm::vec3(0.3f), 1.0f};
  const spheres::Tank tank = tank_of({40, 40, 80});
  TankPicture picture(context(), runner(), tank);
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    scene.view = view;
    for (const glm::dvec3& pixel : draw(picture, scene, tank, narrow_camera({0, 0, 3}, {0, 0, 0}), kSize, 2))
      expect_near(pixel, seen_through(glm::dvec3(scene.sky.zenith), 0.3), kRounding);
  }
}

}  // namespace
}  // namespace brume::render
