// The exported shader functions, shaders/export/volume_projection, in GLSL and in HLSL: against a model in
// double precision, and against 3D textures that the device filters.
//
// Bounds. Operations of floats round by kEps of their result, divisions by five times that (2.5 ulp,
// "Precision of Core SPIR-V Instructions" in the Vulkan specification). W is the edge of the atlas [texels].
//
// A UV is off by less than 11 W kEps texels: 3.5 n kEps from the position in a tile of n texels (a quotient
// of at most 1/2, a sum of at most 1), n kEps from its product with n, W kEps from the sum with the place of
// the tile, 5 W kEps from the quotient. The filter multiplies by W and subtracts 1/2: 2 W kEps more. A blend
// mask is off by less than 6 N kEps for N slices: 3.5 N, the product N, the difference N.
//
// A filter may round or truncate the weight along each axis to subTexelPrecisionBits: off by a step of less
// than 2^-bits. Bytes may also be filtered in 8 bits, each interpolation off by less than 1/255 (llvmpipe
// does so): two of them in 2D, three in 3D. A value changes per axis by no more than its weight, times the
// range r of the texels. A sample of the atlas is therefore within r (2 steps) of the model. From the 3D
// texture, whose third weight is the filter's too, it differs by r (3 steps): positions along u and v are the
// same, but may lie on both sides of where the filter changes from one step to the next. With 8 bits, that is
// 3/256 for the full range, and 1/255 or less only for a third of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "tests/passes/volume_projection_fixture.hpp"
#include "tests/sanitized.hpp"

namespace brume::passes {
namespace {

constexpr double kEps = 1.0 / (1 << 24);
constexpr std::size_t kPoints = kSanitized ? 10'000 : 100'000;

class VolumeProjectionTest : public VolumeProjectionFixture {
 protected:
  /// All tile counts, as strips, nearly squares with an incomplete last row, and columns.
  static std::vector<Case> cases() {
    glm::mat4 turned = glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(1, 2, -0.5f)));
    turned = glm::rotate(turned, 2.1f, glm::vec3(0, 0, 1));
    const std::array places{Place{}, Place{{6, 1.5f, 12}, {-3, 4, 0.25f}, glm::mat3(1)},
                            Place{{0.8f, 2, 1.25f}, {10, -2, 5}, glm::mat3(turned)}};
    const std::array<glm::ivec2, 4> sizes{{{16, 16}, {12, 20}, {33, 9}, {1, 5}}};
    const std::array paddings{0, 1, 4};
    std::vector<Case> cases;
    for (const int count : {1, 2, 7, 32, 64})
      for (const int columns : {count, static_cast<int>(std::ceil(std::sqrt(count))), 1}) {
        const std::size_t i = cases.size();
        cases.push_back({{sizes[i % 4], paddings[i % 3], count, columns}, places[i / 2 % 3]});
      }
    return cases;
  }

  static double step() {
    return std::ldexp(1.0, -static_cast<int>(context().limits().subTexelPrecisionBits));
  }
  static glm::dvec2 uv_error(const SliceAtlas& atlas) { return 11 * kEps * glm::dvec2(atlas.size()); }
  static double blend_error(const SliceAtlas& atlas) { return 6 * kEps * atlas.tile_count; }
  /// By how much the weights of the axes of the atlas differ from the exact ones.
  static double weight_error(const SliceAtlas& atlas) {
    const glm::dvec2 uv = uv_error(atlas) + 2 * kEps * glm::dvec2(atlas.size());
    return 2 * step() + uv.x + uv.y + blend_error(atlas);
  }

  void expect_positions(const Place& place, const std::vector<glm::vec4>& points,
                        const std::vector<ProjectionOutcome>& outcomes);
  void expect_uvs(const Case& one, const std::vector<ProjectionOutcome>& outcomes);
  struct Difference {
    double worst = 0, bound = 0;
    int beyond_a_byte = 0;  ///< Points where it is more than 1/255.
  };
  /// Checks all outputs with random texels of this range around 1/2. Returns the difference from the 3D
  /// texture.
  template <typename Texel>
  Difference expect_values(const Case& one, float range);

  static glm::dvec3 uvw_of(const Place& place, const ProjectionOutcome& outcome) {
    return glm::dvec3(outcome.adjusted_position) / glm::dvec3(place.dimensions) + 0.5;
  }
  static double largest(glm::dvec4 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
  }
};

