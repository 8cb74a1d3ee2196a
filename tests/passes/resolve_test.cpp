#include "passes/resolve.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "tests/passes/march_fixture.hpp"

namespace brume::passes {
namespace {

using shared::RayEnds;

class ResolveTest : public MarchFixture {
 protected:
  /// A camera at `eye` that looks along -z, narrow enough that the rays of a block are of one length.
  static shared::FrameConstants frame_at(const SmokeRoom& room, glm::vec3 eye, glm::uvec2 size,
                                         std::uint32_t scale) {
    shared::FrameConstants frame = MarchFixture::frame_at(room, eye, {0.1f, 0.05f}, size);
    frame.march_scale = scale;
    frame.resolve_error = shared::kResolveError;
    frame.exposure = 1;
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    return frame;
  }

  enum class Way { blocks, pixels, all_listed, selected };
  /// The smoke of every pixel in front of a surface at distance_at(x, y) along the view axis.
  std::vector<glm::vec4> smoke(const SmokeRoom& room, shared::FrameConstants frame,
                               const std::vector<float>& distances, Way way) {
    const glm::uvec2 size = frame.size_px;
    std::vector<float> reverse;
    for (const float d : distances) reverse.push_back(frame.camera.near_z / d);
    const auto depth = upload_image(context(), runner(), size, VK_FORMAT_R32_SFLOAT, reverse);
    const auto emission = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT,
                                       std::vector<Half4>(size.x * size.y, to_half(glm::vec4(0))));
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    const auto frame_buffer = upload(std::vector{frame});
    const auto counters = upload(std::vector<std::uint32_t>{0});
    const auto target = test_image(context(), size, VK_FORMAT_R16G16B16A16_SFLOAT);
    HoleClusters holes(context(), runner(), {});
    const auto no_holes = planning::plan_holes({}, 0, 0, frame.smoke, room.volume.slot_count(), size);
    holes.reserve(no_holes);
    const MarchTiles blocks(context(), size, std::max(frame.march_scale, 2u));
    const MarchPass::Inputs in = inputs(frame_buffer, room, depth, holes);
    runner().run([&](gpu::Recorder& recorder) {
      light_evenly(recorder, room);
      holes.record(recorder, no_holes, frame_buffer, room.upload.resources());
      if (way == Way::pixels) {
        march_.record(recorder, in, target, counters);
        return;
      }
      ResolvePass::upload(recorder, blocks);
      resolve_.record_ends(recorder, {frame_buffer, size}, depth, blocks);
      march_.record_tiles(recorder, in, blocks, counters);
      resolve_.record_select(recorder, {frame_buffer, size}, emission, blocks);
      resolve_.record(recorder, {frame_buffer, size}, depth, blocks, target);
      if (way == Way::blocks) return;
      if (way == Way::all_listed) list_all(recorder, blocks, frame);
      march_.record_list(recorder, in, blocks, target, counters);
    });
    return from_half(read_back<Half4>(target));
  }
  static void list_all(gpu::Recorder& recorder, const MarchTiles& blocks,
                       const shared::FrameConstants& frame) {
    const glm::uvec2 count = shared::tiles_of(frame.size_px, frame.march_scale);
    const std::uint32_t all = count.x * count.y, per_block = frame.march_scale * frame.march_scale;
    std::vector<std::uint32_t> words{(all * per_block + 63) / 64, 1, 1, all};
    for (std::uint32_t i = 0; i < all; ++i) words.push_back(all - 1 - i);  // in any order
    recorder.upload(blocks.list, 0, std::as_bytes(std::span(words)));
  }

