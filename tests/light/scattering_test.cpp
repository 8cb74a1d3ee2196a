#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "shared/erosion.h"
#include "tests/light/scattering_fit.hpp"
#include "tests/reference/phase.hpp"

namespace brume::reference {
namespace {

const std::vector<double> kGs{0, 0.3, 0.6, 0.85}, kAlbedos{0.8, 0.9, 0.99, 1};

/// Chandrasekhar's H for even scattering ("Radiative Transfer", 1960, chapter V): 1 / H(mu) = sqrt(1 -
/// albedo) + albedo / 2 times the integral over t from 0 to 1 of t H(t) / (mu + t), iterated with the
/// midpoint rule.
double chandrasekhar_h(double albedo, double mu) {
  constexpr int kSteps = 2000;
  std::vector<double> h(kSteps, 1);
  const auto next = [&](double at) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps;
      sum += t * h[static_cast<std::size_t>(i)] / (at + t) / kSteps;
    }
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
  };
  for (int round = 0; round < 30; ++round) {
    std::vector<double> better(kSteps);
    for (int i = 0; i < kSteps; ++i) better[static_cast<std::size_t>(i)] = next((i + 0.5) / kSteps);
    h = better;
  }
  return next(mu);
}

TEST(MultipleScattering, MatchesChandrasekharAtTheSurfaceOfAHalfSpace) {
  // There the source of even scattering is albedo / 4 pi H(cosine of the light) for a beam of irradiance 1.
  const Body body{Body::Shape::slab, 40};
  const double tilt = 0.6;
  const BodyLight light{true, {std::sqrt(1 - tilt * tilt), 0, tilt}, {}};
  const std::vector<double> albedos{0.5, 0.9};
  const auto samples = walk_light(body, light, 0, albedos, {0, 0, -40 + 1e-9}, {0, 0, -1}, 40000, 5);
  for (const ScatteringSample& s : samples) {
    const double expected = chandrasekhar_h(s.albedo, tilt) / (4 * std::numbers::pi);
    EXPECT_NEAR(s.once + s.more, expected, 4 * s.error + 1e-4 * expected) << s.albedo;
    EXPECT_LT(s.error, 0.01 * expected);
    EXPECT_NEAR(s.once, 1 / (4 * std::numbers::pi), 1e-8);
  }
}

TEST(MultipleScattering, EqualsDoubleScatteringInAThinBody) {
  // In a small sphere, to the first order in its radius: the distance to the surface is R from its centre in
  // every direction, so that albedo R of the even light that comes in is scattered a second time.
  const Body body{Body::Shape::sphere, 0.01};
  const auto samples = walk_light(body, {}, 0, {0.7}, glm::dvec3(0), {1, 0, 0}, 400000, 3);
  const double expected = 0.7 * 0.01 / (4 * std::numbers::pi);
  EXPECT_NEAR(samples[0].more, expected, 4 * samples[0].error + 0.02 * expected);
  EXPECT_NEAR(samples[0].escape, std::exp(-0.01), 1e-12);
  EXPECT_NEAR(samples[0].depth, 0.01, 1e-12);
}

TEST(MultipleScattering, DistancesToTheSurfaceOfBodies) {
  EXPECT_DOUBLE_EQ((Body{Body::Shape::slab, 2}.exit_distance({5, 9, -1}, {0, 0.6, 0.8})), 3 / 0.8);
  EXPECT_DOUBLE_EQ((Body{Body::Shape::box, 2}.exit_distance({1, 0, -1}, {0.6, 0, 0.8})), 1 / 0.6);
  EXPECT_DOUBLE_EQ((Body{Body::Shape::sphere, 2}.exit_distance({0, 0, -1}, {0, 0, 1})), 3);
}

/// Samples with other random numbers than those of the fit, and fewer walks.
const std::vector<ScatteringSample>& some_samples() {
  static const std::vector<ScatteringSample> samples = scattering_samples(kGs, kAlbedos, 1000, 77);
  return samples;
}

double misfit_of(const shared::ManyFit& fit, std::span<const ScatteringSample> samples) {
  return misfit(samples, [&](const ScatteringSample& s) { return many_of(fit, s); });
}

