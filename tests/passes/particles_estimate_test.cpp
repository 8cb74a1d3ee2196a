// What particles estimate: line integrals of the volume, with an error that falls with their number.
#include "tests/passes/particles_fixture.hpp"
#include "tests/sanitized.hpp"

namespace brume::passes {
namespace {

constexpr int kSeeds = 6;

class ParticleEstimateTest : public ParticlesFixture {
 protected:
  static MaskVolume full() {
    return {glm::uvec3(2), 1, [](glm::vec3) { return glm::vec4(1); }};
  }
  static glm::mat4 box(glm::vec3 low, glm::vec3 size) {
    return glm::translate(glm::mat4(1), low) * glm::scale(glm::mat4(1), size);
  }
  static glm::mat4 oblique(glm::vec3 centre, glm::vec3 size) {
    glm::mat4 shear(1);
    shear[1][0] = 0.4f;
    return glm::translate(glm::mat4(1), centre) *
           glm::rotate(glm::mat4(1), 0.9f, glm::normalize(glm::vec3(1, 0.4f, 0.2f))) * shear *
           glm::scale(glm::mat4(1), size) * glm::translate(glm::mat4(1), glm::vec3(-0.5f));
  }

  /// Mean radiance of a box in which the mask is 1 throughout, over all pixels, against tint times chord.
  ///
  /// A quad adds at most y to the mean of the image: its weight times the longest ray, times the part of the
  /// image that its footprint covers. That part is A over the area that the image has at the quad, where the
  /// box is nearest, or all of it; a sum over pixels differs from the integral by less than a fifth for
  /// footprints of more than three pixels. Of N independent quads whose contributions have the mean m / N,
  /// the variance is at most m y. The mean of kSeeds frames is allowed four standard deviations.
  void expect_mean(const glm::mat4& world_from_uvw, glm::vec3 eye, glm::vec3 target, float fov) {
    const MaskVolume volume = full();
    const glm::dvec3 tint(2, 1, 0.5);
    double mean = 0, chord = 0, most = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      Scene scene;
      scene.camera = camera_of(eye, target, fov, scene.size_px);
      ParticleInput input;
      input.world_from_uvw = world_from_uvw;
      input.tints[0] = glm::vec3(tint);
      input.count = 6400;
      input.seed = static_cast<std::uint32_t>(seed);
      input.time = 0.3 * seed;
      input.drift = 0.2f;
      add(scene, volume, input);
      const Drawn drawn = draw(scene);
      double nearest = 1e9, longest = 0;
      for (const shared::Particle& particle : drawn.particles)
        nearest = std::min(nearest, std::max(double{particle.view_m}, 0.0));
      const auto pixels = static_cast<double>(scene.pixels());
      for (std::size_t i = 0; i < scene.pixels(); ++i) {
        mean += double{drawn.pixels[i].x} / pixels / kSeeds;
        EXPECT_NEAR(drawn.pixels[i].y, 0.5 * double{drawn.pixels[i].x}, 1e-4);
        EXPECT_EQ(drawn.pixels[i].w, 1);
        chord += integrate(scene, i, {}, 1).metres / pixels / kSeeds;
        longest = std::max(longest, glm::length(scene.ray(i)));
      }
      const double area = std::numbers::pi * std::pow(double{scene.systems[0].radius}, 2) / 3;
      const double image = 4 * glm::length(glm::dvec3(scene.camera.right)) *
                           glm::length(glm::dvec3(scene.camera.up)) * nearest * nearest;
      most = double{scene.systems[0].weight} * longest * std::min(1.0, 1.2 * area / image);
    }
    const double expected = tint.x * chord;
    const double sigma = std::sqrt(expected * tint.x * most / kSeeds);
    EXPECT_GT(chord, 0.03);
    EXPECT_LT(4 * sigma, 0.25 * expected);
    EXPECT_NEAR(mean, expected, 4 * sigma);
    RecordProperty("relative_error", std::to_string(mean / expected - 1));
  }