  const MarchPass march_{context(), {}};
  const ResolvePass resolve_{context()};
};

using Surface = std::function<float(std::uint32_t x, std::uint32_t y)>;

std::vector<float> distances_of(const Surface& surface, glm::uvec2 size) {
  std::vector<float> distances;
  for (std::uint32_t y = 0; y < size.y; ++y)
    for (std::uint32_t x = 0; x < size.x; ++x) distances.push_back(surface(x, y));
  return distances;
}

/// A wall, a floor that runs away, a grid of bars in front of a wall, and every pixel for itself.
std::vector<Surface> surfaces() {
  const auto random = std::make_shared<std::mt19937>(3);
  return {[](std::uint32_t, std::uint32_t) { return 2.5f; },
          [](std::uint32_t x, std::uint32_t y) {
            return 1 / (0.15f + 0.011f * static_cast<float>(y) + 0.003f * static_cast<float>(x));
          },
          [](std::uint32_t x, std::uint32_t y) { return x % 6 == 0 || y % 7 == 3 ? 0.8f : 6.0f; },
          [random](std::uint32_t, std::uint32_t) {
            return std::uniform_real_distribution<float>(0.3f, 9.0f)(*random);
          }};
}

/// Most that a number changes by, of itself, when it becomes a half float: by rounding towards 0, which
/// Vulkan allows.
constexpr double kHalfRounding = 1.0 / 1024;

/// How far off a pixel's transmittance may be in an even medium of density 1, at a distance z along the view
/// axis. Of shaders/resolve.comp:
///
/// A block's ray knows its own pixels' depths exactly: between its two ends least and most agree but for the
/// rounding of two half floats, which is its doubt d0. Its share a of the bilinear weights is least in a
/// corner of the block.
///
/// The other rays are off by what they doubt, d, but for the slope of rays, 1 to `longest`, which makes it
/// (longest - 1)(1 + 9 * extinction) of d more at most: the surfaces lie within 9 m. With x = d / kDoubt they
/// count (1 - a) / (1 + x^2), the block's own a' = a / (1 + (d0 / kDoubt)^2). Their mean is off by
/// d (1 - a) / (1 - a + a' (1 + x^2)), which is largest at x^2 = (1 - a + a') / a'.
///
/// Rays two blocks apart differ in length; the middle of a block that the picture's rim cuts may lie beyond
/// it. What rays saw and their mean are rounded to half floats.
double most_off(double z, double expected, double extinction, std::uint32_t scale, glm::uvec2 size) {
  const double beyond = scale - 2, rounding = kHalfRounding;
  const double slope_x = 0.1 * (1 + beyond / size.x), slope_y = 0.05 * (1 + beyond / size.y);
  const double longest = std::hypot(1.0, slope_x, slope_y);
  const double side = 1 - 0.5 * (scale - 1.0) / scale, a = side * side;
  const double doubt = shared::kDoubt, own = a / (1 + std::pow(2 * rounding / doubt, 2));
  const double steeper = (longest - 1) * (1 + extinction * 9);
  const double others = doubt * (1 + steeper) * (1 - a) / (2 * std::sqrt(own * (1 - a + own)));
  // The length of a ray changes by no more than its slope times what the slope changes by.
  const double longer =
      std::min(longest - 1, 2.0 * scale * (slope_x * 0.2 / size.x + slope_y * 0.1 / size.y));
  return others + expected * (extinction * z * longer + 2 * rounding);
}

TEST_F(ResolveTest, AConstantMediumIsBeerLambertInFrontOfAnySurface) {
  const SmokeRoom& room = full_room();
  for (const std::uint32_t scale : {2u, 4u}) {
    for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(7, 5), glm::uvec2(1, 1)}) {
      const auto frame = frame_at(room, {0, 0, -0.5f}, size, scale);
      for (const Surface& surface : surfaces()) {
        const auto distances = distances_of(surface, size);
        for (const Way way : {Way::blocks, Way::selected, Way::pixels}) {
          const auto pixels = smoke(room, frame, distances, way);
          for (std::uint32_t i = 0; i < pixels.size(); ++i) {
            const glm::vec2 ndc = (glm::vec2(i % size.x, i / size.x) + 0.5f) / glm::vec2(size) * 2.0f - 1.0f;
            const double length =
                std::hypot(1.0, 0.1 * static_cast<double>(ndc.x), 0.05 * static_cast<double>(ndc.y));
            const double z = static_cast<double>(distances[i]), expected = std::exp(-0.7 * z * length);
            const double bound =
                way == Way::pixels ? kHalfRounding * expected : most_off(z, expected, 0.7, scale, size);
            EXPECT_NEAR(pixels[i].w, expected, bound) << scale << " pixel " << i;
            EXPECT_NEAR(pixels[i].z, 1 - expected, bound + 0.001) << scale << " pixel " << i;
            EXPECT_NEAR(pixels[i].x, 0.5 * (1 - expected), 0.5 * bound + 0.001);
          }
        }
      }
    }
  }
}

