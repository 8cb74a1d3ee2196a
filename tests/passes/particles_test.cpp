// Volumes by particles: places and order of the quads, what they compose to, surfaces, counts.
#include <bit>
#include <random>
#include <set>

#include "tests/passes/particles_fixture.hpp"

namespace brume::passes {
namespace {

constexpr double kSingle = 1.0 / (1 << 24);

/// A box that is turned, sheared, mirrored and longer than wide.
glm::mat4 oblique_box(glm::vec3 centre, glm::vec3 size) {
  glm::mat4 shear(1);
  shear[1][0] = 0.3f;
  shear[2][1] = -0.2f;
  return glm::translate(glm::mat4(1), centre) *
         glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(0.3f, 1, 0.2f))) * shear *
         glm::scale(glm::mat4(1), size * glm::vec3(-1, 1, 1)) *
         glm::translate(glm::mat4(1), glm::vec3(-0.5f));
}

class ParticlesTest : public ParticlesFixture {
 protected:
  ParticlesTest() { scene_.camera = camera_of({0.3f, 0.4f, 5}, {0, 0, 0}, 0.7f, scene_.size_px); }

  ParticleInput input(std::uint32_t count) const {
    ParticleInput input;
    input.world_from_uvw = oblique_box({0, 0, 0}, {1.2f, 1, 2});
    input.tints = {glm::vec3(3, 0.5f, 0.25f), glm::vec3(0.2f, 0.6f, 4)};
    input.count = count;
    input.seed = 7;
    input.time = 1.7;
    input.drift = 0.4f;
    return input;
  }

  /// Each pixel against the same quads on the processor. A sample of the volume is off by the weights of the
  /// filter, two steps of subTexelPrecisionBits, and by rounding of its place: 30 roundings of at most 10 m,
  /// relative to voxels of at least 0.02 m, between which values change by up to 1. The footprint changes by
  /// less along these 30 roundings, since its radius is 20 such voxels.
  ///
  /// The slabs on a pixel are `metres` long together. An error of a sample changes what they emit by at most
  /// the brightest sum of tints, and their optical depth by the largest extinction: with it what is behind,
  /// which is at most the background of 1 or what a slab without end emits. A blend of floats rounds by 2^-24
  /// of that; there are at most 4,096.
  void expect_composed(const Scene& scene, const Drawn& drawn) const {
    constexpr double kBrightest = 4.25;
    double least = 1e9, largest = 0;
    for (const ParticleSystem& system : scene.systems) {
      if (system.extinction > 0) least = std::min(least, double{system.extinction});
      largest = std::max(largest, double{system.extinction});
    }
    const double step = std::ldexp(1.0, -static_cast<int>(context().limits().subTexelPrecisionBits));
    const double sample = 2 * step + 300 * kSingle / 0.02;
    const double behind = std::max(1.0, kBrightest / least);
    for (std::size_t i = 0; i < scene.pixels(); ++i) {
      const Composed expected = compose(scene, drawn, i);
      const double bound = expected.metres * sample * (kBrightest + largest * behind) +
                           4096 * kSingle * (behind + kBrightest * expected.metres);
      for (int channel = 0; channel < 4; ++channel)
        ASSERT_NEAR(drawn.layer[i][channel], expected.value[channel], bound)
            << "pixel " << i << ", channel " << channel;
    }
  }

  Scene scene_;
  const MaskVolume thruster_ = thruster({14, 12, 17});
};

// The device's sines are off by up to 2^-11 ("Precision of Core SPIR-V Instructions" in the Vulkan
// specification); a coordinate near the end of the region may wrap to its begin.
TEST_F(ParticlesTest, AreWhereTheFormulaPutsThem) {
  const ParticleInput all = input(6400);
  add(scene_, thruster_, all);
  const ParticleSystem& system = scene_.systems[0];
  const Drawn drawn = draw(scene_);
  std::array<int, 8> octants{};
  for (std::uint32_t i = 0; i < all.count; ++i) {
    const glm::vec3 uvw = shared::particle_uvw(system, i);
    ASSERT_TRUE(glm::all(glm::greaterThanEqual(uvw, -system.margin - 1e-5f)));
    ASSERT_TRUE(glm::all(glm::lessThanEqual(uvw, 1.0f + system.margin + 1e-5f)));
    const glm::vec3 on_device =
        matrix_of(system.uvw_from_world) * glm::vec4(drawn.particles[i].centre_world, 1);
    const glm::vec3 region = 1.0f + 2.0f * system.margin;
    const glm::vec3 apart = glm::abs(uvw - on_device) / region;
    const glm::vec3 wrapped = glm::min(apart, 1.0f - apart);
    const glm::vec3 bound = glm::vec3(system.swirl / 2048.0f, 0.0f) + 1e-5f;
    ASSERT_TRUE(glm::all(glm::lessThanEqual(wrapped, bound))) << i;
    const glm::bvec3 upper = glm::greaterThan(uvw, glm::vec3(0.5f));
    ++octants[upper.x + 2u * upper.y + 4u * upper.z];
    const float view =
        glm::dot(drawn.particles[i].centre_world - scene_.camera.eye_world, scene_.camera.forward);
    ASSERT_NEAR(drawn.particles[i].view_m, view, 1e-5f);
  }
  // Independent centres would be within five standard deviations, sqrt(6400 / 8 * 7 / 8).
  for (const int count : octants) EXPECT_NEAR(count, 800, 5 * 26.5);
}

