#include "passes/average.hpp"

#include <random>

#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

class AverageTest : public gpu::GpuTest {};

TEST_F(AverageTest, ShowsTheMeanOfTheFramesSoFar) {
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(7, 1), glm::uvec2(33, 17)}) {
    const AveragePass pass(context(), size);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(0, 8);
    // The second picture starts over.
    for (int picture = 0; picture < 2; ++picture) {
      std::vector<glm::dvec4> sums(size.x * size.y);
      for (std::uint32_t frame = 0; frame < 9; ++frame) {
        std::vector<Half4> texels;
        for (glm::dvec4& sum : sums) {
          texels.push_back(to_half({value(random), value(random), value(random), 1}));
          sum += glm::dvec4(from_half(texels.back()));
        }
        const gpu::Image image =
            upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT, texels);
        runner().run([&](gpu::Recorder& recorder) { pass.record(recorder, image, frame); });
        const auto found = read_back<Half4>(image);
        for (std::size_t i = 0; i < sums.size(); ++i)
          for (int c = 0; c < 4; ++c) {
            const double mean = sums[i][c] / (frame + 1);
            // The last of a half float's 11 bits, which devices may round either way, and floats in between.
            EXPECT_NEAR(double{from_half(found[i])[c]}, mean, mean * (0x1p-10 + 9 * 0x1p-23) + 1e-7);
          }
      }
    }
  }
}

TEST_F(AverageTest, TakesWhatIsTooBrightAsTheBrightest) {
  const AveragePass pass(context(), {1, 1});
  const float infinite = std::numeric_limits<float>::infinity();
  for (const std::uint32_t frame : {0u, 1u}) {
    const std::vector<Half4> texel{to_half({frame == 0 ? infinite : 0.0f, 1, 1, 1})};
    const gpu::Image image = upload_image(context(), runner(), {1, 1}, VK_FORMAT_R16G16B16A16_SFLOAT, texel);
    runner().run([&](gpu::Recorder& recorder) { pass.record(recorder, image, frame); });
    EXPECT_EQ(from_half(read_back<Half4>(image)[0]).x, frame == 0 ? 65504.0f : 32752.0f);
  }
}

}  // namespace
}  // namespace brume::passes
