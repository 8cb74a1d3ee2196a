// Decals whose samples noise scatters: which samples, what they converge to, and what of the past remains.
#include <cmath>

#include "tests/passes/decal_fixture.hpp"

namespace brume::passes {
namespace {

using planning::DecalInput;
using reference::Interval;

/// A floor, and a decal over it of smooth bumps.
class DecalsScatterTest : public DecalFixture {
 protected:
  static constexpr glm::uvec2 kSize{64, 36};

  DecalsScatterTest() : DecalFixture(kSize) {
    set_plane(1, 0);
    add_volume({16, 12, 14}, {glm::dvec3(-2.5, -1.5, -2.5), glm::dvec3(2.5, 1.5, 2.5)}, [](glm::uvec3 voxel) {
      const auto bump = [](std::uint32_t x) { return 0.5f + 0.5f * std::sin(1.9f * static_cast<float>(x)); };
      const float value = bump(voxel.x) * bump(voxel.z) * (0.4f + 0.05f * static_cast<float>(voxel.y));
      return glm::vec2(value, 0.5f * value);
    });
  }
  static DecalInput decal_at(glm::vec3 place, float scatter) {
    DecalInput decal;
    decal.world_from_box =
        glm::translate(glm::mat4(1), place) * glm::rotate(glm::mat4(1), 0.5f, glm::vec3(0, 1, 0));
    decal.scatter = scatter;
    decal.fade = 0.2f;
    decal.gamma = 1.4f;
    decal.radius = 0.7f;
    return decal;
  }

  /// Sample `number` of the sequence at a pixel, in [-1/2, 1/2]^3: the R3 sequence (decals.comp), shifted.
  glm::dvec3 offset(std::size_t i, std::uint32_t number) const {
    const glm::dvec3 noise(noise_texels_[i % size_.x % 64 + 64 * (i / size_.x % 64)]);
    return glm::fract(noise + 0.5 / 256 +
                      static_cast<double>(number) * glm::dvec3(0.8191725134, 0.6710436067, 0.5497004779)) -
           0.5;
  }
  /// Mean and variance over the box of all offsets, by the middles of 8^3 parts of it.
  glm::dvec2 moments(const reference::Decal& model, std::size_t i) const {
    const glm::dvec3 uvw = model.uvw(p_world(i));
    double sum = 0, squares = 0;
    constexpr int kParts = 8;
    for (int k = 0; k < kParts * kParts * kParts; ++k) {
      const glm::dvec3 at =
          (glm::dvec3(k % kParts, k / kParts % kParts, k / kParts / kParts) + 0.5) / double{kParts} - 0.5;
      const double value = model.at(uvw + at * model.scatter, weights(model, i), uvw);
      sum += value / (kParts * kParts * kParts);
      squares += value * value / (kParts * kParts * kParts);
    }
    return {sum, std::max(0.0, squares - sum * sum)};
  }
  /// The most that any sample differs from the surface's own value.
  double most_apart(const reference::Decal& model, std::size_t i) const {
    const glm::dvec3 uvw = model.uvw(p_world(i));
    if (!model.contains(uvw)) return 0;
    const double exact = model.at(uvw, weights(model, i));
    double most = 0;
    for (int k = 0; k < 5 * 5 * 5; ++k) {
      const glm::dvec3 at = glm::dvec3(k % 5, k / 5 % 5, k / 25) / 4.0 - 0.5;
      most = std::max(most, std::abs(model.at(uvw + at * model.scatter, weights(model, i), uvw) - exact));
    }
    return most;
  }
  /// Pixels well inside of the box: all of their samples are.
  std::vector<std::size_t> covered(const reference::Decal& model) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < pixels(); ++i)
      if (depth_[i] > 0 && model.contains(model.uvw(p_world(i)), -0.5 * model.scatter - 1e-5))
        found.push_back(i);
    return found;
  }
  static bool drawn_within(float drawn, const Interval& bound) {
    return drawn >= bound.low && drawn <= bound.high;
  }
  static double rms(double squares, std::size_t count) {
    return std::sqrt(squares / static_cast<double>(count));
  }
};

