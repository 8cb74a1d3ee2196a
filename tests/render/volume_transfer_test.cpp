// Transfer functions and grids of colours on the device, against analytic depths and against volumes without
// them.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

class VolumeTransferTest : public VolumePictures<VolumeTransferTest> {
 public:
  static constexpr glm::uvec2 kSize{41, 41};

  static scene::Scene scene() {
    return scene_of({{{-40, -31, -40}, {40, -4, 40}}}, {scene_sun({0.3f, -1, -0.4f}, 4)}, 0);
  }

 protected:
  /// Nearly parallel rays along -z that see a square of 5 m around the origin.
  VolumeTransferTest() { input_.view.camera = {{0, 0, 400}, {0, 0, 0}, 2 * std::atan(2.5f / 400)}; }

  /// A cube of `edge` m around the origin.
  static glm::mat4 placed(const volume::SparseVolume& volume, float edge) {
    return glm::scale(glm::translate(glm::mat4(1), glm::vec3(-edge / 2)), edge / volume.layout().bounds_max);
  }
  planning::VolumeInput& add(const volume::SparseVolume& volume, float extinction, float edge = kEdge) {
    input_.volumes.push_back({&volume, placed(volume, edge), {glm::vec3(0), extinction, glm::vec3(0), 0, 1}});
    return input_.volumes.back();
  }
  /// Where the ray of a pixel meets the plane z = 0 [m].
  static glm::dvec2 place_of(std::size_t pixel) {
    const glm::dvec2 p(static_cast<double>(pixel % kSize.x) + 0.5,
                       static_cast<double>(pixel / kSize.x) + 0.5);
    return (p / glm::dvec2(kSize) - 0.5) * glm::dvec2(5, -5);
  }
  static bool is_inside(std::size_t pixel, double margin) {
    const glm::dvec2 p = glm::abs(place_of(pixel));
    return std::max(p.x, p.y) < double{kEdge} / 2 - margin;
  }
  static constexpr float kEdge = 4;
};

/// A light and a sky, beside the sun of the scene.
planning::Environment daylight() {
  return planning::FrameBuilder()
      .light(point_light({3, 2, 2}, {20, 30, 40}))
      .ambient({0.4f, 0.5f, 0.6f})
      .input()
      .environment;
}

TEST_F(VolumeTransferTest, TheDepthOfASlabIsCurveTimesExtinctionTimesLength) {
  const std::vector<scene::OpacityPoint> curve{{0.1f, 0.2f}, {0.5f, 0.8f}, {0.5f, 0.3f}, {0.9f, 1}};
  constexpr float kSigma = 0.6f;
  for (const float value : {0.25f, 0.5f, 1.0f, 1.75f, 2.5f, 4.0f}) {
    const volume::SparseVolume slab = block({2, 2, 2}, value);
    input_.volumes.clear();
    add(slab, kSigma).transfer = {curve, {}, {0.5f, 2.5f}, 0, 1};
    const double at = std::clamp((double{value} - 0.5) / 2, 0.0, 1.0);
    // At the step, the mean over a cell of the table around it.
    const double opacity = value == 1.5f ? 0.55 : scene::opacity_at(curve, at);
    // A step of 1/4 m at each end that jitter adds or drops; outside of the bounds nothing is between 0 and
    // the value.
    const double step = 0.25, depth = opacity * double{kSigma};
    const auto pixels = draw();
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!is_inside(i, 0.2)) continue;
      EXPECT_GE(double{pixels[i].w}, std::exp(-depth * (double{kEdge} + step)) * 0.999) << value;
      EXPECT_LE(double{pixels[i].w}, std::exp(-depth * (double{kEdge} - step)) * 1.001) << value;
      sum += -std::log(double{pixels[i].w});
      ++count;
    }
    ASSERT_GT(count, 500);
    // The variance of what jitter adds is 1/6 of a step's square at most.
    EXPECT_NEAR(sum / count, depth * double{kEdge}, 4 * depth * step / std::sqrt(6.0 * count) + 2e-3)
        << value;
  }
}

