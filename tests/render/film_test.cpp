// Films whose smoke is gathered over their frames.
#include <cmath>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{96, 54};

class FilmTest : public gpu::GpuTest {
 protected:
  /// A bright wall behind dense smoke, and a shot that opens it from 1 s to about 2 s.
  static scenario::Scenario scenario() {
    scene::Scene scene = room_of({scene_light({-2, 3, 3}, glm::vec3(10))});
    scene.materials[0].emission = glm::vec3(0.6f);
    scene::Timeline timeline;
    timeline.sky = plain_sky(0, 0.001f);
    timeline.smoke.voxels = 2000;
    timeline.smoke.extinction = 4;
    timeline.smokes = {{0, {0, 0.4f, 0}, {0, 0.4f, 0}}};
    timeline.shots = {{3, {0, 1.5f, 5.4f}, {0, 1.5f, 0}, 0.5f, {0.05f, 0.05f, 0.3f, 0.1f}}};
    timeline.shots[0].flash = 0;
    return scenario_of(std::move(scene), std::move(timeline), kRoomLayout);
  }
  static RendererOptions options(std::uint32_t scale, bool temporal) {
    RendererOptions options;
    options.size_px = kSize;
    options.smoke.march_scale = scale;
    options.smoke.temporal = temporal;
    return options;
  }
  static double mean_difference(const image::Image8& a, const image::Image8& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
    return sum / (0.75 * static_cast<double>(a.rgba.size()));  // alpha is the same
  }
  static double centre(const image::Image8& image) {
    double sum = 0;
    for (std::uint32_t y = 25; y < 29; ++y)
      for (std::uint32_t x = 46; x < 50; ++x) sum += image.rgba[4 * (x + std::size_t{kSize.x} * y) + 1];
    return sum / 16;
  }
};

TEST_F(FilmTest, AFrameThatFollowsNoneIsTheImageOfItsTime) {
  const scenario::Scenario scene = scenario();
  for (const std::uint32_t scale : {1u, 4u}) {
    film::Playback film(context(), scene, options(scale, true)),
        stills(context(), scene, options(scale, false));
    // Stills of one sample halve their steps where smoke has detail; films do not.
    stills.set_step_scale(2);
    EXPECT_EQ(film.draw(2, 48).rgba, stills.draw(2, 48).rgba);
    EXPECT_NE(film.draw(2.04, 49).rgba, stills.draw(2.04, 49).rgba);
    EXPECT_EQ(film.draw(2, 48).rgba, stills.draw(2, 48).rgba);
  }
}