  /// A thruster from the side.
  Scene thruster_scene(const MaskVolume& volume, std::uint32_t count, std::uint32_t seed,
                       float radius = 0.4f) {
    Scene scene;
    scene.camera = camera_of({2.6f, 1.4f, 2.2f}, {0, 0, 0}, 0.7f, scene.size_px);
    ParticleInput input;
    input.world_from_uvw = oblique({0, 0, 0}, {1, 1, 2});
    input.tints = {glm::vec3(1, 0, 0), glm::vec3(1, 0, 0)};
    input.count = count;
    input.seed = seed;
    input.radius = radius;
    add(scene, volume, input);
    return scene;
  }
  struct Rms {
    double error = 0, independent = 0, signal = 0;
  };
  /// Root mean squares over all pixels and `seeds` frames: the error, the standard deviation of independent
  /// centres, and the exact radiance.
  Rms rms(const MaskVolume& volume, std::uint32_t count, int seeds, float radius = 0.4f) {
    Rms sum;
    for (int seed = 0; seed < seeds; ++seed) {
      const Scene scene = thruster_scene(volume, count, static_cast<std::uint32_t>(seed), radius);
      const Drawn drawn = draw(scene);
      for (std::size_t i = 0; i < scene.pixels(); ++i) {
        const Line line = integrate(scene, i, {1, 1, 0, 0}, 300);
        const double exact = line.values.x + line.values.y;
        sum.error += std::pow(double{drawn.pixels[i].x} - exact, 2);
        sum.independent += std::pow(deviation(scene.systems[0], line.squares), 2);
        sum.signal += exact * exact;
      }
    }
    const double pixels = seeds * 48.0 * 40.0;
    return {std::sqrt(sum.error / pixels), std::sqrt(sum.independent / pixels),
            std::sqrt(sum.signal / pixels)};
  }
};

TEST_F(ParticleEstimateTest, TheMeanIsTintTimesChord) {
  expect_mean(box({-0.5f, -0.5f, -1}, {1, 1, 2}), {0.5f, 1, 5}, {0, 0, 0}, 0.6f);
  expect_mean(oblique({0, 0, 0}, {1, 0.6f, 2}), {3, 1, 2}, {0, 0, 0}, 0.8f);
}

// At the edge of a wide view rays are up to twice as long as along the axis.
TEST_F(ParticleEstimateTest, TheMeanIsRightOffTheAxisOfTheView) {
  expect_mean(box({2.5f, 2, -5}, {2.2f, 2.2f, 2.2f}), {0, 0, 0}, {0, 0, -5}, 1.9f);
}

TEST_F(ParticleEstimateTest, TheMeanIsRightFromInsideAndPartlyBehind) {
  expect_mean(box({-1, -1, -2}, {2, 2, 4}), {0.2f, 0.1f, 0.3f}, {0, 0, -5}, 1.0f);
  expect_mean(box({0.2f, -1, -3}, {2, 2, 5}), {0, 0, 0}, {0.6f, 0, -2}, 1.0f);
}

// Independent centres have the error `independent`, which falls as 1 / sqrt(N): by sqrt(128) from 50 to
// 6,400. Those of the lattice are better spread, which is what the bound without any slack checks; the fall
// is allowed half of what independent ones have, since single frames scatter.
TEST_F(ParticleEstimateTest, TheErrorFallsWithTheNumber) {
  const MaskVolume volume = thruster({24, 24, 24});
  std::vector<Rms> errors;
  for (const std::uint32_t count : {50u, 400u, 6400u}) {
    errors.push_back(rms(volume, count, count > 1000 || kSanitized ? 1 : 4));
    EXPECT_LT(errors.back().error, errors.back().independent) << count;
    RecordProperty("rms_" + std::to_string(count),
                   std::to_string(errors.back().error / errors.back().signal) + " of " +
                       std::to_string(errors.back().independent / errors.back().signal));
  }
  EXPECT_NEAR(errors[0].independent / errors[2].independent, std::sqrt(128), 1e-3);
  EXPECT_LT(errors[1].error, errors[0].error / (0.5 * std::sqrt(8)));
  EXPECT_LT(errors[2].error, errors[0].error / (0.5 * std::sqrt(128)));
}

// The region of the centres grows with the quads, and the weight with it.
TEST_F(ParticleEstimateTest, QuadsOfAnySizeEstimateTheSame) {
  const MaskVolume volume = thruster({24, 24, 24});
  for (const float radius : {0.1f, 0.25f, 0.8f, 2.0f}) {
    const Rms one = rms(volume, 6400, 1, radius);
    EXPECT_LT(one.error, one.independent) << radius;
    EXPECT_LT(one.independent, 0.3 * one.signal) << radius;
  }
}

// Transmittances exp(-a) and exp(-b) differ by less than a - b, whose deviation is that of independent
// centres. What is emitted is tint / extinction times the opacity.
TEST_F(ParticleEstimateTest, ExtinctionConvergesToBeerAndLambert) {
  const MaskVolume volume = full();
  Scene scene;
  scene.camera = camera_of({2, 1, 4}, {0, 0, 0}, 0.5f, scene.size_px);
  ParticleInput input;
  input.world_from_uvw = box({-0.5f, -0.5f, -1}, {1, 1, 2});
  input.tints[0] = glm::vec3(4, 2, 1);
  input.extinction = 1.5f;
  input.count = 6400;
  add(scene, volume, input);
  const Drawn drawn = draw(scene);
  double error = 0, bound = 0;
  for (std::size_t i = 0; i < scene.pixels(); ++i) {
    const double metres = integrate(scene, i, {}, 1).metres;
    const double opacity = 1 - std::exp(-1.5 * metres);
    error += std::pow(double{1 - drawn.pixels[i].w} - opacity, 2);
    bound += std::pow(1.5 * deviation(scene.systems[0], metres), 2);
    EXPECT_NEAR(drawn.pixels[i].x, 4 / 1.5 * double{1 - drawn.pixels[i].w}, 1e-3);
  }
  EXPECT_LT(error, bound);
  EXPECT_LT(std::sqrt(bound / static_cast<double>(scene.pixels())), 0.2);
}

// The world with its camera turned: the same quads, but for rounding. A sample may be off by what a step of
// the filter makes, and by the rounding of places; a thousandth of the radiance is more than both, for 26
// quads on a pixel whose slabs have the length of the box together.
TEST_F(ParticleEstimateTest, ATurnedWorldLooksTheSame) {
  const MaskVolume volume = thruster({24, 24, 24});
  const Scene scene = thruster_scene(volume, 400, 3);
  Scene turned = scene;
  const glm::mat4 turn =
      glm::rotate(glm::translate(glm::mat4(1), {3, -2, 1}), 2.2f, glm::normalize(glm::vec3(1, -2, 0.5f)));
  const glm::mat3 rotation(turn);
  shared::Camera& camera = turned.camera;
  camera.clip_from_world = scene.camera.clip_from_world * glm::inverse(turn);
  camera.eye_world = glm::vec3(turn * glm::vec4(scene.camera.eye_world, 1));
  camera.forward = rotation * scene.camera.forward;
  camera.right = rotation * scene.camera.right;
  camera.up = rotation * scene.camera.up;
  ParticleInput input;
  input.world_from_uvw = turn * oblique({0, 0, 0}, {1, 1, 2});
  input.tints = {glm::vec3(1, 0, 0), glm::vec3(1, 0, 0)};
  input.seed = 3;
  turned.systems[0] = planning::particle_system(input, {});
  const Drawn expected = draw(scene), drawn = draw(turned);
  const double step = std::ldexp(1.0, -static_cast<int>(context().limits().subTexelPrecisionBits));
  for (std::size_t i = 0; i < scene.pixels(); ++i) {
    const double metres = compose(scene, expected, i).metres;
    ASSERT_NEAR(drawn.pixels[i].x, expected.pixels[i].x, metres * (4 * step + 1e-3)) << i;
  }
}

}  // namespace
}  // namespace brume::passes