// The difference from the centre and three products, and two sums: 4 roundings of at most the distance.
void VolumeProjectionTest::expect_positions(const Place& place, const std::vector<glm::vec4>& points,
                                            const std::vector<ProjectionOutcome>& outcomes) {
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec3& adjusted = outcomes[i].adjusted_position;
    const glm::dvec3 away = glm::dvec3(points[i]) - glm::dvec3(place.center);
    for (int axis = 0; axis < 3 && glm::length(away) < 1e9; ++axis)
      ASSERT_NEAR(adjusted[axis], glm::dot(away, glm::dvec3(place.axes[axis])), 5 * kEps * glm::length(away));
    const bool is_inside = glm::all(glm::lessThanEqual(glm::abs(adjusted), 0.5f * place.dimensions));
    ASSERT_EQ(outcomes[i].volume_mask, is_inside ? 1.0f : 0.0f) << i;
    ASSERT_TRUE(is_inside || outcomes[i].value == glm::vec4(0)) << i;
    inside += is_inside;
  }
  const auto count = static_cast<int>(points.size());
  EXPECT_GT(inside, count / 2);
  EXPECT_LT(inside, count * 9 / 10);
}

void VolumeProjectionTest::expect_uvs(const Case& one, const std::vector<ProjectionOutcome>& outcomes) {
  const SliceAtlas& atlas = one.atlas;
  const glm::dvec2 size(atlas.size()), tile_size(atlas.tile_texels), error = uv_error(atlas);
  std::vector<glm::dvec2> first;
  for (int tile = 0; tile < atlas.tile_count; ++tile) first.emplace_back(atlas.first_texel(tile));

  for (const ProjectionOutcome& outcome : outcomes) {
    const glm::dvec3 uvw = uvw_of(one.place, outcome);
    const glm::dvec2 texel = glm::clamp(glm::dvec2(uvw) * tile_size, glm::dvec2(0.5), tile_size - 0.5);
    ASSERT_GE(outcome.blend_mask, 0);
    ASSERT_LT(outcome.blend_mask, 1);
    // The tiles that the UVs are in, and what they contribute.
    std::array<int, 2> tiles{-1, -1};
    for (std::size_t k = 0; k < 2; ++k) {
      const glm::dvec2 at =
          size * glm::dvec2(k == 0 ? glm::vec2(outcome.uvs) : glm::vec2(outcome.uvs.z, outcome.uvs.w));
      for (int tile = 0; tile < atlas.tile_count; ++tile) {
        const glm::dvec2 in_tile = at - first[static_cast<std::size_t>(tile)];
        if (in_tile.x < 0 || in_tile.y < 0 || in_tile.x > tile_size.x || in_tile.y > tile_size.y) continue;
        tiles[k] = tile;
        ASSERT_NEAR(in_tile.x, texel.x, error.x) << one.name();
        ASSERT_NEAR(in_tile.y, texel.y, error.y) << one.name();
      }
      ASSERT_GE(tiles[k], 0) << one.name() << ": a UV outside of the tiles, at " << at.x << "," << at.y;
    }
    const double second = double{outcome.blend_mask};
    for (int tile = 0; tile < atlas.tile_count; ++tile) {
      const double weight = (tile == tiles[0] ? 1 - second : 0) + (tile == tiles[1] ? second : 0);
      ASSERT_NEAR(weight, atlas.weight(tile, uvw.z), blend_error(atlas)) << one.name() << ", tile " << tile;
    }
  }
}

template <typename Texel>
VolumeProjectionTest::Difference VolumeProjectionTest::expect_values(const Case& one, float range) {
  SCOPED_TRACE(one.name() + ", range " + std::to_string(range));
  const bool bytes = sizeof(Texel) == sizeof(Byte4);
  const glm::ivec3 size(one.atlas.tile_texels, one.atlas.tile_count);
  const auto content = random_content<Texel>(size, 0.5f - range / 2, 0.5f + range / 2);
  const gpu::Image volume = upload_texels(content.texels, glm::uvec3(size), true);
  const gpu::Image atlas = upload_atlas(content, one.atlas);
  const auto at = points(one, kPoints);
  const gpu::Buffer positions = upload(at);
  const auto outcomes = project(glsl_, one, positions, at.size(), atlas);
  const auto filtered_by_device = filtered(volume, at.size());
  const auto of_hlsl = project(hlsl_, one, positions, at.size(), atlas);

  expect_positions(one.place, at, outcomes);
  expect_uvs(one, outcomes);
  // One compiler makes the same list of operations of both languages.
  EXPECT_EQ(std::memcmp(outcomes.data(), of_hlsl.data(), outcomes.size() * sizeof outcomes[0]), 0);

  const double r = double{range} + (bytes ? 1 / 255.0 : 1 / 2048.0);  // after rounding to a texel
  const double model_bound = r * weight_error(one.atlas) + (bytes ? 2 / 255.0 : 1e-6);
  Difference found;
  found.bound = r * (2 * weight_error(one.atlas) - step()) + (bytes ? 5 / 255.0 : 1e-6);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (outcomes[i].volume_mask == 0) continue;
    const glm::dvec4 value(outcomes[i].value);
    EXPECT_LT(largest(value - content.volume.sample(uvw_of(one.place, outcomes[i]))), model_bound) << i;
    const double difference = largest(value - glm::dvec4(filtered_by_device[i]));
    found.worst = std::max(found.worst, difference);
    found.beyond_a_byte += difference > 1 / 255.0;
  }
  EXPECT_LT(found.worst, found.bound);
  return found;
}