/// What a screen shows of a grey radiance, 0..255 (Khronos PBR Neutral, then sRGB), and the other way round.
double shown(double radiance) {
  const double x = std::clamp(radiance, 0.0, 0.8);  // above, highlights: as that
  const double toned = x < 0.08 ? 6.25 * x * x : x - 0.04;
  return 255 * (toned <= 0.0031308 ? 12.92 * toned : 1.055 * std::pow(toned, 1 / 2.4) - 0.055);
}
double radiance_of(double value) {
  double low = 0, high = 0.8;
  for (int i = 0; i < 50; ++i) (shown(0.5 * (low + high)) < value ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

/// How far apart two films may be at a pixel that gather the same frames from different pasts on, where all
/// light comes from grey smoke and `now` is the frame at hand. Both gather into [mean - deviation, mean +
/// deviation] of the 3x3 pixels around, or from there to the pixel's own value. Of nine values in [low, high]
/// the mean less the deviation is least where one alone is high: low - (sqrt(8) - 1) / 9 (high - low).
/// Rounding and noise against bands are one step.
double most_apart(const image::Image8& now, std::uint32_t x, std::uint32_t y) {
  std::uint8_t least = 255, most = 0;
  for (std::uint32_t j = std::max(y, 1u) - 1; j < std::min(y + 2, now.height); ++j)
    for (std::uint32_t i = std::max(x, 1u) - 1; i < std::min(x + 2, now.width); ++i) {
      const std::uint8_t value = now.rgba[4 * (i + std::size_t{now.width} * j)];
      least = std::min(least, value);
      most = std::max(most, value);
    }
  const double low = radiance_of(least - 1.0), high = radiance_of(most + 1.0);
  const double beyond = (std::sqrt(8.0) - 1) / 9 * (high - low);
  return shown(high + beyond) - shown(low - beyond) + 2;
}

TEST_F(FilmTest, AHoleThatHasClosedLeavesNoGhost) {
  // Two films of smoke in front of black walls; through one goes a shot. From the first frame after its hole
  // has closed on, they are as near to each other as their frames' jitter allows, and then nearer.
  scenario::Scenario shot = scenario();
  shot.scene.materials[0].emission = shot.scene.materials[0].base_color = glm::vec3(0);
  shot.timeline.smoke.erosion = 0;  // which shots push around, for longer than their holes stay open
  scenario::Scenario still = shot;
  still.timeline.shots.clear();
  for (const std::uint32_t scale : {1u, 2u}) {
    film::Playback had(context(), shot, options(scale, true)), never(context(), still, options(scale, true)),
        stills(context(), still, options(scale, false));
    double most_open = 0, first_apart = 0, last_apart = 0;
    for (std::uint32_t i = 0; i < 24; ++i) {
      const double seconds = 3 + i / 24.0;
      const auto a = had.draw(seconds, i), b = never.draw(seconds, i);
      if (i > 0 && !had.simulation().world().state().holes.empty()) {
        most_open = std::max(most_open, std::abs(centre(a) - centre(b)));
        continue;
      }
      if (i == 0) continue;
      const auto now = stills.draw(seconds, i);
      if (first_apart == 0) first_apart = mean_difference(a, b);
      last_apart = mean_difference(a, b);
      int beyond = 0;
      for (std::uint32_t k = 0; k < kSize.x * kSize.y; ++k)
        beyond += std::abs(a.rgba[4 * k] - b.rgba[4 * k]) > most_apart(now, k % kSize.x, k / kSize.x);
      EXPECT_EQ(beyond, 0) << "scale " << scale << " frame " << i;
    }
    EXPECT_GT(most_open, 30) << "there was a hole to see";
    EXPECT_LT(last_apart, first_apart);
    std::printf("scale %u: open %.1f, closed %.3f, at last %.3f of 255\n", scale, most_open, first_apart,
                last_apart);
  }
}

/// The most that an antialiased film may show at a pixel, 0..255, where all light is grey and a frame without
/// history is `now`. It gathers into [mean - deviation, mean + deviation] of 3x3 values r / (1 + r), each
/// within half a pixel of the middle of a pixel, hence among 5x5 pixels; as in most_apart, one value alone
/// may be high.
double most_shown(const image::Image8& now, std::uint32_t x, std::uint32_t y) {
  std::uint8_t least = 255, most = 0;
  for (std::uint32_t j = y - 2; j <= y + 2; ++j)
    for (std::uint32_t i = x - 2; i <= x + 2; ++i) {
      const std::uint8_t value = now.rgba[4 * (i + std::size_t{now.width} * j)];
      least = std::min(least, value);
      most = std::max(most, value);
    }
  if (most >= 225) return 255;  // a highlight, of which radiance_of knows nothing
  const auto compressed = [](double r) { return r / (1 + r); };
  const double low = compressed(radiance_of(least - 1.0)), high = compressed(radiance_of(most + 1.0));
  const double bound = high + (std::sqrt(8.0) - 1) / 9 * (high - low);
  return shown(bound / (1 - bound)) + 1;
}

TEST_F(FilmTest, WhatSmokeHidesAntialiasedFilmsHideAtOnce) {
  // The bright wall is seen through the hole of a shot. From the first frame after it has closed on, nothing
  // of it remains in the film.
  scenario::Scenario scene = scenario();
  scene.timeline.smoke.erosion = 0;  // which shots push around, for longer than their holes stay open
  RendererOptions antialiased = options(1, true);
  antialiased.antialias = true;
  film::Playback film(context(), scene, antialiased), stills(context(), scene, options(1, false));
  double open = 0, closed = 0;
  int frames = 0;
  for (std::uint32_t i = 0; i < 24; ++i) {
    const double seconds = 3 + i / 24.0;
    const image::Image8 shown = film.draw(seconds, i);
    const bool is_open = !film.simulation().world().state().holes.empty();
    if (is_open || i == 0) {
      open = std::max(open, centre(shown));
      continue;
    }
    closed = std::max(closed, centre(shown));
    const image::Image8 now = stills.draw(seconds, i);
    for (std::uint32_t y = 2; y + 2 < kSize.y; ++y)
      for (std::uint32_t x = 2; x + 2 < kSize.x; ++x)
        ASSERT_LE(shown.rgba[4 * (x + std::size_t{kSize.x} * y)], most_shown(now, x, y))
            << "frame " << i << " at " << x << " " << y;
    ++frames;
  }
  std::printf("open %.1f, closed %.1f of 255 in %d frames\n", open, closed, frames);
  EXPECT_GT(frames, 3);
  EXPECT_GT(open, closed + 20) << "there was a hole to see";
}

/// Root mean square difference of a film and the smooth picture where the jagged one is off, 0..255.
double difference_at_edges(const image::Image8& a, const image::Image8& b, const image::Image8& jagged) {
  double sum = 0;
  int count = 0;
  for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
    if (std::abs(jagged.rgba[4 * i] - b.rgba[4 * i]) < 8) continue;
    const double apart = a.rgba[4 * i] - b.rgba[4 * i];
    sum += apart * apart;
    ++count;
  }
  EXPECT_GT(count, 40) << "there are edges";
  return std::sqrt(sum / std::max(count, 1));
}

TEST_F(FilmTest, EdgesAreSmooth) {
  // A room without smoke. A point in the middle of each pixel misses its mean by up to half of the step at an
  // edge, evenly distributed; eight points by an eighth of that; the last frames of the mean count for more
  // than others.
  scenario::Scenario scene = scenario();
  scene.timeline.smokes.clear();
  scene.timeline.shots.clear();
  RendererOptions antialiased = options(1, false);
  antialiased.antialias = true;
  film::Playback film(context(), scene, antialiased), stills(context(), scene, options(1, false));
  image::Image8 shown;
  for (std::uint32_t i = 0; i < 33; ++i) shown = film.draw(0.1, i);
  const image::Image8 jagged = stills.draw(0.1, 0);
  stills.set_samples(64);
  const image::Image8 smooth = stills.draw(0.1, 0);
  const double before = difference_at_edges(jagged, smooth, jagged),
               now = difference_at_edges(shown, smooth, jagged);
  std::printf("at edges: %.1f, antialiased %.1f of 255\n", before, now);
  EXPECT_LT(now, before / 2);
}

/// Mean difference of images that follow each other while the camera circles the smoke.
double flicker(film::Playback& playback) {
  const auto draw = [&](std::uint32_t i) {
    const float angle = 0.6f * std::sin(0.6283f * static_cast<float>(i) / 24);
    playback.set_camera(
        scene::Camera{{5.5f * std::sin(angle), 1.5f, 5.5f * std::cos(angle)}, {0, 1.5f, 0}, 0.9f});
    // The shortest time with another jitter.
    return playback.draw(2 + (i % 120) / 360.0, i);
  };
  double sum = 0;
  for (const std::uint32_t first : {0u, 120u}) {
    image::Image8 before = draw(first);
    for (std::uint32_t i = first + 1; i < first + 12; ++i) {
      image::Image8 now = draw(i);
      double difference = 0;
      for (std::size_t k = 0; k < now.rgba.size(); ++k) difference += std::abs(now.rgba[k] - before.rgba[k]);
      if (i > first + 8) sum += difference / (0.75 * static_cast<double>(now.rgba.size())) / 6;
      before = std::move(now);
    }
  }
  return sum;
}

TEST_F(FilmTest, AReducedMarchFlickersNoMoreThanAFullOne) {
  const scenario::Scenario scene = scenario();
  film::Playback full(context(), scene, options(1, false)), half(context(), scene, options(2, false)),
      gathered(context(), scene, options(2, true));
  const double of_full = flicker(full), of_half = flicker(half), of_gathered = flicker(gathered);
  std::printf("from frame to frame, of 255: full %.3f, half %.3f, half gathered %.3f\n", of_full, of_half,
              of_gathered);
  EXPECT_LT(of_half, 1.05 * of_full);
  EXPECT_LT(of_gathered, of_half);
}

}  // namespace
}  // namespace brume::render
