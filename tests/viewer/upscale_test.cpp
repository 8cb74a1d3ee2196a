#include "apps/viewer/upscale_pass.hpp"

#include <cmath>
#include <functional>

#include "tests/gpu/gpu_test.hpp"

namespace brume::viewer {
namespace {

using Image = std::vector<glm::u8vec4>;

class UpscaleTest : public gpu::GpuTest {
 protected:
  static Image enlarge(glm::uvec2 from, glm::uvec2 to, const Image& texels) {
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.size = {from, 1};
    const gpu::Image source(context(), info);
    info.size = {to, 1};
    const gpu::Image target(context(), info);
    const UpscalePass pass(context());
    runner().run([&](gpu::Recorder& recorder) {
      const gpu::Recorder::Region region{std::as_bytes(std::span(texels)), glm::ivec3(0), {from, 1}};
      recorder.upload(source, std::span(&region, 1));
      pass.record(recorder, source, target);
    });
    return read_back<glm::u8vec4>(target);
  }
};

/// A picture with a smooth edge along a line; `scale` texels per unit.
Image edge(glm::uvec2 size, float scale, float angle) {
  Image texels;
  for (std::uint32_t y = 0; y < size.y; ++y)
    for (std::uint32_t x = 0; x < size.x; ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / scale - 16.0f;
      const float across = at.x * std::sin(angle) + at.y * std::cos(angle);
      texels.emplace_back(glm::u8vec3(across > 0 ? 220 : 30), 255);
    }
  return texels;
}

/// The same by bilinear interpolation.
Image enlarge_bilinear(glm::uvec2 from, glm::uvec2 to, const Image& texels) {
  Image result;
  for (std::uint32_t y = 0; y < to.y; ++y)
    for (std::uint32_t x = 0; x < to.x; ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) * glm::vec2(from) / glm::vec2(to) - 0.5f;
      const glm::vec2 first = glm::floor(at), f = at - first;
      const auto texel = [&](int dx, int dy) {
        const glm::ivec2 p =
            glm::clamp(glm::ivec2(first) + glm::ivec2(dx, dy), glm::ivec2(0), glm::ivec2(from) - 1);
        return glm::vec3(texels[static_cast<std::size_t>(p.y) * from.x + static_cast<std::size_t>(p.x)]);
      };
      const glm::vec3 value =
          glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
      result.emplace_back(glm::u8vec3(glm::round(value)), 255);
    }
  return result;
}

double error_of(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i].x) - double(b[i].x), 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST_F(UpscaleTest, EdgesAreCloserToTheirTrueLineThanByInterpolation) {
  constexpr glm::uvec2 kSmall(32), kLarge(64);
  for (const float angle : {0.2f, 0.5f, 0.785f, 1.1f, 2.0f}) {
    const Image small = edge(kSmall, 1, angle), reference = edge(kLarge, 2, angle);
    const double along_edges = error_of(enlarge(kSmall, kLarge, small), reference);
    const double bilinear = error_of(enlarge_bilinear(kSmall, kLarge, small), reference);
    EXPECT_LT(along_edges, 0.95 * bilinear) << angle;
  }
}

TEST_F(UpscaleTest, FlatColoursAndImagesOfTheSameSizeStay) {
  const Image grey(12 * 7, glm::u8vec4(90, 120, 200, 255));
  for (const glm::u8vec4& texel : enlarge({12, 7}, {31, 20}, grey)) EXPECT_EQ(texel, grey[0]);
  const Image line = edge({16, 16}, 1, 0.5f);
  EXPECT_EQ(enlarge({16, 16}, {16, 16}, line), line);
}

}  // namespace
}  // namespace brume::viewer