TEST(ScatteringFit, IsCloserToRandomWalksThanOctaves) {
  const auto& samples = some_samples();
  const double none = misfit(samples, [](const ScatteringSample&) { return 0.0; });
  const double guessed = misfit(samples, guessed_octaves), fitted = misfit_of(shared::many_fit(), samples);
  std::printf("misfit: single scattering %.3f, octaves of 1/2 %.3f, the fit %.3f\n", none, guessed, fitted);
  // The table of docs/how/light.md, with the noise of these samples.
  EXPECT_LT(fitted, 0.28);
  EXPECT_LT(fitted, guessed / 3);
  EXPECT_LT(guessed, none);
  // And for each g and albedo alone.
  for (const double g : kGs) {
    for (const double albedo : kAlbedos) {
      std::vector<ScatteringSample> part;
      for (const ScatteringSample& s : samples)
        if (s.g == g && s.albedo == albedo) part.push_back(s);
      const double here = misfit_of(shared::many_fit(), part), there = misfit(part, guessed_octaves);
      std::printf("g %.2f albedo %.2f: octaves of 1/2 %.3f, the fit %.3f\n", g, albedo, there, here);
      EXPECT_LT(here, 0.5) << g << ' ' << albedo;
      EXPECT_LT(here, there) << g << ' ' << albedo;
    }
  }
}

TEST(ScatteringFit, IsZeroWithoutFurtherScattering) {
  const shared::ManyScatterings many =
      shared::multiple_scattering(shared::many_fit(), glm::vec3(0.9f), 0.3f, 1.0f);
  EXPECT_EQ(many.fraction, glm::vec3(0));
  EXPECT_EQ(shared::multiple_scattering(shared::many_fit(), glm::vec3(0), 0.3f, 0.2f).fraction, glm::vec3(0));
  const shared::Phase phase = shared::phase_of_hg(0.3f);
  EXPECT_EQ(shared::scattered(phase, many, 0.5f, 0.1f),
            glm::vec3(std::exp(-0.5f) * shared::phase_value(phase, 0.1f)));
}

TEST(ScatteredSky, IsAsBrightAsTheSkyWithoutAbsorption) {
  // Also where so little arrives that it is 0 in floats.
  for (const float p : {0.0f, 1e-30f, 1e-6f, 0.01f, 0.5f, 1.0f})
    EXPECT_EQ(shared::scattered_sky(glm::vec3(1), 1, 0.3f, p).x, 1) << p;
  EXPECT_LT(shared::scattered_sky(glm::vec3(0.9f), 1, 0, 0).x, 2e-5f);
}

TEST(ScatteredSky, IsWhatArrivesWithoutScattering) {
  EXPECT_FLOAT_EQ(shared::scattered_sky(glm::vec3(0), 1, 0.3f, 0.4f).x, 0.4f);
  EXPECT_FLOAT_EQ(shared::scattered_sky(glm::vec3(0.9f), 0, 0.3f, 0.4f).x, 0.4f);
}

/// Mean transmittance over the directions of a hemisphere, out of a half-space at a depth: the exponential
/// integral E2.
double exponential_integral_2(double depth) {
  constexpr int kSteps = 500;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += std::exp(-depth * kSteps / (i + 0.5));
  return sum / kSteps;
}

/// Mean radiance at depths (i + 1/2) step in a half-space that scatters evenly, under a sky of radiance 1, by
/// the integral equation J = p + albedo L J (Chandrasekhar 1960, "Radiative Transfer"), by iteration.
std::vector<double> half_space(double albedo, double step, std::size_t count, std::vector<double>& arriving) {
  std::vector<double> kernel(
      count);  // how much of what a layer sends out is scattered next in one i layers away
  for (std::size_t i = 0; i < count; ++i) {
    const double near = exponential_integral_2((static_cast<double>(i) - 0.5) * step);
    const double far = exponential_integral_2((static_cast<double>(i) + 0.5) * step);
    kernel[i] = i == 0 ? 1 - far : 0.5 * (near - far);
    arriving.push_back(0.5 * exponential_integral_2((static_cast<double>(i) + 0.5) * step));
  }
  std::vector<double> light = arriving, next(count);
  for (double change = 1; change > 1e-6;) {
    change = 0;
    for (std::size_t i = 0; i < count; ++i) {
      next[i] = arriving[i];
      for (std::size_t j = 0; j < count; ++j) next[i] += albedo * kernel[i < j ? j - i : i - j] * light[j];
      change = std::max(change, std::abs(next[i] - light[i]));
    }
    light.swap(next);
  }
  return light;
}

