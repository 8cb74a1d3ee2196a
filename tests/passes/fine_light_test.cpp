#include "passes/fine_light.hpp"

#include <cmath>

#include "shared/light_side.h"
#include "tests/passes/march_fixture.hpp"

namespace brume::passes {
namespace {

/// Smoke of density 1, which no noise erodes.
class FineLightTest : public MarchFixture {
 protected:
  FineLightTest() {
    frame_.smoke = room_.volume.layout();
    frame_.look.extinction = 0.7f;
    frame_.look.noise_frequency = 1;
  }

  /// The pages of a plan, one after the other, where all texels of the smoke have this light.
  std::vector<glm::vec4> pages(planning::FineLightPlan plan, glm::vec4 inscatter, glm::vec4 side) {
    FineLightPass pass(context());
    pass.reserve(plan);
    const auto frame = upload(std::vector{frame_});
    const SmokeResources& smoke = room_.upload.resources();
    runner().run([&](gpu::Recorder& recorder) {
      recorder.clear(smoke.inscatter, {{inscatter.r, inscatter.g, inscatter.b, inscatter.a}});
      recorder.clear(smoke.light_side, {{side.r, side.g, side.b, side.a}});
      pass.upload(recorder, plan);
      pass.record(recorder, plan, {frame, smoke, noise_tile_});
    });
    const auto texels = read_back<Half4>(pass.light());
    const glm::ivec3 size(pass.light().info().size);
    std::vector<glm::vec4> out;
    for (std::uint32_t page = 0; page < plan.slots.size(); ++page)
      for (int i = 0; i < int{shared::kFineTexelsPerPage}; ++i) {
        constexpr int kEdge = shared::kFinePageTexels;
        const glm::ivec3 at =
            shared::fine_page_corner(page) + glm::ivec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge));
        out.push_back(from_half(texels[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))]));
      }
    return out;
  }

  planning::FineLightPlan plan(std::uint32_t count) const {
    planning::FineLightPlan plan;
    plan.pages.assign(room_.volume.slot_count(), 0);
    for (std::uint32_t slot = 0; slot < std::min(count, room_.volume.slot_count()); ++slot) {
      plan.slots.push_back(slot);
      plan.pages[slot] = slot + 1;
    }
    return plan;
  }

  const SmokeRoom& room_ = full_room();
  shared::FrameConstants frame_{};
};

TEST_F(FineLightTest, IsTheLightOfTheTexelsWhereItHasNoSide) {
  // More than a row of pages.
  const auto light = pages(plan(shared::kFinePagesAcross + 3), {0.5f, 0.25f, 1, 1}, glm::vec4(0));
  ASSERT_EQ(light.size(), (shared::kFinePagesAcross + 3) * std::size_t{shared::kFineTexelsPerPage});
  for (const glm::vec4& texel : light) ASSERT_EQ(texel, glm::vec4(0.5f, 0.25f, 1, 1));
}

TEST_F(FineLightTest, IsUnknownWhereThatOfTheTexelsIs) {
  for (const glm::vec4& texel : pages(plan(2), glm::vec4(0), glm::vec4(1))) ASSERT_EQ(texel, glm::vec4(0));
}

// The depth that texels know of the path is replaced by its real one: density is 1.
TEST_F(FineLightTest, ReplacesTheDepthOfThePathTowardsTheLight) {
  const float depth =
      float{shared::kSideSamples} * shared::side_depth(frame_.look.extinction, frame_.smoke.voxel_size);
  planning::FineLightPlan inside;
  inside.slots = {room_.volume.slot_at({1, 0, 1})};
  inside.pages.assign(room_.volume.slot_count(), 0);
  for (const float more : {0.0f, 0.3f, -0.2f}) {
    for (const float fraction : {1.0f, 0.5f, 0.01f}) {
      const float expected = fraction < 0.02f ? 1.0f : std::exp(fraction * more);
      const auto light = pages(inside, {0.5f, 0.25f, 1, 1}, {0, fraction, 0, depth + more});
      std::size_t off = 0;
      // Half floats: depth has 11 bits, below 1, and so has the result.
      for (const glm::vec4& texel : light) off += std::abs(texel.b / expected - 1) > 2e-3f;
      // But for the texels around the brick, a tenth, below which the grid ends.
      EXPECT_LT(off, light.size() / 10) << more << " " << fraction;
    }
  }
}

TEST(FineLight, PagesDoNotOverlap) {
  for (std::uint32_t i = 0; i < 160; ++i)
    for (std::uint32_t j = 0; j < i; ++j)
      EXPECT_TRUE(
          glm::any(glm::greaterThanEqual(glm::abs(shared::fine_page_corner(i) - shared::fine_page_corner(j)),
                                         glm::ivec3(int{shared::kFinePageTexels}))));
}

// Points of the brick are looked up where its texels are, and never beyond the page.
TEST(FineLight, PositionsAreThoseOfTheTexels) {
  for (int i = 0; i < shared::kFinePageTexels; ++i) {
    const glm::vec3 centre = shared::fine_texel_position(glm::ivec3(i));
    EXPECT_FLOAT_EQ(shared::fine_page_position(centre).x, static_cast<float>(i) + 0.5f);
  }
  EXPECT_EQ(shared::fine_page_position(glm::vec3(-1)), glm::vec3(0.5f));
  EXPECT_EQ(shared::fine_page_position(glm::vec3(9)), glm::vec3(33.5f));
}

}  // namespace
}  // namespace brume::passes
