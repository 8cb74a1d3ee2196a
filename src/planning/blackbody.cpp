#include "planning/blackbody.hpp"

#include <algorithm>
#include <cmath>

namespace brume::planning {
namespace {

/// Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions";
/// wavelength in nanometres.
glm::dvec3 color_matching(double nm) {
  const auto lobe = [nm](double height, double middle, double below, double above) {
    const double t = (nm - middle) * (nm < middle ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) +
              lobe(-0.065, 501.1, 0.0490, 0.0382),
          lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
          lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

/// Planck's law up to a factor.
double planck(double nm, double kelvin) {
  constexpr double kSecondConstant = 1.438776877e7;  // h c / k [nm K]
  return 1 / (std::pow(nm * 1e-3, 5) * std::expm1(kSecondConstant / (nm * kelvin)));
}

}  // namespace

glm::vec3 blackbody_color(float kelvin) {
  if (!(kelvin >= 400)) return glm::vec3(0);
  glm::dvec3 xyz(0);
  for (double nm = 380; nm <= 780; nm += 5) xyz += color_matching(nm) * planck(nm, double{kelvin});
  const glm::dvec3 x = xyz / xyz.y;
  const glm::dvec3 rgb(3.2406 * x.x - 1.5372 * x.y - 0.4986 * x.z,
                       -0.9689 * x.x + 1.8758 * x.y + 0.0415 * x.z,
                       0.0557 * x.x - 0.2040 * x.y + 1.0570 * x.z);
  const double ratio = double{kelvin} / double{kUnitGlow};
  return glm::vec3(glm::max(rgb, 0.0) * (ratio * ratio * ratio * ratio));
}

}  // namespace brume::planning