// The value rises from 0 to 1 along each ray; the peak is an eighth of a step wide.
TEST_F(VolumeTransferTest, APeakNarrowerThanAStepKeepsItsDepth) {
  const volume::SparseVolume ramp = values({2, 2, 2}, [](glm::vec3 p) { return std::max(p.z / 16, 0.0f); });
  for (const float width : {1.0f / 128, 1.0f / 20, 0.3f}) {
    input_.volumes.clear();
    const float low = 0.413f, high = low + width;
    add(ramp, 0.5f / width).transfer = {{{low, 0}, {low, 1}, {high, 1}, {high, 0}}, {}, {0, 1}, 0, 1};
    // Depth: extinction * width * edge = 2 for every width. Half floats round values near 0.5 by 1/4096 and a
    // cell of the table is 1/1024, each of which a border of the peak may be off by.
    const double error = 2 * (1.0 / 4096 + 1.0 / 1024) * 2 / double{width};
    double sum = 0;
    int count = 0;
    const auto pixels = draw();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!is_inside(i, 0.2)) continue;
      EXPECT_NEAR(-std::log(double{pixels[i].w}), 2, std::min(error, 0.25)) << width << " at " << i;
      sum += -std::log(double{pixels[i].w});
      ++count;
    }
    EXPECT_NEAR(sum / count, 2, 0.03) << width;
  }
}

// A step curve on 1 - r / 2 at 0.5: a ball of radius 1.
TEST_F(VolumeTransferTest, AStepHasTheOutlineOfItsIsosurface) {
  const volume::SparseVolume radial =
      values({4, 4, 4}, [](glm::vec3 p) { return std::max(1 - glm::length(p - 16.0f) / 16, 0.0f); });
  add(radial, 200).transfer = {{{0, 0}, {0.5f, 0}, {0.5f, 1}, {1, 1}}, {}, {0, 1}, 0, 1};
  const auto pixels = draw();
  // Trilinear filtering of r, whose second derivative is 1 / r, is off by h^2 / 4 / r at most, h = 1/8 m:
  // 0.004 m. A step of 1/8 m that grazes the ball begins at r, and is opaque from a chord of 0.04 m on.
  int inside = 0, outside = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double r = glm::length(place_of(i));
    if (r < 0.985) {
      EXPECT_LT(pixels[i].w, 0.01f) << r;
      ++inside;
    }
    if (r > 1.015) {
      EXPECT_EQ(pixels[i].w, 1) << r;
      ++outside;
    }
  }
  EXPECT_GT(inside, 180);
  EXPECT_GT(outside, 1000);
}

TEST_F(VolumeTransferTest, TheIdentityChangesNothing) {
  const volume::SparseVolume ramp =
      values({2, 2, 2}, [](glm::vec3 p) { return std::clamp(0.1f + p.z / 40 + p.x / 40, 0.0f, 1.0f); });
  input_.environment = daylight();
  add(ramp, 0.8f).look.albedo = glm::vec3(0.9f, 0.7f, 0.5f);
  const auto plain = draw();
  input_.volumes[0].transfer.opacity = {{0, 0}, {1, 1}};
  const auto identity = draw();
  input_.volumes[0].transfer = {};
  input_.volumes[0].transfer.color_map.points = {{0, {0.9f, 0.7f, 0.5f}}, {1, {0.9f, 0.7f, 0.5f}}};
  const auto constant = draw();
  for (std::size_t i = 0; i < plain.size(); ++i) {
    // Half floats, and light that is rounded to them before and after the albedo.
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(identity[i][k], plain[i][k], 0.003f) << i << " " << k;
      EXPECT_NEAR(constant[i][k], plain[i][k], 0.003f) << i << " " << k;
    }
  }
}

