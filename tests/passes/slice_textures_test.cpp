// Volumes as slices of one image: against a model in double precision, and whatever the others hold.
#include "passes/slice_textures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "brume_test_shaders.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/passes/probes.h"
#include "tests/reference/slice_atlas.hpp"

namespace brume::passes {
namespace {

constexpr double kFloatEps = 1.0 / (1 << 24);

using Channels = std::vector<grids::DenseGrid>;

struct SizedVolume {
  glm::uvec3 size;
  std::size_t channels;
};

/// Single voxels, planes, lines, odd sizes, and a volume larger than the others together.
const std::vector<SizedVolume>& awkward_volumes() {
  static const std::vector<SizedVolume> volumes{{{1, 1, 1}, 1},  {{7, 1, 3}, 4},    {{33, 17, 5}, 2},
                                                {{2, 9, 31}, 3}, {{64, 64, 32}, 2}, {{1, 5, 64}, 4},
                                                {{12, 3, 1}, 1}, {{5, 40, 2}, 4}};
  return volumes;
}

class SliceTexturesTest : public gpu::GpuTest {
 protected:
  template <typename Value>
  static Channels channels_of(const SizedVolume& volume, Value value) {
    Channels channels(volume.channels);
    for (grids::DenseGrid& channel : channels) {
      channel.name = "mask";
      channel.size = volume.size;
      channel.values.resize(std::size_t{volume.size.x} * volume.size.y * volume.size.z);
      for (float& texel : channel.values) texel = value();
    }
    return channels;
  }
  Channels random_channels(const SizedVolume& volume) {
    std::uniform_real_distribution<float> value(0, 1);
    return channels_of(volume, [&] { return value(random_); });
  }

  static Result<SliceTextures> pack(const std::vector<Channels>& volumes) {
    const std::vector<std::span<const grids::DenseGrid>> lists(volumes.begin(), volumes.end());
    return SliceTextures::create(context(), runner(), lists);
  }
  /// The volume with its values as half floats hold them.
  static reference::TexelVolume model_of(const Channels& channels) {
    reference::TexelVolume model{glm::ivec3(channels[0].size), {}};
    for (std::size_t i = 0; i < channels[0].values.size(); ++i) {
      glm::vec4 value(0);
      for (std::size_t c = 0; c < channels.size(); ++c) value[static_cast<int>(c)] = channels[c].values[i];
      model.texels.emplace_back(from_half(to_half(value)));
    }
    return model;
  }

  /// Inside of the box, on its faces, edges and corners, at centres of voxels, and outside.
  std::vector<glm::vec4> points_in(glm::uvec3 size, std::size_t count) {
    std::uniform_real_distribution<float> near_box(-0.1f, 1.1f);
    std::vector<glm::vec4> points;
    for (std::size_t i = 0; i < count; ++i) {
      glm::vec3 at(near_box(random_), near_box(random_), near_box(random_));
      for (int axis = 0; axis < 3 && i % 3 == 0; ++axis) {
        const float voxel = static_cast<float>(random_() % size[axis]) + 0.5f;
        const std::array<float, 4> special{0, 1, 1.000001f, voxel / static_cast<float>(size[axis])};
        at[axis] = special[random_() % special.size()];
      }
      points.emplace_back(at, 0);
    }
    return points;
  }
  std::vector<glm::vec4> sample(const SliceTextures& textures, std::size_t volume,
                                const std::vector<glm::vec4>& points) {
    const gpu::Buffer in = upload(points);
    const gpu::Buffer out(context(), points.size() * sizeof(glm::vec4),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe_,
                    {{shared::kBindSliceTextures, gpu::sampled(textures.image(), sampler_)},
                     {shared::kBindProbeIn, gpu::read(in)},
                     {shared::kBindProbeOut, gpu::write(out)}},
                    textures[volume]);
      recorder.dispatch_threads(probe_, static_cast<std::uint32_t>(points.size()));
    });
    return read_back<glm::vec4>(out, points.size());
  }

  /// By how much the weights of the texels may differ from the exact ones. The bounds of
  /// volume_projection_test.cpp hold in an image of w texels of this volume alone: 11 w kFloatEps for its uv,
  /// 6 N kFloatEps for the blend of N slices, two steps of the filter. Added here: the rounding of uvw - 1/2
  /// (1/2 kFloatEps, of n or N texels); that of uv_size and the product with it (2 w), of uv_first and the
  /// sum with it (2 W), for an image of W texels, whose filter rounds 2 W more.
  static double weight_error(const SliceTextures& textures, const shared::SliceTexture& volume) {
    const double step = std::ldexp(1.0, -static_cast<int>(context().limits().subTexelPrecisionBits));
    const glm::dvec2 whole(glm::uvec2(textures.image().info().size));
    const glm::dvec2 own = whole * glm::dvec2(volume.uv_size);
    const glm::dvec2 uv = kFloatEps * (13.5 * own + 4.0 * whole);
    return 2 * step + uv.x + uv.y + 6.5 * kFloatEps * double{volume.tile_count};
  }

  std::mt19937 random_{99};
  gpu::ComputePipeline probe_{context(), shaders::slice_texture_probe_comp};
  gpu::Sampler sampler_{context(), {}};
};