// As without scatter, for the mean of eight samples. Multiples of the sequence's steps round: 6,700 at most,
// of which a float's last place is 2^-11; here 1,000 at most, 2^-14, and half of that for the step itself.
TEST_F(DecalsScatterTest, AStillIsTheMeanOfEightSamples) {
  const DecalInput decal = decal_at({0, 0.3f, 0}, 2);
  const reference::Decal model = model_of(decal);
  for (const std::uint32_t frame : {0u, 1u, 150u}) {
    const auto drawn = draw({decal}, false, frame);
    int checked = 0;
    for (const std::size_t i : covered(model)) {
      reference::DecalErrors errors = errors_of(model, i);
      const double rounding = 1.5 * (frame == 150 ? std::ldexp(1.0, -14) : std::ldexp(1.0, -19));
      errors.uvw += rounding * model.scatter;
      Interval sum;
      bool wraps = false;
      for (std::uint32_t k = 0; k < shared::kDecalSamples; ++k) {
        const glm::dvec3 at = offset(i, frame * shared::kDecalSamples + k);
        wraps |= glm::any(glm::greaterThan(glm::abs(at), glm::dvec3(0.5 - rounding)));
        const glm::dvec3 own = model.uvw(p_world(i));
        const Interval one = model.at(own + at * model.scatter, weights(model, i), own, errors);
        sum.low += one.low / shared::kDecalSamples;
        sum.high += one.high / shared::kDecalSamples;
      }
      if (wraps) continue;
      const Interval bound = stored(sum, shared::kDecalSamples);
      EXPECT_GE(drawn[i].x, bound.low) << i;
      EXPECT_LE(drawn[i].x, bound.high) << i;
      ++checked;
    }
    EXPECT_GT(checked, 150);
  }
}

// The noise shifts the samples of a pixel to any place with the same likelihood, so that the error of each
// pixel is random, of mean 0, with at most the variance of a single sample: the mean over pixels is within
// five of its standard deviations. A sequence of low discrepancy is no worse than independent samples, whose
// variance falls as their number.
TEST_F(DecalsScatterTest, StillsApproachTheMeanOverAllOffsets) {
  const DecalInput decal = decal_at({0, 0.3f, 0}, 4);
  const reference::Decal model = model_of(decal);
  const std::vector<std::size_t> inside = covered(model);
  ASSERT_GT(inside.size(), 100u);
  std::vector<double> sums(pixels(), 0);
  std::vector<glm::dvec2> expected(pixels());
  double variance = 0;
  for (const std::size_t i : inside) variance += (expected[i] = moments(model, i)).y;
  const double deviation = std::sqrt(variance / static_cast<double>(inside.size()));
  ASSERT_GT(deviation, 0.02) << "there is something to scatter";
  constexpr std::uint32_t kFrames = 32;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    const auto drawn = draw({decal}, false, frame);
    for (const std::size_t i : inside) sums[i] += double{drawn[i].x};
    if (frame != 0 && frame + 1 != kFrames) continue;
    double error = 0, squares = 0;
    for (const std::size_t i : inside) {
      const double apart = sums[i] / (frame + 1) - expected[i].x;
      error += apart;
      squares += apart * apart;
    }
    // Half floats, and the filter of the texture.
    const double rounding = std::ldexp(1.0, -11) + errors_of(model, inside[0]).value;
    EXPECT_LT(std::abs(error), 5 * std::sqrt(variance) + rounding * static_cast<double>(inside.size()));
    EXPECT_LT(rms(squares, inside.size()), deviation / std::sqrt(8 * (frame + 1)) + rounding) << frame;
  }
}

// Independent samples, of which each frame adds an eighth, would leave deviation / sqrt(15), and the mean
// would change by (1 / 8) sqrt(16 / 15) of it.
TEST_F(DecalsScatterTest, TheMeanOverFramesConvergesAndComesToRest) {
  const DecalInput decal = decal_at({0, 0.3f, 0}, 4);
  const reference::Decal model = model_of(decal);
  const std::vector<std::size_t> inside = covered(model);
  std::vector<glm::dvec2> expected(pixels());
  double variance = 0;
  for (const std::size_t i : inside) variance += (expected[i] = moments(model, i)).y;
  const double deviation = std::sqrt(variance / static_cast<double>(inside.size()));
  const double rounding = std::ldexp(1.0, -10) + errors_of(model, inside[0]).value;
  std::vector<glm::vec4> before;
  double squares = 0, changes = 0, error = 0;
  std::size_t count = 0;
  for (std::uint32_t frame = 0; frame < 48; ++frame) {
    const auto drawn = draw({decal}, true, frame);
    for (const std::size_t i : inside) EXPECT_EQ(drawn[i].y, shared::kDecalMeanSamples);
    if (frame >= 24)
      for (const std::size_t i : inside) {
        const double apart = double{drawn[i].x} - expected[i].x;
        const double change = double{drawn[i].x} - double{before[i].x};
        squares += apart * apart;
        changes += change * change;
        error += apart;
        ++count;
      }
    before = drawn;
  }
  EXPECT_LT(rms(squares, count), deviation / std::sqrt(15.0) + rounding);
  EXPECT_LT(rms(changes, count), deviation / 8 * std::sqrt(16.0 / 15) + rounding);
  EXPECT_LT(std::abs(error) / static_cast<double>(count),
            5 * deviation / std::sqrt(static_cast<double>(inside.size())) + rounding);
}

