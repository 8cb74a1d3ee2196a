#include "image/optical_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume::image {
namespace {

/// A soft blob with bumps around a point, of a size.
Texels blob(glm::uvec2 size, glm::vec2 middle, float scale) {
  Texels picture{size.x, size.y, {}};
  for (std::uint32_t y = 0; y < size.y; ++y) {
    for (std::uint32_t x = 0; x < size.x; ++x) {
      const glm::vec2 p = (glm::vec2(x, y) + 0.5f - middle) / scale;
      const float alpha = std::exp(-glm::dot(p, p) / 200);
      const float bumps = 0.5f + 0.25f * std::sin(0.6f * p.x) + 0.25f * std::sin(0.5f * p.y + 1);
      picture.rgba.emplace_back(glm::vec3(alpha * bumps), alpha);
    }
  }
  return picture;
}

double error_of(const Texels& a, const Texels& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    sum += double{glm::dot(a.rgba[i] - b.rgba[i], a.rgba[i] - b.rgba[i])};
  return std::sqrt(sum / static_cast<double>(a.rgba.size()));
}

TEST(OpticalFlow, FollowsWhatIsShifted) {
  for (const glm::vec2 shift : {glm::vec2(3.25f, -1.5f), glm::vec2(-11, 7), glm::vec2(0.25f, 0)}) {
    const Texels from = blob({96, 80}, {44, 42}, 1), to = blob({96, 80}, glm::vec2(44, 42) + shift, 1);
    const std::vector<glm::vec2> flow = optical_flow(from, to);
    glm::dvec2 mean(0);
    double count = 0;
    for (std::size_t i = 0; i < flow.size(); ++i) {
      if (from.rgba[i].a < 0.5f) continue;
      mean += glm::dvec2(flow[i]);
      count += 1;
    }
    EXPECT_NEAR(mean.x / count, double{shift.x}, 0.25);
    EXPECT_NEAR(mean.y / count, double{shift.y}, 0.25);
    EXPECT_LT(error_of(from, warped(to, flow)), 0.3 * error_of(from, to));
  }
}

TEST(OpticalFlow, FollowsWhatGrows) {
  const Texels from = blob({64, 64}, {32, 32}, 0.8f), to = blob({64, 64}, {32, 32}, 1);
  const std::vector<glm::vec2> flow = optical_flow(from, to);
  EXPECT_LT(error_of(from, warped(to, flow)), 0.3 * error_of(from, to));
  // Away from the middle on all sides.
  EXPECT_LT(flow[32 * 64 + 24].x, 0);
  EXPECT_GT(flow[32 * 64 + 40].x, 0);
  EXPECT_LT(flow[24 * 64 + 32].y, 0);
  EXPECT_GT(flow[40 * 64 + 32].y, 0);
}

TEST(OpticalFlow, OfTheSamePictureIsNone) {
  for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(7, 5), glm::uvec2(1, 1), glm::uvec2(1, 40)}) {
    const Texels picture = blob(size, glm::vec2(size) / 2.0f, 0.5f);
    for (const glm::vec2 flow : optical_flow(picture, picture)) EXPECT_EQ(flow, glm::vec2(0));
    Texels nothing = picture;
    std::ranges::fill(nothing.rgba, glm::vec4(0));
    for (const glm::vec2 flow : optical_flow(nothing, nothing)) EXPECT_EQ(flow, glm::vec2(0));
  }
}

TEST(OpticalFlow, InfinityAndSuddenLightStayFinite) {
  Texels from = blob({24, 24}, {12, 12}, 0.5f), to = from;
  to.rgba[100] = glm::vec4(std::numeric_limits<float>::infinity(), 0, 0, 1);
  from.rgba[300] = glm::vec4(1e30f, 1e30f, 0, 1);
  for (const glm::vec2 flow : optical_flow(from, to))
    EXPECT_TRUE(std::isfinite(flow.x) && std::isfinite(flow.y));
}

TEST(Warped, IsThePictureAtOtherPlaces) {
  const Texels row{3, 1, {{1, 0, 0, 1}, {2, 0, 0, 1}, {4, 0, 0, 1}}};
  const Texels moved = warped(row, {{1, 0}, {0.5f, 0}, {1, 0}});
  EXPECT_EQ(moved.rgba[0].r, 2);
  EXPECT_EQ(moved.rgba[1].r, 3);
  EXPECT_EQ(moved.rgba[2], glm::vec4(0));
}

}  // namespace
}  // namespace brume::image
