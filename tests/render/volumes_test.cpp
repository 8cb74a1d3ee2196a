// Several media in one frame: volumes under any affine transform, alone, overlapping, and with smoke.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "planning/blackbody.hpp"
#include "tests/render/even_light.hpp"
#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

/// A voxel space of `size` m whose low corner is at `corner`, turned, sheared and, with `mirror`, flipped.
glm::mat4 oblique(const volume::SparseVolume& volume, glm::vec3 corner, glm::vec3 size, bool mirror = false) {
  glm::mat4 shear(1);
  shear[1][0] = 0.3f;
  shear[2][1] = -0.2f;
  const glm::vec3 scale = size / volume.layout().bounds_max * glm::vec3(mirror ? -1 : 1, 1, 1);
  return glm::translate(glm::mat4(1), corner) *
         glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(0.3f, 1, 0.2f))) * shear *
         glm::scale(glm::mat4(1), scale);
}

/// Absorbs and emits, but scatters nothing.
shared::VolumeLook glowing(float extinction, glm::vec3 emission) {
  return {glm::vec3(0), extinction, emission, 0, 0};
}

class VolumesTest : public VolumePictures<VolumesTest> {
 public:
  static constexpr glm::uvec2 kSize{61, 37};

 protected:
  VolumesTest() {
    renderer().set_march_scale(1);
    input_.view.camera = {{0, 0, 9}, {0, 0, 0}, 0.9f};
  }

  /// Length of each pixel's ray inside a block, in double precision [m].
  std::vector<double> chords(const planning::VolumeInput& volume) const {
    const shared::Camera camera = planning::FramePlan(input_, kSize).camera;
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(volume.world_from_voxel));
    const glm::dvec3 high(volume.volume->layout().bounds_max);
    const glm::dvec3 origin(inverse * glm::dvec4(glm::dvec3(camera.eye_world), 1));
    std::vector<double> lengths;
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
      const glm::dvec2 ndc = (glm::dvec2(i % kSize.x, i / kSize.x) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
      const glm::dvec3 ray = glm::normalize(glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) -
                                            ndc.y * glm::dvec3(camera.up));
      const glm::dvec3 direction(inverse * glm::dvec4(ray, 0));
      double enter = 0, leave = 1e30;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = -origin[axis] / direction[axis], b = (high[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      lengths.push_back(std::max(leave - enter, 0.0));
    }
    return lengths;
  }

  /// Each ray's optical depth is that of its chord, up to the step at each end that a sample may miss; the
  /// mean of all rays is closer, because of the jitter.
  void expect_beer_lambert(const planning::VolumeInput& volume) {
    const std::vector<glm::vec4> pixels = draw();
    const std::vector<double> lengths = chords(volume);
    const double step = double{input_.quality.step_scale} * step_of(volume);
    const double sigma = double{volume.look.extinction};
    double sum = 0, expected_sum = 0;
    int inside = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      // Half floats round the transmittance.
      const double low = std::exp(-sigma * (lengths[i] + step)) * (1 - 1.0 / 1024);
      const double high = std::min(std::exp(-sigma * (lengths[i] - step)), 1.0) * (1 + 1.0 / 1024);
      ASSERT_GE(double{pixels[i].w}, low) << i << " of length " << lengths[i];
      ASSERT_LE(double{pixels[i].w}, high) << i << " of length " << lengths[i];
      // In-scatter is constant: what is not let through is what the volume emits.
      ASSERT_NEAR(double{pixels[i].y}, double{volume.look.emission.y} * (1 - double{pixels[i].w}), 2e-3) << i;
      sum += double{pixels[i].w};
      expected_sum += std::exp(-sigma * lengths[i]);
      inside += lengths[i] > 4 * step;
    }
    EXPECT_GT(inside, 150) << "rays that go through";
    // The part of a step that jitter adds or drops has a variance of 1/6 of the step's at most.
    const double count = static_cast<double>(pixels.size());
    EXPECT_NEAR(sum / count, expected_sum / count, 4 * sigma * step * std::sqrt(inside / 6.0) / count + 1e-3);
  }
  static double step_of(const planning::VolumeInput& volume) {
    double shortest = 1e30;
    for (int axis = 0; axis < 3; ++axis)
      shortest = std::min(shortest, double{glm::length(glm::vec3(volume.world_from_voxel[axis]))});
    return shortest;
  }
};

