// Lenses: their openings, and the samples whose mean is a picture.
#include "scenario/lens.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "planning/device_camera.hpp"
#include "planning/view_frustum.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::scenario {
namespace {

using reference::expect_distribution;

/// Of a grid over an opening: how many points of each cell are to be expected of so many, by a grid that is
/// 64 times finer.
class OpeningCells {
 public:
  static constexpr std::uint32_t kPoints = 1u << 16;
  explicit OpeningCells(std::uint32_t blades) : blades_(blades), expected_(kCells * kCells) {
    double all = 0;
    for (int i = 0; i < kCells * kFine; ++i)
      for (int k = 0; k < kCells * kFine; ++k)
        if (reach(2 * (i + 0.5) / (kCells * kFine) - 1, 2 * (k + 0.5) / (kCells * kFine) - 1) < 1) {
          ++expected_[static_cast<std::size_t>(i / kFine + kCells * (k / kFine))];
          ++all;
        }
    for (double& count : expected_) count *= kPoints / all;
  }
  /// Below 1 inside, above 1 outside: in the disk, or of the wedge that a point lies in, below the edge
  /// between two corners.
  double reach(double x, double y) const {
    if (blades_ < 3) return std::hypot(x, y);
    const double turn = 2 * std::numbers::pi / blades_;
    const double middle = turn * (std::floor(std::atan2(x, y) / turn) + 0.5);
    return (x * std::sin(middle) + y * std::cos(middle)) / std::cos(turn / 2);
  }
  template <typename Point>
  void expect_even(const Point& point) const {
    std::vector<double> counts(kCells * kCells);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const glm::vec2 p = point(i);
      ASSERT_LE(reach(double{p.x}, double{p.y}), 1 + 1e-6);
      const auto cell = [](float at) {
        return std::clamp(static_cast<int>((at + 1) / 2 * kCells), 0, kCells - 1);
      };
      ++counts[static_cast<std::size_t>(cell(p.x) + kCells * cell(p.y))];
    }
    expect_distribution(counts, expected_);
  }

 private:
  static constexpr int kCells = 12, kFine = 64;
  std::uint32_t blades_;
  std::vector<double> expected_;
};

TEST(LensTest, PointsFillTheOpeningEvenly) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> share(0, 1);
  for (const std::uint32_t blades : {0u, 3u, 5u, 6u, 8u, 9u}) {
    SCOPED_TRACE(blades);
    const OpeningCells cells(blades);
    cells.expect_even([&](std::uint32_t) {
      const float u = share(random);
      return point_on_lens(blades, {u, share(random)});
    });
    cells.expect_even([&](std::uint32_t i) {
      return shared::lens_point_by_rejection(blades, {i, blades, 0});
    });
  }
}

TEST(LensTest, BothSamplersHaveTheSameSupport) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(-1, 1);
  for (const std::uint32_t blades : {0u, 3u, 5u, 6u, 8u}) {
    SCOPED_TRACE(blades);
    const OpeningCells cells(blades);
    // What the rejection takes is what lies inside.
    for (int i = 0; i < 20000; ++i) {
      const glm::vec2 p(share(random), share(random));
      const double reach = cells.reach(double{p.x}, double{p.y});
      // But where the rounding of floats decides.
      if (std::abs(reach - 1) < 1e-5) continue;
      EXPECT_EQ(shared::is_on_lens(blades, p), reach < 1) << p.x << " " << p.y;
    }
    // Both reach all corners, or all of the circle: of what lies within 0.1 of one, 0.004 of the opening or
    // more, none of 2^13 points is in one of e^32 cases.
    const std::uint32_t corners = blades < 3 ? 16 : blades;
    for (std::uint32_t c = 0; c < corners; ++c) {
      const double angle = 2 * std::numbers::pi * c / corners;
      const glm::vec2 corner(std::sin(angle), std::cos(angle));
      float by_remap = 9, by_rejection = 9;
      for (std::uint32_t i = 0; i < 1u << 13; ++i) {
        const glm::vec2 u(0.5f * share(random) + 0.5f, 0.5f * share(random) + 0.5f);
        by_remap = std::min(by_remap, glm::distance(corner, shared::lens_point(blades, u)));
        by_rejection =
            std::min(by_rejection, glm::distance(corner, shared::lens_point_by_rejection(blades, {i, c, 1})));
      }
      EXPECT_LT(by_remap, 0.1f);
      EXPECT_LT(by_rejection, 0.1f);
    }
  }
}

