// Masks of a volume that glow in a tint each, and noise that moves the places at which they are sampled.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

/// Four masks that are constant, or linear in the place.
volume::SparseVolume masks(glm::ivec3 bricks, glm::vec4 (*value_at)(glm::vec3)) {
  return field<std::uint64_t>(bricks, [&](glm::vec3 p) { return glm::packHalf4x16(value_at(p)); });
}

/// The first two of them, as volumes of up to two masks have them.
volume::SparseVolume pair(glm::ivec3 bricks, glm::vec4 (*value_at)(glm::vec3)) {
  return field<std::uint32_t>(bricks, [&](glm::vec3 p) { return glm::packHalf2x16(glm::vec2(value_at(p))); });
}

class VolumeMasksTest : public VolumePictures<VolumeMasksTest> {
 public:
  static constexpr glm::uvec2 kSize{61, 37};

 protected:
  VolumeMasksTest() { input_.view.camera = {{0, 0, 9}, {0, 0, 0}, 0.9f}; }
  /// A block of 2 m around the origin that only glows.
  planning::VolumeInput glowing(const volume::SparseVolume& presence, const volume::SparseVolume& colors,
                                std::vector<glm::vec3> tints) const {
    planning::VolumeInput volume;
    volume.volume = &presence;
    volume.colors = &colors;
    volume.tints = std::move(tints);
    volume.look.extinction = 0;
    const float voxel = 2 / presence.layout().bounds_max.x;
    volume.world_from_voxel = glm::scale(glm::translate(glm::mat4(1), glm::vec3(-1)), glm::vec3(voxel));
    return volume;
  }
  glm::vec4 middle(const std::vector<glm::vec4>& pixels) const {
    return pixels[kSize.x / 2 + kSize.x * (kSize.y / 2)];
  }
};

// The ray through the middle of the image runs along -z through 2 m: each metre adds the sum of tint times
// mask.
TEST_F(VolumeMasksTest, EachMaskGlowsInItsTint) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const auto constant = [](glm::vec3) { return glm::vec4(1, 0.5, 0.25, 0.125); };
  const volume::SparseVolume all = masks(glm::ivec3(2), constant), two = pair(glm::ivec3(2), constant);
  const std::vector<glm::vec3> tints{{1, 0, 0}, {0, 2, 0}, {0, 0, 4}, {8, 8, 8}};
  for (std::size_t count = 1; count <= 4; ++count) {
    input_.volumes = {glowing(presence, count > 2 ? all : two,
                              {tints.begin(), tints.begin() + static_cast<std::ptrdiff_t>(count)})};
    const std::vector<glm::vec4> pixels = draw();
    glm::vec3 expected(0);
    for (std::size_t i = 0; i < count; ++i) expected += 2.0f * tints[i] * (1.0f / static_cast<float>(1 << i));
    // A ray has 8 steps of two voxels inside; a sample may miss half a step at each end. Half floats: 1/1024.
    const glm::vec4 found = middle(pixels);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(found[channel], expected[channel], (1.0f / 8 + 1.0f / 1024) * expected[channel]) << count;
    EXPECT_EQ(found.a, 1) << "it dims nothing";
    EXPECT_EQ(pixels.front(), glm::vec4(0, 0, 0, 1)) << "beside it";
  }
}

// All that reaches an image from a volume without extinction is its integral, however the masks are
// distributed.
TEST_F(VolumeMasksTest, LinearMasksAddUp) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume colors =
      pair(glm::ivec3(2), [](glm::vec3 p) { return glm::vec4(p.z / 16, 1 - p.z / 16, 0, 0); });
  input_.volumes = {glowing(presence, colors, {{3, 0, 0}, {0, 3, 0}})};
  const glm::vec4 found = middle(draw());
  EXPECT_NEAR(found.r, 3, 3 * (1.0 / 8 + 1.0 / 1024));
  EXPECT_NEAR(found.g, 3, 3 * (1.0 / 8 + 1.0 / 1024));
  EXPECT_EQ(found.b, 0);
}

// With an extinction the glow is dimmed by what lies before it: (1 - exp(-x)) / x of its length.
TEST_F(VolumeMasksTest, ExtinctionDimsTheGlow) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume colors = pair(glm::ivec3(2), [](glm::vec3) { return glm::vec4(1, 0, 0, 0); });
  planning::VolumeInput volume = glowing(presence, colors, {{1, 1, 1}});
  volume.look.extinction = 1.5f;
  input_.volumes = {volume};
  const glm::vec4 found = middle(draw());
  // Half a step at each end is 1/16 of the length, and as much of both.
  EXPECT_NEAR(found.a, std::exp(-3.0), std::exp(-3.0) * (std::exp(3.0 / 16) - 1));
  EXPECT_NEAR(found.r, (1 - std::exp(-3.0)) / 1.5, 1.0 / 16 + 1e-3);
}