TEST_F(ParticlesTest, AFrameFollowsFromItsInputAlone) {
  add(scene_, thruster_, input(300));
  Scene later = scene_;
  later.systems[0] = planning::particle_system(
      [&] {
        ParticleInput moved = input(300);
        moved.time += 0.1;
        return moved;
      }(),
      {});
  const auto first = draw(scene_).pixels, second = draw(later).pixels;
  EXPECT_NE(first, second);
  EXPECT_EQ(draw(scene_).pixels, first);
}

// Far times keep the phase of the drift, which wraps after the region's length.
TEST_F(ParticlesTest, DriftWrapsAroundTheRegion) {
  ParticleInput now = input(100);
  now.swirl = 0;
  now.time = 0;
  const ParticleSystem at_first = planning::particle_system(now, {});
  now.drift = (1 + 2 * at_first.margin.z) / 4;
  now.time = 4000;
  const ParticleSystem later = planning::particle_system(now, {});
  EXPECT_NEAR(later.drift - std::round(later.drift), 0, 1000 * 2 * kSingle);
  now.time = 4001;
  EXPECT_NEAR(planning::particle_system(now, {}).drift, 0.25, 1000 * 2 * kSingle);
}

TEST_F(ParticlesTest, AreSortedFromBackToFront) {
  for (const std::vector<std::uint32_t>& counts : std::vector<std::vector<std::uint32_t>>{
           {1}, {2}, {1000}, {1024}, {1025}, {6400}, {65536}, {1, 700, 3, 5000}}) {
    Scene scene;
    // The box reaches behind the eye.
    scene.camera = camera_of({0, 0, 0.4f}, {0.2f, 0.1f, -5}, 0.7f, scene.size_px);
    for (const std::uint32_t count : counts) {
      ParticleInput one = input(count);
      one.extinction = 1;
      one.seed = count;
      add(scene, thruster_, one);
    }
    const Drawn drawn = draw(scene);
    std::set<std::uint32_t> numbers;
    for (std::size_t i = 0; i < drawn.order.size(); ++i) {
      const glm::uvec2 entry = drawn.order[i];
      ASSERT_LT(entry.y, drawn.particles.size());
      numbers.insert(entry.y);
      const float view_m = drawn.particles[entry.y].view_m;
      ASSERT_EQ(entry.x, view_m > 0 ? std::bit_cast<std::uint32_t>(view_m) : 0u);
      if (i > 0) {
        const glm::uvec2 before = drawn.order[i - 1];
        ASSERT_TRUE(before.x > entry.x || (before.x == entry.x && before.y < entry.y)) << i;
      }
    }
    EXPECT_EQ(numbers.size(), drawn.order.size());
  }
}

TEST_F(ParticlesTest, ComposeAsOnTheProcessor) {
  for (const float extinction : {0.0f, 4.0f}) {
    for (const std::uint32_t count : {1u, 50u, 900u}) {
      Scene scene = scene_;
      scene.background = {0.5f, 1, 0.25f, 1};
      ParticleInput one = input(count);
      one.extinction = extinction;
      add(scene, thruster_, one);
      const Drawn drawn = draw(scene);
      expect_composed(scene, drawn);
      EXPECT_NE(drawn.pixels, std::vector(scene.pixels(), scene.background)) << count;
    }
  }
}

// Two boxes that overlap: one glows, the other absorbs. In the opposite order the image is another one.
TEST_F(ParticlesTest, SystemsThatOverlapAreInOneOrder) {
  const MaskVolume dark({9, 9, 9}, 1, [](glm::vec3 uvw) {
    const glm::vec3 to_face = glm::min(uvw, 1.0f - uvw) - 0.5f / 9;
    return glm::vec4(std::min(4 * std::min({to_face.x, to_face.y, to_face.z}), 1.0f), 0, 0, 0);
  });
  ParticleInput glowing = input(700), absorbing = input(500);
  glowing.extinction = 1;
  absorbing.tints = {};
  absorbing.extinction = 6;
  absorbing.world_from_uvw = oblique_box({0.3f, 0.1f, 0.3f}, {1, 1, 1});
  add(scene_, thruster_, glowing);
  add(scene_, dark, absorbing);
  const Drawn drawn = draw(scene_);
  expect_composed(scene_, drawn);
  double most = 0;
  for (std::size_t i = 0; i < scene_.pixels(); ++i)
    most =
        std::max(most, glm::length(compose(scene_, drawn, i).value - compose(scene_, drawn, i, false).value));
  EXPECT_GT(most, 0.1);
}