TEST(LensOpening, PassesLightAsItsImageSays) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> share(0, 1);
  for (const std::uint32_t side : {1u, 7u, 16u}) {
    SCOPED_TRACE(side);
    smoke::Mask mask{side, side, std::vector<std::uint8_t>(std::size_t{side} * side)};
    // A row and many texels are black.
    for (std::size_t i = 0; i < mask.texels.size(); ++i)
      mask.texels[i] = i / side == 2 || random() % 3 == 0 ? 0 : static_cast<std::uint8_t>(random());
    mask.texels[0] = 200;
    const auto opening = LensOpening::create(mask, "a.png").value_or_throw();
    double all = 0;
    for (const std::uint8_t texel : mask.texels) all += texel;
    constexpr std::uint32_t kPoints = 1u << 16;
    std::vector<double> expected(mask.texels.begin(), mask.texels.end()), counts(expected.size());
    for (double& count : expected) count *= kPoints / all;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const float u = share(random);
      const glm::vec2 p = opening.point({u, share(random)});
      ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1);
      // Rows from the top.
      const auto texel = [&](float at) {
        return std::min(static_cast<std::uint32_t>((at + 1) / 2 * static_cast<float>(side)), side - 1);
      };
      ++counts[texel(p.x) + side * texel(-p.y)];
    }
    if (side == 1)
      EXPECT_EQ(counts, expected);
    else
      expect_distribution(counts, expected);
  }
}

TEST(LensOpening, EndsOfTheUnitSquareAreOnWhatIsNotBlack) {
  const smoke::Mask mask{3, 3, {0, 0, 0, 0, 9, 0, 0, 0, 0}};
  const auto opening = LensOpening::create(mask, "a.png").value_or_throw();
  const float last = std::nextafter(1.0f, 0.0f);
  for (const glm::vec2 u : {glm::vec2(0, 0), glm::vec2(last, 0), glm::vec2(0, last), glm::vec2(last, last)}) {
    const glm::vec2 p = opening.point(u);
    EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1.0f / 3 + 1e-6f);
  }
  const auto black = LensOpening::create({2, 2, {0, 0, 0, 0}}, "b.png");
  ASSERT_FALSE(black);
  EXPECT_NE(black.failure().message.find("b.png: lets no light through"), std::string::npos);
}

TEST(CameraSamples, FillPixelLensAndTimeEvenlyAndApart) {
  const scene::Lens lens{.aperture = 1};
  const auto samples = camera_samples(64, lens, nullptr);
  ASSERT_EQ(samples.size(), 64u);
  std::vector<int> cells(64);
  std::array<int, 16> quarters{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    const CameraSample& sample = samples[i];
    EXPECT_EQ(sample.view.index, i);
    EXPECT_EQ(sample.view.count, 64u);
    EXPECT_GE(sample.time, static_cast<float>(i) / 64);
    EXPECT_LT(sample.time, static_cast<float>(i + 1) / 64 + 1e-6f);
    EXPECT_LE(glm::length(sample.view.lens), 1 + 1e-6f);
    const glm::ivec2 cell(glm::floor((sample.view.pixel + 0.5f) * 8.0f));
    ++cells[static_cast<std::size_t>(cell.x + 8 * cell.y)];
    // Which half of the pixel, of the lens, and of the time.
    const int part = (sample.view.pixel.x > 0) + 2 * (sample.view.lens.x > 0) + 4 * (i >= 32) +
                     8 * (sample.view.pixel.y > 0);
    ++quarters[static_cast<std::size_t>(part)];
  }
  for (const int count : cells) EXPECT_EQ(count, 1);
  // Independent: the deviation of four is less than two.
  for (const int count : quarters) EXPECT_NEAR(count, 4, 8);
  for (const int count : quarters) EXPECT_GT(count, 0);
  EXPECT_EQ(usual_samples({.lens = lens}), 64u);
  EXPECT_EQ(usual_samples({.shutter = 0.1f}), 64u);
  EXPECT_EQ(usual_samples({}), 1u);
  // One is the pinhole in the middle.
  const auto one = camera_samples(1, lens, nullptr);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].view.lens, glm::vec2(0));
  EXPECT_EQ(one[0].view.pixel, glm::vec2(0));
  EXPECT_EQ(one[0].time, 0);
}

