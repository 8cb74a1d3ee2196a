// Refraction and reflection at glass: those of shared/optics.h and of the path tracer against Snell and
// Fresnel.
#include "shared/optics.h"

#include "tests/path_tracer/tank_fixture.hpp"

namespace brume::reference {
namespace {

glm::dvec3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

TEST(OpticsTest, RefractionFollowsSnellsLaw) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  int total = 0;
  for (int i = 0; i < 100000; ++i) {
    const glm::dvec3 normal = random_unit(random);
    glm::dvec3 direction = random_unit(random);
    if (glm::dot(direction, normal) > 0) direction = -direction;
    const double index = 1 + 1.5 * share(random), ratio = i % 2 == 0 ? 1 / index : index;
    const double sine = glm::length(glm::cross(direction, normal)), behind = ratio * sine;
    const glm::vec3 found =
        shared::refracted(glm::vec3(direction), glm::vec3(normal), static_cast<float>(ratio));
    if (std::abs(behind - 1) < 1e-4) continue;  // rounding decides
    if (behind > 1) {
      ++total;
      EXPECT_EQ(found, glm::vec3(0));
      EXPECT_EQ(shared::fresnel_reflectance(static_cast<float>(-glm::dot(direction, normal)),
                                            static_cast<float>(ratio)),
                1);
      continue;
    }
    // In the plane of both, on the other side, and the sines are in the ratio of the indices. The error of
    // floats grows towards grazing, where the cosine is the root of what cancels: 1e-7 / cosine.
    const double cosine = std::sqrt(1 - behind * behind);
    const glm::dvec3 expected = ratio * (direction - glm::dot(direction, normal) * normal) - cosine * normal;
    EXPECT_LT(glm::distance(glm::dvec3(found), expected), 1e-6 + 1e-6 / cosine);
    EXPECT_NEAR(glm::length(glm::cross(glm::dvec3(found), normal)), behind, 1e-5);
    EXPECT_LT(glm::dot(glm::dvec3(found), normal), 0);
  }
  EXPECT_GT(total, 1000);
}

/// Fresnel's equations by the angles of both rays (Born and Wolf, "Principles of Optics", 1.5.2).
double reflectance_by_angles(double angle, double behind) {
  if (angle == 0) return 0;
  const double across = std::sin(angle - behind) / std::sin(angle + behind);
  const double along = std::tan(angle - behind) / std::tan(angle + behind);
  return 0.5 * (across * across + along * along);
}

TEST(OpticsTest, ReflectanceFollowsFresnelsEquations) {
  for (const double index : {1.1, 1.5, 2.4})
    for (int i = 1; i < 900; ++i) {
      const double angle = i * kPi / 1800, behind = std::asin(std::sin(angle) / index);
      const double expected = reflectance_by_angles(angle, behind);
      EXPECT_NEAR(double{shared::fresnel_reflectance(static_cast<float>(std::cos(angle)),
                                                     static_cast<float>(1 / index))},
                  expected, 1e-5);
      // From inside the same. The squared cosine outside, of which 1 is subtracted, has an error of index^2
      // times four roundings of 6e-8, at most 1.5e-6; its root one of 7e-7 / cosine; and reflectance falls
      // with it by 6.2 at most (2 / sqrt(n^2 - 1) + 2 n^2 / sqrt(n^2 - 1) for n = 2.4).
      EXPECT_NEAR(double{shared::fresnel_reflectance(static_cast<float>(std::cos(behind)),
                                                     static_cast<float>(index))},
                  expected, 1e-5 + 5e-6 / std::cos(angle));
    }
  for (const float index : {1.3f, 1.5f}) {
    const float at_right_angles = std::pow((index - 1) / (index + 1), 2.0f);
    EXPECT_NEAR(shared::fresnel_reflectance(1, index), at_right_angles, 1e-6f);
    EXPECT_NEAR(shared::fresnel_reflectance(1, 1 / index), at_right_angles, 1e-6f);
  }
}

/// Energy that leaves an ellipsoid of a ray that meets it: all that is reflected and all that passes, with
/// the functions of shared/optics.h. `first`: what is reflected outside.
struct Energy {
  double first = 0, passed = 0;
};
Energy energy_of(const shared::Glass& glass, const glm::vec3& origin, const glm::vec3& direction) {
  Energy energy;
  const glm::vec2 crossed = shared::glass_crossings(glass, origin, direction);
  glm::vec3 at = origin + crossed.x * direction, normal = shared::glass_normal(glass, at);
  energy.first = double{shared::fresnel_reflectance(-glm::dot(direction, normal), 1 / glass.index)};
  glm::vec3 inside = shared::refracted(direction, normal, 1 / glass.index);
  double rest = 1 - energy.first;
  for (int i = 0; i < 1000 && rest > 1e-9; ++i) {
    at += shared::glass_crossings(glass, at, inside).y * inside;
    normal = -shared::glass_normal(glass, at);
    const double reflected = double{shared::fresnel_reflectance(-glm::dot(inside, normal), glass.index)};
    energy.passed += rest * (1 - reflected);
    rest *= reflected;
    inside = shared::mirrored(inside, normal);
  }
  return energy;
}

TEST(OpticsTest, ABallOfGlassLosesNoEnergy) {
  // Over the disk that a ball shows to parallel light: the fraction that is reflected first is the mean of
  // Fresnel's reflectance over sin^2, 9.18 % at an index of 1.5 (twice the integral of R sin cos), and all
  // leaves.
  const shared::Glass ball{glm::vec3(1, 2, 3), 1.5f, glm::vec3(2)};
  constexpr int kRings = 4000;
  double first = 0, passed = 0, expected = 0;
  for (int i = 0; i < kRings; ++i) {
    const double sine = std::sqrt((i + 0.5) / kRings);
    const Energy energy =
        energy_of(ball, ball.center + glm::vec3(static_cast<float>(2 * sine), 0, 9), glm::vec3(0, 0, -1));
    first += energy.first / kRings;
    passed += energy.passed / kRings;
    expected += reflectance_by_angles(std::asin(sine), std::asin(sine / 1.5)) / kRings;
  }
  EXPECT_NEAR(first, expected, 1e-4);
  EXPECT_NEAR(first, 0.0918, 5e-4);
  EXPECT_NEAR(first + passed, 1, 1e-5);
}

TEST(OpticsTest, PathsThroughGlassAreThoseOfTheReference) {
  // Floats of one against doubles of the other, for the same decisions.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  const shared::Glass glass{glm::vec3(10, -20, 30), 1.6f, glm::vec3(30, 50, 20)};
  const TankLensBody body{glm::dvec3(glass.center), glm::dvec3(glass.radii), 1.6f};
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 origin = body.center + 120.0 * random_unit(random);
    const glm::dvec3 target = body.center + 25.0 * share(random) * random_unit(random);
    glm::dvec3 at = origin, direction = glm::normalize(target - origin);
    const glm::dvec2 crossed = body.crossings(at, direction);
    if (!(crossed.x < crossed.y)) continue;
    ++met;
    const glm::vec2 in_floats = shared::glass_crossings(glass, glm::vec3(at), glm::vec3(direction));
    // Near grazing, where the chord is short, errors of floats grow by its inverse.
    const double cosine = 1e-2 + (crossed.y - crossed.x) / 40;
    EXPECT_NEAR(double{in_floats.x}, crossed.x, 1e-4 / cosine);
    EXPECT_NEAR(double{in_floats.y}, crossed.y, 1e-4 / cosine);
    at += crossed.x * direction;
    const glm::dvec3 before = direction;
    const glm::vec3 normal = shared::glass_normal(glass, glm::vec3(at));
    EXPECT_TRUE(body.cross(at, false, 0.999999, direction));
    EXPECT_LT(glm::distance(direction, glm::dvec3(shared::refracted(glm::vec3(before), normal, 1 / 1.6f))),
              1e-5);
    glm::dvec3 back = before;
    if (body.cross(at, false, 0, back)) continue;  // reflects nothing
    EXPECT_LT(glm::distance(back, glm::dvec3(shared::mirrored(glm::vec3(before), normal))), 1e-5);
  }
  EXPECT_GT(met, 10000);
}

}  // namespace
}  // namespace brume::reference