TEST_F(VolumesTest, ATransformedBlockIsBeerLambert) {
  const volume::SparseVolume cube = block({2, 2, 2}), bar = block({1, 5, 3});
  for (const bool mirror : {false, true})
    for (const volume::SparseVolume* volume : {&cube, &bar}) {
      input_.volumes = {{volume, oblique(*volume, {-1, -1.5f, 0}, {3, 2, 4}, mirror), {}}};
      input_.volumes[0].look = glowing(0.8f, {0.2f, 0.5f, 0.1f});
      expect_beer_lambert(input_.volumes[0]);
    }
}

TEST_F(VolumesTest, TheEyeMayBeInside) {
  const volume::SparseVolume cube = block({3, 2, 4});
  input_.volumes = {{&cube, oblique(cube, {-4, -2, 2}, {9, 5, 9}), glowing(0.3f, glm::vec3(0.4f))}};
  const glm::vec3 middle(input_.volumes[0].world_from_voxel * glm::vec4(cube.layout().bounds_max * 0.5f, 1));
  input_.view.camera = {middle, middle + glm::vec3(1, 0.2f, -2), 0.9f};
  expect_beer_lambert(input_.volumes[0]);
}

// All volumes are there in every frame, so that all frames step alike; those without extinction show nothing.
TEST_F(VolumesTest, OverlappingVolumesMultiplyTheirTransmittance) {
  const volume::SparseVolume cube = block({2, 2, 2}), bar = block({1, 3, 2}), slab = block({4, 1, 1});
  const std::array<const volume::SparseVolume*, 3> volumes{&cube, &bar, &slab};
  const auto draw_with = [&](std::array<float, 3> extinction) {
    input_.volumes.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 corner{-2 + 0.5f * static_cast<float>(i), -1, -0.5f * static_cast<float>(i)};
      input_.volumes.push_back({volumes[i], oblique(*volumes[i], corner, {3, 2.5f, 2}, i == 1), {}});
      input_.volumes[i].look = glowing(extinction[i], glm::vec3(0.3f));
    }
    return draw();
  };
  const auto a = draw_with({0.5f, 0, 0}), b = draw_with({0, 0.9f, 0}), c = draw_with({0, 0, 0.4f});
  const auto all = draw_with({0.5f, 0.9f, 0.4f});
  int overlaps = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float product = a[i].w * b[i].w * c[i].w;
    EXPECT_NEAR(all[i].w, product, 4 * product / 2048) << i;  // four roundings to half floats
    EXPECT_NEAR(all[i].x, 0.3f * (1 - all[i].w), 2e-3f) << "all emit alike";
    overlaps += a[i].w < 0.8f && b[i].w < 0.8f && c[i].w < 0.99f;
  }
  EXPECT_GT(overlaps, 20);
}

/// As `block`, but what is not at its faces is uniform.
volume::SparseVolume uniform_block(glm::ivec3 bricks, float density) {
  volume::SparseVolume volume({{}, 1, {{sizeof(std::uint16_t)}}});
  volume.begin_update();
  for_each_in(Box<int>{glm::ivec3(0), bricks}, [&](glm::ivec3 brick) {
    if (glm::all(glm::greaterThan(brick, glm::ivec3(0))) && glm::all(glm::lessThan(brick, bricks - 1))) {
      volume.set_uniform(brick, glm::packHalf1x16(density));
      return;
    }
    for (std::uint16_t& texel : volume.texels<std::uint16_t>(volume::ChannelId{0}, volume.acquire(brick)))
      texel = glm::packHalf1x16(density);
  });
  volume.set_bounds(glm::vec3(0), glm::vec3(8 * bricks));
  volume.end_update();
  return volume;
}