TEST(CameraSamples, AllPointsOfALensSeeWhatIsSharpAlike) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(-5, 5), share(0, 1);
  for (int i = 0; i < 100; ++i) {
    scene::Camera camera{{value(random), value(random), value(random)},
                         {value(random), value(random), value(random)},
                         0.2f + 2 * share(random)};
    camera.lens = {.aperture = 0.3f, .focus = i % 2 ? 1 + 9 * share(random) : 0};
    const glm::uvec2 size(1 + random() % 100, 1 + random() % 100);
    const glm::vec2 ndc(2 * share(random) - 1, 2 * share(random) - 1);
    const shared::Camera middle = planning::device_camera(camera, size);
    const glm::vec3 through = middle.forward + ndc.x * middle.right - ndc.y * middle.up;
    const glm::vec3 sharp = middle.eye_world + scene::focus_distance(camera) * through;
    const planning::ViewSample sample{{share(random) - 0.5f, share(random) - 0.5f},
                                      {share(random) - 0.5f, share(random) - 0.5f}};
    const shared::Camera off = planning::device_camera(camera, size, sample);
    EXPECT_NEAR(glm::distance(off.eye_world, middle.eye_world), 0.3f * glm::length(sample.lens), 1e-5f);
    EXPECT_NEAR(glm::dot(off.eye_world - middle.eye_world, middle.forward), 0, 1e-5f);
    const glm::vec4 clip = off.clip_from_world * glm::vec4(sharp, 1);
    // The point that a pixel shows has moved against the picture.
    const glm::vec2 expected = ndc - 2.0f * sample.pixel / glm::vec2(size);
    EXPECT_NEAR(clip.x / clip.w, expected.x, 2e-3f);
    EXPECT_NEAR(clip.y / clip.w, expected.y, 2e-3f);
    // As rays have it.
    const glm::vec3 ray =
        off.forward + (off.shift.x + expected.x) * off.right + (off.shift.y - expected.y) * off.up;
    EXPECT_LT(glm::distance(off.eye_world + scene::focus_distance(camera) * ray, sharp), 2e-3f);
  }
}

TEST(CameraSamples, FrustumsHoldWhatTheirPicturesShow) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> value(-3, 3), share(-1, 1);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    scene::Camera camera{{0, 0, 4}, {0.3f, 0.1f, 0}, 0.9f};
    camera.lens = {.aperture = 2, .focus = 1};
    const shared::Camera off =
        planning::device_camera(camera, {16, 9}, {{0, 0}, {share(random), share(random)}});
    const glm::vec3 p(value(random), value(random), value(random));
    const glm::vec4 clip = off.clip_from_world * glm::vec4(p, 1);
    // Not so near an edge that rounding decides.
    const float reach = std::max(std::abs(clip.x), std::abs(clip.y)) / clip.w;
    if (clip.w > 0.01f && std::abs(reach - 1) < 1e-3f) continue;
    const bool shown = clip.w > 0 && reach < 1;
    inside += shown;
    EXPECT_EQ(planning::ViewFrustum(off).may_intersect({p, 0}), shown) << reach << " " << clip.w;
  }
  EXPECT_GT(inside, 50);
}

TEST(DeviceCamera, LooksAlongEveryAxisWithEveryAxisUp) {
  for (int i = 0; i < 36; ++i) {
    glm::vec3 forward(0), up(0);
    forward[i % 3] = i / 3 % 2 ? 1.0f : -1.0f;
    up[i / 6 % 3] = i / 18 ? 1.0f : -1.0f;
    scene::Camera camera{{1, 2, 3}, glm::vec3(1, 2, 3) + forward, 1.0f};
    camera.up_world = up;
    const shared::Camera made = planning::device_camera(camera, {16, 9});
    EXPECT_NEAR(glm::length(made.forward), 1, 1e-5f);
    const glm::vec4 ahead = made.clip_from_world * glm::vec4(camera.position_world + 2.0f * forward, 1);
    EXPECT_NEAR(ahead.x, 0, 1e-4f);
    EXPECT_NEAR(ahead.y, 0, 1e-4f);
    EXPECT_NEAR(ahead.w, 2, 1e-4f);
  }
}

TEST(FilmSamples, AreEightPointsOfThePixelAroundItsMiddle) {
  glm::vec2 sum(0);
  for (std::uint32_t frame = 0; frame < planning::kFilmSamples; ++frame) {
    const glm::vec2 point = planning::film_sample(frame).pixel;
    sum += point;
    EXPECT_LT(std::max(std::abs(point.x), std::abs(point.y)), 0.5f);
    for (std::uint32_t other = 0; other < frame; ++other) {
      // Each has a column and a row of its own.
      EXPECT_NE(planning::film_sample(other).pixel.x, point.x);
      EXPECT_NE(planning::film_sample(other).pixel.y, point.y);
    }
    EXPECT_EQ(planning::film_sample(frame + planning::kFilmSamples).pixel, point);
  }
  EXPECT_EQ(sum, glm::vec2(0));
}

}  // namespace
}  // namespace brume::scenario