// Sun, light, sky, and the shadow on the floor: where a curve says 0.3, all is as with a density of 0.3.
TEST_F(VolumeTransferTest, LightAndShadowsFollowTheCurve) {
  input_.view.camera = {{5, 4, 8}, {0, -2.5f, 0}, 1.2f};
  input_.view.exposure = 0.3f;
  input_.environment = daylight();
  const volume::SparseVolume value = block({2, 2, 2}, 0.7f), density = block({2, 2, 2}, 0.3f);
  const auto draw_both = [&] {
    std::pair<std::vector<glm::vec4>, std::vector<glm::u8vec4>> result;
    result.first = draw();
    result.second = read_back<glm::u8vec4>(renderer().targets().display);
    return result;
  };
  add(density, 1.5f).look.albedo = glm::vec3(0.8f, 0.6f, 0.9f);
  const auto expected = draw_both();
  input_.volumes.clear();
  planning::VolumeInput& volume = add(value, 1.5f);
  volume.look.albedo = glm::vec3(0.8f, 0.6f, 0.9f);
  volume.transfer.opacity = {{0, 1}, {0.6f, 0.3f}, {0.9f, 0.3f}, {1, 0}};
  const auto seen = draw_both();
  volume.transfer.opacity = {{0, 0}, {1, 0}};
  const auto nothing = draw_both();
  int lit = 0, shadowed = 0;
  for (std::size_t i = 0; i < expected.first.size(); ++i) {
    // Half floats, and light that is rounded to them before and after the albedo.
    EXPECT_NEAR(seen.first[i].w, expected.first[i].w, 0.003f) << i;
    EXPECT_NEAR(seen.first[i].y, expected.first[i].y, 0.003f) << i;
    EXPECT_EQ(nothing.first[i], glm::vec4(0, 0, 0, 1)) << i;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(int{seen.second[i][k]}, int{expected.second[i][k]}, 1) << i;
    lit += expected.first[i].y > 0.2f;
    shadowed += expected.first[i].w == 1 && nothing.second[i].g > expected.second[i].g + 10;
  }
  EXPECT_GT(lit, 100);
  EXPECT_GT(shadowed, 50) << "pixels of the floor";
}

TEST_F(VolumeTransferTest, UnlitColoursAreEmitted) {
  const volume::SparseVolume slab = block({2, 2, 2}, 0.5f);
  input_.environment = daylight();
  planning::VolumeInput& volume = add(slab, 40);
  volume.transfer.color_map.points = {{0, {1, 0, 0}}, {0.5f, {0.25f, 0.5f, 0.75f}}, {1, {0, 0, 1}}};
  volume.transfer.glow = 1;
  volume.transfer.emission = 2;
  const auto pixels = draw();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!is_inside(i, 0.2)) continue;
    EXPECT_NEAR(pixels[i].y, 1.0f, 2e-3f) << i;
    EXPECT_NEAR(pixels[i].z, 1.5f, 2e-3f) << i;
  }
}

TEST_F(VolumeTransferTest, AGridOfOneColourMultipliesTheAlbedo) {
  const volume::SparseVolume slab = block({2, 2, 2}, 0.5f);
  const glm::vec3 tint(0.5f, 0.25f, 1);
  const auto colored = [&](glm::vec3 low, glm::vec3 high) {
    return field<std::uint64_t>(
        {2, 2, 2}, [&](glm::vec3 p) { return glm::packHalf4x16(glm::vec4(p.x < 8 ? low : high, 1)); });
  };
  const volume::SparseVolume one = colored(tint, tint), two = colored({1, 0, 0}, {0, 0, 1});
  input_.environment = daylight();
  add(slab, 1).look.albedo = glm::vec3(0.9f) * tint;
  const auto expected = draw();
  input_.volumes[0].look.albedo = glm::vec3(0.9f);
  input_.volumes[0].colors = &one;
  const auto seen = draw();
  input_.volumes[0].colors = &two;
  const auto halves = draw();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(seen[i][k], expected[i][k], 0.003f) << i;
    EXPECT_EQ(halves[i].w, expected[i].w);
    if (!is_inside(i, 0.1) || std::abs(place_of(i).x) < 0.3) continue;
    const bool left = place_of(i).x < 0;
    EXPECT_GT(halves[i][left ? 0 : 2], 0.1f) << i;
    EXPECT_LT(halves[i][left ? 2 : 0], 1e-3f) << i;
  }
}

// The path of several volumes in one brick agrees with that of one.
TEST_F(VolumeTransferTest, SecondVolumesHaveFunctionsOfTheirOwn) {
  const volume::SparseVolume ramp = values({2, 2, 2}, [](glm::vec3 p) { return std::max(p.z / 16, 0.0f); });
  const volume::SparseVolume empty = block({2, 2, 2}, 0.5f);
  const planning::TransferInput peak{{{0.4f, 0}, {0.42f, 1}, {0.5f, 0}}, {"viridis", {}}, {0, 1}, 0.5f, 1};
  input_.environment = daylight();
  add(ramp, 20).transfer = peak;
  const auto alone = draw();
  input_.volumes.clear();
  add(empty, 0);
  add(ramp, 20).transfer = peak;
  const auto second = draw();
  int dense = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(second[i][k], alone[i][k], 0.004f) << i;
    dense += alone[i].w < 0.5f;
  }
  EXPECT_GT(dense, 500);
}

}  // namespace
}  // namespace brume::render