TEST_F(ResolveTest, ListedPixelsAreThoseOfTheFullMarchBitForBit) {
  std::vector<voxel::Triangle> walls;
  add_quad(walls, {-5, -3, -6.05f}, {-0.6f, -3, -6.05f}, {-0.6f, 3, -6.05f}, {-5, 3, -6.05f});
  SmokeRoom room(context(), runner(), walls, {{40, 24, 40}, 0.25f, {-5, -3, -10.0f}}, {0, 0, -7}, 6000, 120);
  for (const std::uint32_t scale : {2u, 4u}) {
    for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(7, 5), glm::uvec2(1, 1)}) {
      auto frame = frame_at(room, {0, 0, 0}, size, scale);
      frame.camera.right *= 5.0f;
      frame.camera.up *= 5.0f;
      const auto distances = distances_of(surfaces()[2], size);
      EXPECT_EQ(smoke(room, frame, distances, Way::all_listed), smoke(room, frame, distances, Way::pixels));
    }
  }
}

/// Ends of a block by the words of shared/resolve.h: of the distances of its pixels.
void expect_ends_of(const RayEnds& ends, const std::vector<float>& distances) {
  const auto [low, high] = std::minmax_element(distances.begin(), distances.end());
  EXPECT_FLOAT_EQ(ends.near, *low);
  EXPECT_FLOAT_EQ(ends.far, *high);
  if (ends.near_last > ends.far_first || ends.near == ends.far) return;
  float near_last = 0, far_first = 1e9f;
  for (const float d : distances)
    (2 * d < *low + *high ? near_last : far_first) =
        2 * d < *low + *high ? std::max(near_last, d) : std::min(far_first, d);
  EXPECT_FLOAT_EQ(ends.near_last, near_last);
  EXPECT_FLOAT_EQ(ends.far_first, far_first);
}

TEST_F(ResolveTest, RaysOfUnevenBlocksPassThroughAFarPixel) {
  const SmokeRoom& room = full_room();
  constexpr glm::uvec2 kSize{33, 17};
  for (const std::uint32_t scale : {2u, 4u}) {
    const auto frame = frame_at(room, {0, 0, -0.5f}, kSize, scale);
    const auto frame_buffer = upload(std::vector{frame});
    const glm::uvec2 count = shared::tiles_of(kSize, scale);
    const auto all = surfaces();
    for (std::size_t s = 0; s < all.size(); ++s) {
      const auto distances = distances_of(all[s], kSize);
      std::vector<float> reverse;
      for (const float d : distances) reverse.push_back(frame.camera.near_z / d);
      const auto depth = upload_image(context(), runner(), kSize, VK_FORMAT_R32_SFLOAT, reverse);
      const MarchTiles blocks(context(), kSize, scale);
      runner().run([&](gpu::Recorder& r) { resolve_.record_ends(r, {frame_buffer, kSize}, depth, blocks); });
      const auto ends = read_back<RayEnds>(blocks.ends, count.x * count.y);
      for (std::uint32_t i = 0; i < ends.size(); ++i) {
        const glm::uvec2 first = glm::uvec2(i % count.x, i / count.x) * scale;
        std::vector<float> inside;
        for (std::uint32_t y = first.y; y < std::min(first.y + scale, kSize.y); ++y)
          for (std::uint32_t x = first.x; x < std::min(first.x + scale, kSize.x); ++x)
            inside.push_back(distances[x + kSize.x * y]);
        expect_ends_of(ends[i], inside);
        const bool even = ends[i].near_last > ends[i].far_first || ends[i].near == ends[i].far;
        if (s < 2) {
          // At the picture's rim a window is filled up with its last row, and bends there.
          const bool rim =
              first.x + scale + 1 > kSize.x || first.y + scale + 1 > kSize.y || first.x == 0 || first.y == 0;
          EXPECT_TRUE(even || rim) << "walls and floors are even, block " << i;
        }
        const glm::vec2 p = ends[i].position_px;
        if (even) {
          EXPECT_EQ(p, glm::vec2(first) + 0.5f * static_cast<float>(scale));
        } else {
          const auto pixel = static_cast<std::uint32_t>(p.x) + kSize.x * static_cast<std::uint32_t>(p.y);
          EXPECT_EQ(p, glm::floor(p) + 0.5f);
          EXPECT_GE(distances[pixel], ends[i].far_first * 0.999999f);
        }
      }
    }
  }
}