TEST_F(VolumesTest, UniformBricksLookAsThoseOfTexels) {
  const volume::SparseVolume stored = block({5, 4, 6}, 0.5f), uniform = uniform_block({5, 4, 6}, 0.5f);
  EXPECT_LT(uniform.slot_count(), stored.slot_count());
  const glm::mat4 placed = oblique(stored, {-2, -1.5f, -2}, {4, 3, 4});
  // What only absorbs goes through a uniform brick in one step; what scatters or emits, in all of them.
  for (const shared::VolumeLook& look : {glowing(0.9f, glm::vec3(0)), glowing(0.9f, {0.3f, 0.2f, 0.1f}),
                                         shared::VolumeLook{glm::vec3(0.7f), 0.9f, glm::vec3(0), 0, 1}})
    for (const int count : {1, 2}) {
      input_.volumes.assign(static_cast<std::size_t>(count), {&stored, placed, look, {}});
      if (count > 1) input_.volumes[1].world_from_voxel = oblique(stored, {-1, -1, -1}, {3, 3, 2}, true);
      const std::vector<glm::vec4> expected = draw();
      for (planning::VolumeInput& volume : input_.volumes) volume.volume = &uniform;
      const std::vector<glm::vec4> drawn = draw();
      for (std::size_t i = 0; i < drawn.size(); ++i)
        for (int channel = 0; channel < 4; ++channel)
          // Half floats of each step's product, rounded in another order.
          ASSERT_NEAR(drawn[i][channel], expected[i][channel],
                      3.0f / 2048 * std::max(1.0f, expected[i][channel]))
              << i << ' ' << count;
    }
}

// A frame of one volume is marched span by span, one of several block by block.
TEST_F(VolumesTest, TwoHalvesAreAWhole) {
  const volume::SparseVolume ramp = values({5, 4, 6}, [](glm::vec3 p) { return 0.3f + 0.01f * (p.x + p.y); });
  const glm::mat4 placed = oblique(ramp, {-2, -1.5f, -2}, {4, 3, 4});
  const planning::HeatInput heat{&ramp, placed, planning::kUnitGlow, 1, 0.3f};
  for (const bool hot : {false, true}) {
    const auto drawn = [&](float extinction, std::size_t count) {
      const shared::VolumeLook look = glowing(extinction, {0.3f, 0.2f, 0.1f});
      input_.volumes.assign(count, {&ramp, placed, look, hot ? heat : planning::HeatInput()});
      return draw();
    };
    const std::vector<glm::vec4> whole = drawn(0.8f, 1), halves = drawn(0.4f, 2), quarters = drawn(0.2f, 4);
    int inside = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      inside += whole[i].w < 0.5f;
      for (int channel = 0; channel < 4; ++channel)
        for (const float other : {halves[i][channel], quarters[i][channel]})
          ASSERT_NEAR(other, whole[i][channel], 2.0f / 2048 * std::max(1.0f, whole[i][channel])) << i;
    }
    EXPECT_GT(inside, 150);
  }
}

// Rays end behind the last part, and skip what lies between.
TEST_F(VolumesTest, PartsFarFromEachOtherLookAsInVolumesOfTheirOwn) {
  const auto parts = [](bool near, bool far) {
    volume::SparseVolume volume({{}, 1, {{sizeof(std::uint16_t)}}});
    volume.begin_update();
    for (const glm::ivec3 brick : {glm::ivec3(0), glm::ivec3(30, 0, 0), glm::ivec3(30, 20, 0)})
      if (brick.x == 0 ? near : far)
        for (std::uint16_t& texel : volume.texels<std::uint16_t>(volume::ChannelId{0}, volume.acquire(brick)))
          texel = glm::packHalf1x16(0.8f);
    volume.set_bounds(glm::vec3(0), {8 * 31, 8 * 21, 8});
    volume.end_update();
    return volume;
  };
  const volume::SparseVolume both = parts(true, true), near = parts(true, false), far = parts(false, true);
  EXPECT_EQ(both.boxes().size(), 3u);
  constexpr float kSigma = 12;
  const glm::mat4 placed = oblique(both, {-2.5f, -2, -1}, {6, 5, 4});
  const auto drawn = [&](const volume::SparseVolume& volume) {
    input_.volumes = {{&volume, placed, glowing(kSigma, glm::vec3(0)), {}}};
    return draw();
  };
  const auto of_both = drawn(both), of_near = drawn(near), of_far = drawn(far);
  // The rays begin elsewhere, so that each part may be met by one sample more or less.
  const double most = 3 * 0.8 * double{kSigma} * step_of(input_.volumes[0]) + 3.0 / 1024;
  double sum = 0;
  int seen = 0;
  for (std::size_t i = 0; i < of_both.size(); ++i) {
    const double expected = double{of_near[i].w} * double{of_far[i].w};
    EXPECT_EQ(of_both[i].w < 1, expected < 1) << i;
    if (expected > 0.99 || expected < 0.1) continue;
    const double off = std::log(double{of_both[i].w} / expected);
    EXPECT_LT(std::abs(off), most) << i;
    sum += off;
    ++seen;
  }
  EXPECT_GT(seen, 30);
  EXPECT_LT(std::abs(sum / seen), most / std::sqrt(seen)) << "the samples' jitter has no bias";
}