TEST_F(DecalsScatterTest, NothingTrailsBehindADecalThatJumpsAway) {
  const DecalInput here = decal_at({-2, 0.3f, 0}, 2), there = decal_at({2, 0.3f, 0}, 2);
  const reference::Decal from = model_of(here), to = model_of(there);
  for (std::uint32_t frame = 0; frame < 20; ++frame) (void)draw({here}, true, frame);
  const auto before = draw({here}, true, 20), after = draw({there}, true, 21);
  int left = 0, arrived = 0;
  for (std::size_t i = 0; i < pixels(); ++i) {
    if (depth_[i] == 0) continue;
    const glm::dvec3 uvw = to.uvw(p_world(i));
    if (!to.contains(uvw, errors_of(to, i).uvw)) {
      EXPECT_LE(after[i].x, 1.0f / 255) << i;
      left += before[i].x > 0.05f;
    } else if (from.at(from.uvw(p_world(i)), weights(from, i)) == 0) {
      // What arrives is there at once: as far off as its samples are.
      const double off = 2 * most_apart(to, i) + 1.0 / 255 + 1e-3 + errors_of(to, i).value;
      EXPECT_NEAR(after[i].x, to.at(uvw, weights(to, i)), off) << i;
      arrived += after[i].x > 0.05f;
    }
  }
  EXPECT_GT(left, 30);
  EXPECT_GT(arrived, 20);
  // And with nothing in its place.
  (void)draw({here}, true, 22);
  for (const glm::vec4& texel : draw({}, true, 23)) EXPECT_LE(texel.x, 1.0f / 255);
}

// The mean is within twice the mean of how far samples were off, in this frame and those before.
TEST_F(DecalsScatterTest, ADecalThatMovesEveryFrameStaysWhereItIs) {
  std::vector<double> most(pixels(), 0);
  for (std::uint32_t frame = 0; frame < 16; ++frame) {
    const DecalInput decal = decal_at({-1.5f + 0.12f * static_cast<float>(frame), 0.3f, 0}, 1);
    const reference::Decal model = model_of(decal);
    const auto drawn = draw({decal}, true, frame);
    for (std::size_t i = 0; i < pixels(); ++i) {
      if (depth_[i] == 0) continue;
      most[i] = std::max(most[i], most_apart(model, i));
      const glm::dvec3 uvw = model.uvw(p_world(i));
      const bool outside = !model.contains(uvw, errors_of(model, i).uvw);
      // Half floats, the filter of the texture, and that most_apart samples a grid.
      const double off = outside ? 0.0 : 2.1 * most[i] + 1e-3 + errors_of(model, i).value;
      EXPECT_NEAR(drawn[i].x, outside ? 0 : model.at(uvw, weights(model, i)), off + 1.0 / 255)
          << i << ", " << frame;
    }
  }
}

// The past of the same surface is found from elsewhere: the pixel then takes a single sample, and its mean is
// closer to that of all offsets than single samples are. That of another surface is rejected: the pixel takes
// the eight samples of a frame without a past, numbered on.
TEST_F(DecalsScatterTest, ThePastFollowsTheCameraOnTheSameSurfaceAlone) {
  const DecalInput decal = decal_at({0, 0.3f, 0}, 4);
  const reference::Decal model = model_of(decal);
  constexpr std::uint32_t kFrames = 16;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    set_camera({{0.02f * static_cast<float>(frame), 1.2f, 5}, {0, 0.4f, 0}, 1.1f});
    set_plane(1, 0);
    const auto drawn = draw({decal}, true, frame);
    if (frame + 1 < kFrames) continue;
    double squares = 0, variance = 0;
    const std::vector<std::size_t> inside = covered(model);
    for (const std::size_t i : inside) {
      const glm::dvec2 moment = moments(model, i);
      squares += (double{drawn[i].x} - moment.x) * (double{drawn[i].x} - moment.x);
      variance += moment.y;
    }
    ASSERT_GT(inside.size(), 100u);
    EXPECT_LT(squares, variance / 4) << "single samples would leave all of the variance";
  }

  set_plane(2, 1);  // a wall before the floor
  const auto wall = draw({decal}, true, kFrames);
  const std::vector<std::size_t> inside = covered(model);
  ASSERT_GT(inside.size(), 50u);
  int rejected = 0;
  for (const std::size_t i : inside) {
    Interval sum;
    for (std::uint32_t k = 0; k < shared::kDecalSamples; ++k) {
      reference::DecalErrors errors = errors_of(model, i);
      errors.uvw += 4e-6 * model.scatter;
      const Interval one = model.at(model.uvw(p_world(i)) + offset(i, kFrames + k) * model.scatter,
                                    weights(model, i), model.uvw(p_world(i)), errors);
      sum.low += one.low / shared::kDecalSamples;
      sum.high += one.high / shared::kDecalSamples;
    }
    // The wall is where the floor was along a line across the image.
    const Interval bound = stored(sum, shared::kDecalSamples);
    rejected += drawn_within(wall[i].x, bound);
  }
  EXPECT_GT(rejected, static_cast<int>(inside.size()) * 9 / 10);
}

}  // namespace
}  // namespace brume::passes