TEST_F(VolumeProjectionTest, EqualsTexturesOfHalves) {
  double worst = 0;
  for (const Case& one : cases()) worst = std::max(worst, expect_values<Half4>(one, 1).worst);
  RecordProperty("worst_of_255", std::to_string(255 * worst));
}

TEST_F(VolumeProjectionTest, EqualsTexturesOfBytes) {
  double worst = 0;
  int beyond_a_byte = 0;
  for (const Case& one : cases()) {
    const Difference found = expect_values<Byte4>(one, 1);
    worst = std::max(worst, found.worst);
    beyond_a_byte = std::max(beyond_a_byte, found.beyond_a_byte);
  }
  RecordProperty("worst_of_255", std::to_string(255 * worst));
  RecordProperty("most_points_beyond_1_of_255", std::to_string(beyond_a_byte));
}

// The bound grows with the range of the texels: for a fifth of the full range it is below a step of 8-bit
// images.
TEST_F(VolumeProjectionTest, IsWithinAByteForSmoothContents) {
  if (step() > 1 / 256.0) GTEST_SKIP() << "the device filters with fewer than 8 bits";
  for (const Case& one : cases()) EXPECT_LT(expect_values<Half4>(one, 0.2f).bound, 1 / 255.0) << one.name();
}

// Level 1 of an atlas whose padding of two texels mirrors the tiles, made by averaging 2 x 2 texels of the
// whole image, against a 3D texture of half the texels along u and v. Sums of four values of 8 bits are exact
// in halves.
TEST_F(VolumeProjectionTest, SamplesMipLevels) {
  const Case one{{{16, 12}, 2, 7, 3}, {{2, 1, 3}, {0.5f, 0, -1}, glm::mat3(1)}};
  const glm::ivec3 size(one.atlas.tile_texels, one.atlas.tile_count),
      half_size(size.x / 2, size.y / 2, size.z);
  auto content = random_content<Half4>(size, 0, 1);
  for (std::size_t i = 0; i < content.texels.size(); ++i) {
    set_texel(content.texels[i], glm::round(256.0f * glm::vec4(content.volume.texels[i])) / 256.0f);
    content.volume.texels[i] = value_of(content.texels[i]);
  }
  TexelVolume half{half_size, {}};
  std::vector<Half4> half_texels;
  for (int z = 0; z < half_size.z; ++z)
    for (int y = 0; y < half_size.y; ++y)
      for (int x = 0; x < half_size.x; ++x) {
        glm::dvec4 sum(0);
        for (const glm::ivec2 k : {glm::ivec2(0), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1)})
          sum += content.volume.at({2 * x + k.x, 2 * y + k.y, z});
        half.texels.push_back(sum / 4.0);
        set_texel(half_texels.emplace_back(), glm::vec4(half.texels.back()));
      }

  const gpu::Image atlas = upload_atlas(content, one.atlas, 2);
  const gpu::Image volume = upload_texels(half_texels, glm::uvec3(half_size), true);
  const auto at = points(one, kPoints);
  const gpu::Buffer positions = upload(at);
  const double bound = weight_error(one.atlas) + 1e-6;
  for (const gpu::ComputePipeline* probe : {&glsl_, &hlsl_}) {
    const auto level_0 = project(*probe, one, positions, at.size(), atlas, 0);
    const auto level_1 = project(*probe, one, positions, at.size(), atlas, 1);
    const auto filtered_by_device = filtered(volume, at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (level_1[i].volume_mask == 0) continue;
      const glm::dvec3 uvw = uvw_of(one.place, level_1[i]);
      const glm::dvec4 value(level_1[i].value);
      ASSERT_LT(largest(glm::dvec4(level_0[i].value) - content.volume.sample(uvw)), bound) << i;
      ASSERT_LT(largest(value - half.sample(uvw)), bound) << i;
      ASSERT_LT(largest(value - glm::dvec4(filtered_by_device[i])), 2 * bound) << i;
    }
  }
}

}  // namespace
}  // namespace brume::passes