// Single scattering in a block below the sun: at depth d below its top the sun's light is E exp(-sigma d),
// and a level ray of length L gathers albedo E / (4 pi) exp(-sigma d) (1 - exp(-sigma L)).
TEST_F(VolumesTest, SunlightInABlockIsThatOfSingleScattering) {
  const volume::SparseVolume cube = block({4, 4, 4});
  constexpr float kSigma = 0.4f, kEdge = 4, kIrradiance = 5;
  const glm::mat4 placed =
      glm::scale(glm::translate(glm::mat4(1), glm::vec3(-kEdge / 2)), kEdge / cube.layout().bounds_max);
  input_.volumes = {{&cube, placed, {glm::vec3(0.5f), kSigma, glm::vec3(0), 0, 0}, {}}};
  input_.environment.flashes = {sun_light({0, -1, 0}, kIrradiance)};
  input_.view.camera = {{0, 0, 400}, {0, 0, 0}, 0.011f};  // nearly parallel rays
  const std::vector<glm::vec4> pixels = draw();
  int compared = 0;
  const float tall = 800 * std::tan(0.0055f);
  for (std::uint32_t y = 0; y < kSize.y; ++y) {
    const float height = tall * (0.5f - (static_cast<float>(y) + 0.5f) / static_cast<float>(kSize.y));
    const float depth = kEdge / 2 - height;
    if (depth < 0.3f || depth > kEdge - 0.3f) continue;
    const glm::vec4 pixel = pixels[y * kSize.x + kSize.x / 2];
    const float expected =
        0.5f * kIrradiance / 12.5663706f * std::exp(-kSigma * depth) * (1 - std::exp(-kSigma * kEdge));
    // A cell of light is an eighth of a metre: exp is linear in it but for (sigma / 8)^2 / 8, and the image
    // is half floats. The step at each end that a sample may miss is 1 / 32 of the ray.
    EXPECT_NEAR(pixel.x, expected, 0.035f * expected) << "at depth " << depth;
    ++compared;
  }
  EXPECT_GT(compared, 15);
}

// An opaque cloud under a uniform sky that absorbs nothing is as bright as the sky.
TEST_F(VolumesTest, WithoutAbsorptionACloudIsAsBrightAsTheSky) {
  const volume::SparseVolume cube = block({3, 3, 3});
  input_.volumes = {
      {&cube, oblique(cube, {-2, -2, -2}, glm::vec3(4)), {glm::vec3(1), 6, glm::vec3(0), 0.3f, 1}, {}}};
  const voxel::BitGrid level = closed_level({{40, 40, 40}, 0.25f, glm::vec3(-5)});
  light_evenly(input_, level, 0.7f);
  int opaque = 0;
  for (const glm::vec4& pixel : draw()) {
    if (pixel.w > 0.002f) continue;
    EXPECT_NEAR(pixel.x, 0.7f, 0.02f);
    ++opaque;
  }
  EXPECT_GT(opaque, 100);
}

// What is scattered once is proportional to the albedo.
TEST_F(VolumesTest, SkylightThatIsScatteredOnceIsProportionalToTheAlbedo) {
  const volume::SparseVolume cube = block({2, 2, 2});
  input_.environment.sky = {};
  input_.environment.sky.ambient = glm::vec3(0.5f);
  const auto with_albedo = [&](float albedo) {
    input_.volumes = {{&cube, oblique(cube, {-1, -1.5f, 0}, {3, 2, 4}), {}}};
    input_.volumes[0].look = {glm::vec3(albedo), 2, glm::vec3(0), 0, 0};
    return draw();
  };
  const auto half = with_albedo(0.5f), whole = with_albedo(1);
  int compared = 0;
  for (std::size_t i = 0; i < half.size(); ++i) {
    // Light in the volume and radiance are half floats.
    EXPECT_NEAR(whole[i].y, 2 * half[i].y, 0.003f * whole[i].y + 1e-6f) << i;
    compared += whole[i].y > 0.05f;
  }
  EXPECT_GT(compared, 100);
}

