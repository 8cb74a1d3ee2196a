#include "passes/composite.hpp"

#include <random>

#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

using CompositeTest = gpu::GpuTest;

TEST_F(CompositeTest, IsOneMultiplyAdd) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> value(0, 4), share(0, 1);
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(7, 5), glm::uvec2(33, 17)}) {
    std::vector<Half4> smoke(size.x * size.y), lit(size.x * size.y);
    for (auto& texel : smoke) texel = to_half({value(random), value(random), value(random), share(random)});
    for (auto& texel : lit) texel = to_half({value(random), value(random), value(random), 1});
    const auto smoke_image = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT, smoke);
    const auto lit_image = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT, lit);
    const auto picture = test_image(context(), size, VK_FORMAT_R16G16B16A16_SFLOAT);
    shared::FrameConstants frame{};
    frame.size_px = size;
    const auto frame_buffer = upload(std::vector{frame});
    const CompositePass pass(context());
    runner().run([&](gpu::Recorder& r) { pass.record(r, frame_buffer, smoke_image, lit_image, picture); });
    const auto out = read_back<Half4>(picture);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const glm::vec4 s = from_half(smoke[i]), l = from_half(lit[i]), p = from_half(out[i]);
      for (int c = 0; c < 3; ++c) {
        const float expected = s[c] + s.w * l[c];
        EXPECT_NEAR(p[c], expected, expected / 1024);  // one rounding to a half float
      }
    }
  }
}

}  // namespace
}  // namespace brume::passes
