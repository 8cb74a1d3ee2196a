// Sampled directions follow their densities, and their weights are values by densities.
#include <numbers>

#include "reference/phase.hpp"
#include "surfaces/surface.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {
namespace {

using surfaces::basis_around;
using surfaces::mix_bits;
using surfaces::Reflection;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kSamples = kSanitized ? 1u << 12 : 1u << 16;

/// A sampler of its own for each sample, so that they are independent.
Sampler independent(std::uint32_t i) {
  Sampler sampler({i % 512, i / 512}, 0);
  sampler.set_dimension(mix_bits(i));
  return sampler;
}

/// Cells of equal solid angle around an axis.
struct Sphere {
  static constexpr int kBands = 32, kSectors = 16;
  glm::dvec3 axis, x, y;
  explicit Sphere(const glm::vec3& around) : axis(around) {
    glm::vec3 first, second;
    basis_around(around, first, second);
    x = first;
    y = second;
  }
  std::size_t cell(const glm::vec3& direction) const {
    const glm::dvec3 d(direction);
    const double turn = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * kPi) + 0.5;
    const int band = std::clamp(static_cast<int>((glm::dot(d, axis) + 1) / 2 * kBands), 0, kBands - 1);
    const int sector = std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1);
    return static_cast<std::size_t>(band * kSectors + sector);
  }
  /// The integral of a density over each cell, by the midpoint rule on kSteps^2 parts.
  template <typename Density>
  std::vector<double> integrals(const Density& density) const {
    constexpr int kSteps = kSanitized ? 16 : 48;
    std::vector<double> all(kBands * kSectors);
    for (int cell = 0; cell < kBands * kSectors; ++cell)
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double c = 2 * (cell / kSectors + (i % kSteps + 0.5) / kSteps) / kBands - 1;
        const double turn = 2 * kPi * ((cell % kSectors + (i / kSteps + 0.5) / kSteps) / kSectors - 0.5);
        const double s = std::sqrt(1 - c * c);
        const glm::vec3 direction(c * axis + s * (std::cos(turn) * x + std::sin(turn) * y));
        all[static_cast<std::size_t>(cell)] +=
            double{density(direction)} * (4 * kPi / (kBands * kSectors * kSteps * kSteps));
      }
    return all;
  }
};

void expect_follows(const std::vector<double>& counts, std::vector<double> integrals) {
  for (double& integral : integrals) integral *= kSamples;
  expect_distribution(counts, integrals);
}

class PhaseTest : public testing::TestWithParam<shared::Phase> {};

TEST_P(PhaseTest, DirectionsFollowThePhaseFunction) {
  const glm::vec3 before = glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f));
  const Sphere sphere(before);
  std::vector<double> counts(Sphere::kBands * Sphere::kSectors);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    Sampler sampler = independent(i);
    const glm::vec3 after = sample_phase(GetParam(), before, sampler);
    ASSERT_NEAR(glm::length(after), 1, 1e-5f);
    ++counts[sphere.cell(after)];
  }
  expect_follows(counts, sphere.integrals([&](const glm::vec3& d) {
    return shared::phase_value(GetParam(), glm::dot(before, d));
  }));
}

INSTANTIATE_TEST_SUITE_P(AllKinds, PhaseTest,
                         testing::Values(shared::phase_of_hg(0), shared::phase_of_hg(0.3f),
                                         shared::phase_of_hg(-0.6f), shared::phase_of_hg(0.85f),
                                         shared::phase_of_droplet(0.5f), shared::phase_of_droplet(2),
                                         shared::Phase{0.2f, 0.5f, 8, 0.6f}));

struct SurfaceCase {
  Reflection surface;
  glm::vec3 view;
};
std::vector<SurfaceCase> surface_cases() {
  std::vector<SurfaceCase> cases;
  for (const float roughness : {0.4f, 0.6f, 1.0f})
    for (const float metallic : {0.0f, 0.4f, 1.0f})
      for (const glm::vec3 view :
           {glm::vec3(0, 0, 1), glm::vec3(0.6f, 0.3f, 0.6f), glm::vec3(0.9f, 0, 0.15f)})
        cases.push_back(
            {{glm::vec3(0, 0, 1), glm::vec3(0.7f, 0.4f, 0.2f), roughness, metallic}, glm::normalize(view)});
  return cases;
}

TEST(ReflectionTest, DirectionsFollowTheirDensity) {
  for (const SurfaceCase& one : surface_cases()) {
    const Sphere sphere(one.surface.normal);
    std::vector<double> counts(Sphere::kBands * Sphere::kSectors + 1);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      Sampler sampler = independent(i);
      const auto next = one.surface.sample(one.view, sampler);
      // What leaves downwards is lost.
      ++(next.density > 0 ? counts[sphere.cell(next.to_light)] : counts.back());
    }
    std::vector<double> expected =
        sphere.integrals([&](const glm::vec3& d) { return one.surface.density(one.view, d); });
    double above = 0;
    for (const double integral : expected) above += integral;
    EXPECT_LE(above, 1 + 1e-3);
    expected.push_back(std::max(1 - above, 0.0));
    expect_follows(counts, expected);
  }
}

TEST(ReflectionTest, TheMeanWeightIsTheReflectance) {
  for (const SurfaceCase& one : surface_cases()) {
    const Sphere sphere(one.surface.normal);
    double reflectance = 0;
    for (const double part :
         sphere.integrals([&](const glm::vec3& d) { return one.surface.value(one.view, d).g; }))
      reflectance += part;
    Mean mean;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      Sampler sampler = independent(i);
      mean.add(double{one.surface.sample(one.view, sampler).weight.g});
    }
    expect_mean(mean, reflectance, 0.01);
  }
}

TEST(ReflectionTest, IsReciprocal) {
  const glm::vec3 a = glm::normalize(glm::vec3(0.3f, 0.2f, 0.6f)),
                  b = glm::normalize(glm::vec3(-0.5f, 0.4f, 0.3f));
  for (const SurfaceCase& one : surface_cases()) {
    const glm::vec3 there = one.surface.value(a, b) / b.z, back = one.surface.value(b, a) / a.z;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-5f * there[c]);
  }
}

TEST(BasisTest, IsOrthonormalEverywhere) {
  for (const glm::vec3 n : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0),
                            glm::normalize(glm::vec3(1, 2, -3)), glm::normalize(glm::vec3(1e-4f, 0, -1))}) {
    glm::vec3 x, y;
    basis_around(n, x, y);
    EXPECT_NEAR(glm::dot(x, y), 0, 1e-6f);
    EXPECT_NEAR(glm::dot(x, n), 0, 1e-6f);
    EXPECT_NEAR(glm::length(x), 1, 1e-6f);
    EXPECT_NEAR(glm::length(glm::cross(x, y) - n), 0, 2e-6f);
  }
}

}  // namespace
}  // namespace brume::reference