// Heat alone, in bricks without density: radiance emission * extinction * length.
TEST_F(VolumesTest, HeatGlowsWithoutAnyDensity) {
  const volume::SparseVolume empty = block({2, 2, 2}, 0), hot = block({2, 2, 2});
  const glm::mat4 placed = oblique(empty, {-1, -1.5f, 0}, {3, 2, 4});
  planning::HeatInput heat{&hot, placed, planning::kUnitGlow, 1, 1};
  input_.volumes = {{&empty, placed, {glm::vec3(0), 0.2f, glm::vec3(0), 0, 0}, heat}};
  const std::vector<glm::vec4> pixels = draw();
  const std::vector<double> lengths = chords(input_.volumes[0]);
  const float glow = planning::blackbody_color(planning::kUnitGlow).r;
  const double step = step_of(input_.volumes[0]);
  int inside = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_EQ(pixels[i].w, 1) << i;
    const double per_metre = 0.2 * double{glow};
    EXPECT_NEAR(double{pixels[i].x}, per_metre * lengths[i], per_metre * step * 1.02 + 2e-3) << i;
    inside += lengths[i] > 1;
  }
  EXPECT_GT(inside, 150);
}

// What an optical depth of 6 to 9 leaves of a floor that emits 1000 is far above what a display shows.
TEST_F(VolumesTest, ABrightFloorShowsThroughWhatIsOpaqueBeforeOthers) {
  const volume::SparseVolume slab = block({4, 2, 4});
  const glm::mat4 placed =
      glm::translate(glm::mat4(1), glm::vec3(-4, -2, -4)) * glm::scale(glm::mat4(1), glm::vec3(0.25f));
  input_.volumes = {{&slab, placed, glowing(2, glm::vec3(0))}};
  input_.view.camera = {{0, 9, 0}, {0, 0, -0.5f}, 0.4f};
  input_.smoke.look.opaque_transmittance = 0.004f;
  const std::vector<double> lengths = chords(input_.volumes[0]);
  for (const auto& form :
       {std::optional<passes::RaycastForm>(), std::optional(passes::RaycastForm::two_pass)})
    for (const float radiance : {1.0f, 1000.0f}) {
      scene::Scene floor = far_floor();
      floor.materials[0].base_color = glm::vec3(0);
      floor.materials[0].emission = glm::vec3(0.5f * radiance, radiance, 0);
      RendererOptions options{kSize};
      options.smoke.raycast = form;
      Renderer bright(context(), runner(), floor, options);
      bright.draw(input_);
      const auto pixels = read_back<passes::Half4>(bright.radiance());
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        ASSERT_GT(lengths[i], 3.5) << i;
        const double expected = radiance > 1 ? double{radiance} * std::exp(-2 * lengths[i]) : 0;
        EXPECT_NEAR(double{passes::from_half(pixels[i]).y}, expected, 0.02 * expected) << i;
      }
    }
}

/// A cloud of smoke in an open world.
class VolumesWithSmokeTest : public VolumesTest {
 protected:
  VolumesWithSmokeTest() {
    smoke_.show_in(input_);
    input_.smoke.look.albedo = glm::vec3(0.9f);
  }

  const RestingSmoke smoke_{
      voxel::BitGrid({{40, 24, 40}, 0.5f, glm::vec3(-10, -6, -10)}), {}, glm::dvec3(0), 120};
};

TEST_F(VolumesWithSmokeTest, SmokeAndVolumesMultiplyTheirTransmittance) {
  const volume::SparseVolume cube = block({2, 2, 2});
  const auto draw_with = [&](float smoke, float volume) {
    input_.smoke.look.extinction = smoke;
    input_.volumes = {{&cube, oblique(cube, {-3, -1, -1}, {4, 3, 3}), glowing(volume, glm::vec3(0.3f))}};
    return draw();
  };
  const auto smoke = draw_with(1.5f, 0), volume = draw_with(0, 0.7f), both = draw_with(1.5f, 0.7f);
  int overlaps = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const float product = smoke[i].w * volume[i].w;
    EXPECT_NEAR(both[i].w, product, 3 * product / 2048 + 1e-6f) << i;
    EXPECT_LE(both[i].x, smoke[i].x + volume[i].x + 2e-3f) << "each dims the other";
    overlaps += smoke[i].w < 0.8f && volume[i].w < 0.8f;
  }
  EXPECT_GT(overlaps, 20);
}

TEST_F(VolumesWithSmokeTest, AVolumeOutOfViewChangesNothing) {
  input_.smoke.look.extinction = 2;
  const auto without = draw();
  const volume::SparseVolume cube = block({2, 2, 2});
  input_.volumes = {{&cube, oblique(cube, {0, 0, 30}, glm::vec3(2)), glowing(1, glm::vec3(1))}};
  EXPECT_EQ(draw(), without);
}