/// Which blocks are listed when the rays of 12 x 9 blocks in front of one wall saw this.
class SelectTest : public ResolveTest {
 protected:
  static constexpr glm::uvec2 kBlocks{12, 9};
  std::set<std::uint32_t> listed(const std::function<glm::vec4(glm::vec2)>& seen, glm::vec3 emission) {
    const SmokeRoom room(context(), runner(), {}, {{24, 17, 33}, 0.5f, {-6, -4, -16}}, {0, 0, -1}, 100, 400);
    const glm::uvec2 size = kBlocks * 4u;
    const auto frame = frame_at(room, {0, 0, -0.5f}, size, 4);
    const auto frame_buffer = upload(std::vector{frame});
    MarchTiles blocks(context(), size, 4);
    std::vector<Half4> texels;
    for (std::uint32_t i = 0; i < kBlocks.x * kBlocks.y; ++i)
      texels.push_back(to_half(seen(glm::vec2(i % kBlocks.x, i / kBlocks.x))));
    blocks.near = upload_image(context(), runner(), kBlocks, VK_FORMAT_R16G16B16A16_SFLOAT, texels);
    blocks.far = upload_image(context(), runner(), kBlocks, VK_FORMAT_R16G16B16A16_SFLOAT, texels);
    blocks.ends = upload(std::vector<RayEnds>(kBlocks.x * kBlocks.y, {{0, 0}, 3, 3, 3, 3}));
    const auto shining = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT,
                                      std::vector<Half4>(size.x * size.y, to_half(glm::vec4(emission, 0))));
    runner().run([&](gpu::Recorder& recorder) {
      ResolvePass::upload(recorder, blocks);
      resolve_.record_select(recorder, {frame_buffer, size}, shining, blocks);
    });
    const auto words = read_back<std::uint32_t>(blocks.list, 4 + kBlocks.x * kBlocks.y);
    const std::uint32_t groups = (words[3] * 16 + 63) / 64;
    EXPECT_EQ(words[0], groups);
    EXPECT_EQ(words[1], groups > 0 ? 1u : 0u);
    EXPECT_EQ(words[2], 1u);
    return {words.begin() + 4, words.begin() + 4 + words[3]};
  }
};

TEST_F(SelectTest, ListsNothingWhereInterpolationIsExact) {
  EXPECT_TRUE(listed([](glm::vec2) { return glm::vec4(0, 0, 0, 1); }, glm::vec3(10)).empty());
  EXPECT_TRUE(listed([](glm::vec2) { return glm::vec4(0.3f, 0.2f, 0.1f, 0.4f); }, glm::vec3(10)).empty());
}

TEST_F(SelectTest, ListsBothSidesOfAnEdgeThatIsSeen) {
  const auto edge = [](float right) {
    return [=](glm::vec2 p) {
      return p.x < 6 ? glm::vec4(0.2f, 0.2f, 0.2f, 0.1f) : glm::vec4(0.2f, 0.2f, 0.2f, right);
    };
  };
  std::set<std::uint32_t> beside;
  for (std::uint32_t y = 0; y < kBlocks.y; ++y)
    for (const std::uint32_t x : {5u, 6u}) beside.insert(x + kBlocks.x * y);
  EXPECT_EQ(listed(edge(0.6f), glm::vec3(0)), beside);
  // In front of a light a small edge is seen, in front of a wall it is not.
  EXPECT_EQ(listed(edge(0.13f), glm::vec3(0)), std::set<std::uint32_t>{});
  EXPECT_EQ(listed(edge(0.13f), glm::vec3(3)), beside);
}

}  // namespace
}  // namespace brume::passes