TEST_F(ParticlesTest, AreSoftBeforeSurfacesAndNothingBehindThem) {
  for (const float softness : {0.0f, 0.3f, 2.0f})
    for (const float surface_m : {2.0f, 4.5f, 5.0f, 9.0f}) {
      Scene scene = scene_;
      scene.surface_m = surface_m;
      scene.background = {0.125f, 0.25f, 0.5f, 1};
      ParticleInput one = input(400);
      one.softness = softness;
      one.extinction = 2;
      add(scene, thruster_, one);
      const Drawn drawn = draw(scene);
      // The depth of the surface is rounded: quads as close to it as 1e-6 m would be on either side.
      for (const shared::Particle& particle : drawn.particles)
        ASSERT_GT(std::abs(particle.view_m - surface_m), softness > 0 ? 0 : 1e-6f);
      expect_composed(scene, drawn);
      if (surface_m == 2.0f) {
        EXPECT_EQ(drawn.pixels, std::vector(scene.pixels(), scene.background));
      }
    }
}

TEST_F(ParticlesTest, TheEyeMayBeAmongThem) {
  for (const glm::vec3 eye : {glm::vec3(0, 0.1f, 0.2f), glm::vec3(0.2f, 0, 1.1f)})
    for (const float softness : {0.0f, 0.2f}) {
      Scene scene;
      scene.camera = camera_of(eye, {0.1f, 0.05f, -1}, 1.2f, scene.size_px);
      ParticleInput one = input(500);
      one.extinction = 1;
      one.softness = softness;
      add(scene, thruster_, one);
      const Drawn drawn = draw(scene);
      const auto behind = std::ranges::count_if(drawn.particles, [](const auto& p) { return p.view_m <= 0; });
      EXPECT_GT(behind, 20);
      expect_composed(scene, drawn);
    }
}

// The image rounds to 11 bits, to the nearest or not: by at most 2^-10.
TEST_F(ParticlesTest, TheLayerIsOverTheImage) {
  ParticleInput one = input(400);
  one.extinction = 2;
  add(scene_, thruster_, one);
  scene_.background = {0.5f, 0.25f, 8, 0.75f};
  const Drawn drawn = draw(scene_);
  for (std::size_t i = 0; i < scene_.pixels(); ++i) {
    const glm::vec4 layer = drawn.layer[i];
    for (int channel = 0; channel < 3; ++channel) {
      const float expected = layer[channel] + layer.w * scene_.background[channel];
      ASSERT_NEAR(drawn.pixels[i][channel], expected, expected / 1024) << i;
    }
    ASSERT_EQ(drawn.pixels[i].w, scene_.background.w);
  }
}

// Corners of quads within 0.01 pixels of a pixel's middle may be on either side of it.
TEST_F(ParticlesTest, OverdrawCountsQuads) {
  add(scene_, thruster_, input(300));
  scene_.surface_m = 4;  // counts those behind it, too
  const Drawn drawn = draw(scene_, true);
  const glm::dvec3 right = glm::normalize(glm::dvec3(scene_.camera.right));
  const glm::dvec3 up = glm::normalize(glm::dvec3(scene_.camera.up));
  const double pixel = 2 * glm::length(glm::dvec3(scene_.camera.right)) / scene_.size_px.x;
  const double unsure = std::max(0.01, snapping_px()) * pixel;  // at 1 m
  float most = 0;
  for (std::size_t i = 0; i < scene_.pixels(); ++i) {
    int at_least = 0, at_most = 0;
    for (const shared::Particle& particle : drawn.particles) {
      const double view_m = double{particle.view_m};
      const glm::dvec3 away = scene_.at(i, view_m) - glm::dvec3(particle.centre_world);
      const double off = std::max(std::abs(glm::dot(away, right)), std::abs(glm::dot(away, up))) -
                         double{scene_.systems[0].radius};
      at_least += off < -unsure * view_m;
      at_most += off < unsure * view_m;
    }
    ASSERT_GE(drawn.pixels[i].x, at_least) << i;
    ASSERT_LE(drawn.pixels[i].x, at_most) << i;
    most = std::max(most, drawn.pixels[i].x);
  }
  EXPECT_GT(most, 10);
}

TEST_F(ParticlesTest, NoneLeaveTheImageAsItIs) {
  scene_.background = {0.125f, 0.25f, 0.5f, 0.75f};
  EXPECT_EQ(draw(scene_).pixels, std::vector(scene_.pixels(), scene_.background));
  Scene away = scene_;  // all behind the eye
  away.camera = camera_of({0, 0, 5}, {0, 0, 9}, 0.7f, away.size_px);
  add(away, thruster_, input(50));
  EXPECT_EQ(draw(away).pixels, std::vector(away.pixels(), away.background));
}

}  // namespace
}  // namespace brume::passes