// A slab between the sun and what is in view, itself out of view, takes exp(-depth) of light that is
// scattered once.
class SlabAboveTest : public VolumesWithSmokeTest {
 protected:
  SlabAboveTest() {
    input_.smoke.look.multiple_scattering = 0;
    input_.environment.flashes = {sun_light({0, -1, 0}, 5)};
  }
  /// 2 m thick.
  planning::VolumeInput slab(float depth) const {
    const glm::mat4 placed = glm::scale(glm::translate(glm::mat4(1), {-8, 12, -8}),
                                        glm::vec3(16, 2, 16) / slab_.layout().bounds_max);
    return {&slab_, placed, glowing(depth / 2, glm::vec3(0)), {}};
  }
  /// Depths of rays to the light are half floats up to 12, hence off by 0.6 %; so is what is stored of them.
  /// The least halves are 6e-8 apart.
  static void expect_dimmed(const std::vector<glm::vec4>& by_slab, const std::vector<glm::vec4>& without,
                            float depth) {
    int compared = 0;
    for (std::size_t i = 0; i < without.size(); ++i) {
      EXPECT_EQ(by_slab[i].w, without[i].w) << i;
      EXPECT_NEAR(by_slab[i].x, std::exp(-depth) * without[i].x, 0.01f * without[i].x + 1.2e-7f) << i;
      compared += without[i].x > 0.02f;
    }
    EXPECT_GT(compared, 100);
  }
  const volume::SparseVolume slab_ = block({2, 2, 2});
};

TEST_F(SlabAboveTest, DimsTheLightInSmoke) {
  input_.smoke.look.extinction = 1;
  const auto without = draw();
  for (const float depth : {0.5f, 1.5f}) {
    input_.volumes = {slab(depth)};
    expect_dimmed(draw(), without, depth);
  }
  input_.volumes.clear();
  EXPECT_EQ(draw(), without);
}

TEST_F(SlabAboveTest, DimsTheLightInOtherVolumes) {
  input_.smoke = {};
  const volume::SparseVolume cube = block({2, 2, 2});
  const planning::VolumeInput seen{
      &cube, oblique(cube, {-2, -2, -2}, glm::vec3(4)), {glm::vec3(0.8f), 0.4f, glm::vec3(0), 0, 0}, {}};
  input_.volumes = {seen};
  const auto without = draw();
  for (const float depth : {0.5f, 1.5f}) {
    input_.volumes = {slab(depth), seen};
    expect_dimmed(draw(), without, depth);
  }
}

TEST_F(VolumesTest, ReducedRaysAgreeWithOnePerPixel) {
  const volume::SparseVolume cube = block({2, 2, 2});
  input_.volumes = {{&cube, oblique(cube, {-1, -1.5f, 0}, {3, 2, 4}), glowing(0.8f, glm::vec3(0.5f))}};
  const auto full = draw();
  for (const std::uint32_t scale : {2u, 4u}) {
    renderer().set_march_scale(scale);
    const auto reduced = draw();
    double sum = 0;
    for (std::size_t i = 0; i < full.size(); ++i) sum += std::abs(double{full[i].w} - double{reduced[i].w});
    EXPECT_LT(sum / static_cast<double>(full.size()), 3.0 / 255) << scale;  // shared::kResolveError
  }
}

TEST_F(VolumesTest, RefusesTooManyAndFlatOnes) {
  const volume::SparseVolume cube = block({1, 1, 1});
  input_.volumes.assign(shared::kMaxVolumes, {&cube, oblique(cube, {-1, -1, -1}, glm::vec3(2)), {}});
  // Nearly opaque, so that the light stops early in each.
  for (planning::VolumeInput& volume : input_.volumes) volume.look = glowing(1000, glm::vec3(0));
  EXPECT_LT(draw()[kSize.x * (kSize.y / 2) + kSize.x / 2].w, 0.2f) << "32 times the same volume";
  input_.volumes.push_back(input_.volumes[0]);
  EXPECT_THROW(draw(), Error);
  input_.volumes.resize(1);
  input_.volumes[0].world_from_voxel[1] = glm::vec4(0);
  EXPECT_THROW(draw(), Error);
}

}  // namespace
}  // namespace brume::render