// The same as one volume of one mask each, drawn by the shader of several volumes.
TEST_F(VolumeMasksTest, SeveralVolumesAddUp) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume red = pair(glm::ivec3(2), [](glm::vec3) { return glm::vec4(1, 0, 0, 0); });
  const volume::SparseVolume ramp =
      pair(glm::ivec3(2), [](glm::vec3 p) { return glm::vec4(0, p.x / 16, 0, 0); });
  input_.volumes = {glowing(presence, red, {{1, 0, 0}})};
  const std::vector<glm::vec4> first = draw();
  input_.volumes = {glowing(presence, ramp, {{0, 0, 0}, {0, 1, 0}})};
  const std::vector<glm::vec4> second = draw();
  input_.volumes = {glowing(presence, red, {{1, 0, 0}}), glowing(presence, ramp, {{0, 0, 0}, {0, 1, 0}})};
  const std::vector<glm::vec4> both = draw();
  for (std::size_t i = 0; i < both.size(); ++i) {
    // Samples of the same places, rounded to half floats once instead of twice.
    EXPECT_NEAR(both[i].r, first[i].r, 2e-3 * std::max(first[i].r, 0.1f));
    EXPECT_NEAR(both[i].g, second[i].g, 2e-3 * std::max(second[i].g, 0.1f));
  }
}

class DisturbedVolumeTest : public VolumeMasksTest {
 protected:
  planning::VolumeInput disturbed(const volume::SparseVolume& presence, const volume::SparseVolume& colors,
                                  const scene::Disturbance& noise, float time = 0.3f) const {
    planning::VolumeInput volume = glowing(presence, colors, {{1, 1, 1}});
    // The file's units are metres.
    volume.disturbance = {glm::inverse(volume.world_from_voxel), noise, time};
    return volume;
  }
};

// Deep inside of a constant field it does not matter where it is sampled.
TEST_F(DisturbedVolumeTest, IsTheSameWhereNothingVaries) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume colors = pair(glm::ivec3(2), [](glm::vec3) { return glm::vec4(1, 0, 0, 0); });
  input_.volumes = {disturbed(presence, colors, {0.25f, 0.5f, {0, 1, 0}, 0})};
  const glm::vec4 found = middle(draw());
  // Only at both ends, up to the strength, some samples are inside or outside that were not.
  EXPECT_NEAR(found.r, 2, 2 * 0.25 + 2.0 / 8 + 2e-3);
  EXPECT_GT(found.r, 0.5);
}

// Nothing is farther from the volume than the strength; time moves the noise, and no time stands still.
TEST_F(DisturbedVolumeTest, ReachesNoFartherThanItsStrength) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume colors = pair(glm::ivec3(2), [](glm::vec3) { return glm::vec4(1, 0, 0, 0); });
  const scene::Disturbance noise{0.3f, 0.4f, {0, 2, 0}, 0};
  input_.volumes = {disturbed(presence, colors, noise, 0)};
  const std::vector<glm::vec4> first = draw();
  const shared::Camera camera = planning::FramePlan(input_, kSize).camera;
  std::size_t beyond = 0;
  for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
    const glm::vec2 ndc = (glm::vec2(i % kSize.x, i / kSize.x) + 0.5f) / glm::vec2(kSize) * 2.0f - 1.0f;
    const glm::vec3 ray = camera.forward + ndc.x * camera.right - ndc.y * camera.up;
    // Where the ray passes the front side of the volume, grown by the strength, and the back side.
    const glm::vec2 near = glm::vec2(ray) * (9 - 1.3f), far = glm::vec2(ray) * (9 + 1.3f);
    const auto outside = [](glm::vec2 p) { return std::max(std::abs(p.x), std::abs(p.y)) > 1.3f; };
    if (outside(near) && outside(far)) {
      EXPECT_EQ(first[i], glm::vec4(0, 0, 0, 1)) << i;
    }
    // On the image the front side, 8 m away, is the widest part of the volume as it is.
    const glm::vec2 front = glm::vec2(ray) * 8.0f;
    const bool is_beyond = std::max(std::abs(front.x), std::abs(front.y)) > 1.02f;
    if (is_beyond && first[i].r > 0) ++beyond;
  }
  EXPECT_GT(beyond, 0u) << "it does reach out";
  input_.volumes = {disturbed(presence, colors, noise, 0)};
  EXPECT_EQ(draw(), first);
  input_.volumes = {disturbed(presence, colors, noise, 0.05f)};
  EXPECT_NE(draw(), first);
}

// A flame stays at its nozzle: where the drift comes from, nothing moves.
TEST_F(DisturbedVolumeTest, GrowsAlongItsDrift) {
  const volume::SparseVolume presence = block(glm::ivec3(2));
  const volume::SparseVolume colors =
      pair(glm::ivec3(2), [](glm::vec3 p) { return glm::vec4(p.x > 8 ? 1 : 0, 0, 0, 0); });
  input_.volumes = {disturbed(presence, colors, {0.3f, 0.4f, {0, 1, 0}, 2.0f})};
  const std::vector<glm::vec4> moved = draw();
  input_.volumes = {glowing(presence, colors, {{1, 1, 1}})};
  const std::vector<glm::vec4> still = draw();
  // Rows of pixels whose rays pass the lowest and the highest eighth of the volume.
  const auto difference = [&](std::uint32_t row) {
    double sum = 0;
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = x + std::size_t{kSize.x} * row;
      sum += std::abs(double{moved[i].r} - double{still[i].r});
    }
    return sum;
  };
  const auto row_of = [](float y) {
    return static_cast<std::uint32_t>((0.5f - 0.5f * y / (9 * std::tan(0.45f))) * kSize.y);
  };
  EXPECT_LT(3 * difference(row_of(-0.85f)), difference(row_of(0.85f)));
}

}  // namespace
}  // namespace brume::render