TEST(ScatteredSky, IsNearTheTruthInAHalfSpace) {
  for (const double albedo : {0.3, 0.5, 0.7, 0.9, 0.97, 0.99}) {
    std::vector<double> arriving;
    const std::vector<double> truth = half_space(albedo, 0.1, 200, arriving);
    double error = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      const float found =
          shared::scattered_sky(glm::vec3(static_cast<float>(albedo)), 1, 0, static_cast<float>(arriving[i]))
              .x;
      error = std::max(error, std::abs(static_cast<double>(found) - truth[i]));
    }
    std::printf("albedo %.2f: within %.3f\n", albedo, error);
    EXPECT_LT(error, albedo <= 0.9 ? 0.06 : 0.11) << albedo;
  }
}

TEST(ScatteringFit, IsFiniteAndMonotonic) {
  // More light for more albedo and for less escape, decaying in depth, for every g.
  for (const float g : {-0.9f, 0.0f, 0.5f, 0.9f, 0.99f}) {
    float before = 0;
    for (const float escape : {1.0f, 0.7f, 0.3f, 0.1f, 0.0f}) {
      const auto many = shared::multiple_scattering(shared::many_fit(), {0.5f, 0.9f, 1.0f}, g, escape);
      EXPECT_TRUE(std::isfinite(many.fraction.z) && std::isfinite(many.decay.z));
      EXPECT_GE(many.fraction.y, many.fraction.x);
      EXPECT_GE(many.fraction.z, many.fraction.y);
      EXPECT_GE(many.fraction.z, before);
      before = many.fraction.z;
      EXPECT_GT(many.decay.x, 0);
      EXPECT_GE(many.g, 0);
      EXPECT_LE(many.g, std::max(g, 0.0f));
    }
  }
}

// Layers whose noise has one of two values, each for half of the rays: the mean transmittance over all 2^n
// rays is that of even layers of the effective density.
TEST(EffectiveDensity, LetsThroughWhatTwoValuedNoiseDoes) {
  constexpr int kLayers = 10;
  const float low = 0.25f, high = 1.5f;
  for (const float k : {1e-3f, 0.02f, 0.3f, 2.0f, 20.0f}) {
    double mean = 0;
    for (unsigned ray = 0; ray < 1u << kLayers; ++ray) {
      double depth = 0;
      for (int layer = 0; layer < kLayers; ++layer)
        depth += double{k} * double{ray >> layer & 1u ? high : low};
      mean += std::exp(-depth) / (1u << kLayers);
    }
    const double depth = kLayers * double{k} * double{shared::effective_density({low, high, high, low}, k)};
    // Rounding: of four exponentials, their sum and its logarithm, all of at most 1, and of a depth in
    // floats. For small k, the series ends before the third cumulant, 0 for two values in equal parts, and
    // the fourth, (high - low)^4 / 8 at most, over 4!.
    const double rounding = kLayers * (8 + double{k * high}) * 6e-8;
    const double series = kLayers * std::pow(double{k * (high - low)}, 4) / 192;
    EXPECT_NEAR(depth, -std::log(mean), rounding + (double{k} < 0.02 ? series : 0)) << k;
  }
}

TEST(EffectiveDensity, LiesBetweenTheLeastAndTheMean) {
  for (const float k : {0.0f, 1e-4f, 0.1f, 5.0f, 500.0f}) {
    EXPECT_FLOAT_EQ(shared::effective_density(glm::vec4(0.7f), k), 0.7f) << "without noise it is the density";
    const float density = shared::effective_density({0.1f, 0.9f, 0.4f, 1.4f}, k);
    EXPECT_GE(density, 0.1f);
    EXPECT_LE(density, 0.7f + 1e-6f);
  }
}

}  // namespace
}  // namespace brume::reference