// The weights are those of values in [0, 1], of which none differs from another by more than 1. The blend of
// two fetches rounds values of at most 1 three times, the filter's own sums a few times more: 1e-6.
TEST_F(SliceTexturesTest, EqualATrilinearModel) {
  std::vector<Channels> volumes;
  for (const SizedVolume& volume : awkward_volumes()) volumes.push_back(random_channels(volume));
  const SliceTextures textures = pack(volumes).value_or_throw();
  ASSERT_EQ(textures.size(), volumes.size());
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    const reference::TexelVolume model = model_of(volumes[v]);
    const std::vector<glm::vec4> points = points_in(awkward_volumes()[v].size, 5000);
    const std::vector<glm::vec4> values = sample(textures, v, points);
    const double bound = weight_error(textures, textures[v]) + 1e-6;
    ASSERT_LT(bound, 0.02);
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 uvw(points[i]);
      const bool is_inside = glm::all(glm::greaterThanEqual(uvw, glm::dvec3(0))) &&
                             glm::all(glm::lessThanEqual(uvw, glm::dvec3(1)));
      // As close to a face as uvw - 1/2 rounds, a point may be on either side.
      const glm::dvec3 from_face = glm::min(glm::abs(uvw), glm::abs(uvw - 1.0));
      if (!is_inside && std::min({from_face.x, from_face.y, from_face.z}) < kFloatEps) continue;
      inside += is_inside;
      const glm::dvec4 expected = is_inside ? model.sample(uvw) : glm::dvec4(0);
      for (int channel = 0; channel < 4; ++channel)
        ASSERT_NEAR(values[i][channel], expected[channel], is_inside ? bound : 0.0)
            << "volume " << v << ", point " << i << ", channel " << channel;
    }
    EXPECT_GT(inside, 1000);
  }
}

TEST_F(SliceTexturesTest, NeverBleedIntoEachOther) {
  std::vector<Channels> volumes, bright;
  for (const SizedVolume& volume : awkward_volumes()) {
    volumes.push_back(random_channels(volume));
    bright.push_back(channels_of({volume.size, 4}, [] { return 65504.0f; }));
  }
  const SliceTextures plain = pack(volumes).value_or_throw();
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    std::vector<Channels> among_bright = bright;
    among_bright[v] = volumes[v];
    const SliceTextures other = pack(among_bright).value_or_throw();
    const std::vector<glm::vec4> points = points_in(awkward_volumes()[v].size, 5000);
    EXPECT_EQ(sample(plain, v, points), sample(other, v, points)) << "volume " << v;
  }
}

TEST_F(SliceTexturesTest, StoreWhatHalvesCannotAsTheNearest) {
  Channels channels = channels_of({{4, 1, 1}, 1}, [] { return 0.0f; });
  channels[0].values = {1e9f, -1e9f, std::numeric_limits<float>::quiet_NaN(), 0.5f};
  const SliceTextures textures = pack({channels}).value_or_throw();
  const std::vector<glm::vec4> values =
      sample(textures, 0, {{0.125f, 0, 0, 0}, {0.375f, 0, 0, 0}, {0.625f, 0, 0, 0}, {0.875f, 0, 0, 0}});
  const std::vector<glm::vec4> expected{{65504, 0, 0, 0}, {-65504, 0, 0, 0}, {0, 0, 0, 0}, {0.5f, 0, 0, 0}};
  EXPECT_EQ(values, expected);
}

TEST_F(SliceTexturesTest, WithoutVolumesThereIsAnImage) {
  EXPECT_EQ(pack({}).value_or_throw().image().info().size, glm::uvec3(1));
  EXPECT_EQ(SliceTextures(context(), runner()).size(), 0u);
}

TEST_F(SliceTexturesTest, FailWithOneLine) {
  const auto expect_failure = [](const Failure& failure, ErrorCode code, const std::string& part) {
    EXPECT_EQ(failure.code, code) << failure.message;
    EXPECT_NE(failure.message.find(part), std::string::npos) << failure.message;
    EXPECT_EQ(failure.message.find('\n'), std::string::npos) << failure.message;
  };
  const Channels one = random_channels({{3, 3, 3}, 1});
  Channels two_sizes = random_channels({{3, 3, 3}, 2});
  two_sizes[1].size = {9, 3, 1};
  expect_failure(pack({one, Channels(5, one[0])}).failure(), ErrorCode::bad_input, "volume 1: 5 channels");
  expect_failure(pack({Channels()}).failure(), ErrorCode::bad_input, "volume 0: 0 channels");
  expect_failure(pack({two_sizes}).failure(), ErrorCode::bad_input, "differ in their size");
  const std::vector<glm::uvec3> many(100, glm::uvec3(64));
  EXPECT_TRUE(pack_slices({many.data(), 7}, 4096));
  expect_failure(pack_slices(many, 4096).failure(), ErrorCode::resource_limit, "volumes 0 to 7 take");
  const glm::uvec3 huge(1024);
  expect_failure(pack_slices({&huge, 1}, 65536).failure(), ErrorCode::resource_limit, "volume 0: ");
}

// No two share a texel, all are inside of the image.
TEST_F(SliceTexturesTest, ArePackedBelowEachOther) {
  std::vector<glm::uvec3> sizes;
  for (const SizedVolume& volume : awkward_volumes()) sizes.push_back(volume.size);
  const SlicePacking packing = pack_slices(sizes, 4096).value_or_throw();
  std::uint32_t below = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_GE(packing.first_texels[i].y, below);
    const glm::uvec2 end = packing.first_texels[i] + packing.layouts[i].image_size();
    EXPECT_TRUE(glm::all(glm::lessThanEqual(end, packing.image_size)));
    EXPECT_EQ(packing.layouts[i].size, sizes[i]);
    EXPECT_GE(packing.layouts[i].padding, 1u);
    below = end.y;
  }
}

}  // namespace
}  // namespace brume::passes
