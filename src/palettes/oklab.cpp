#include "palettes/oklab.hpp"

#include <cmath>

namespace brume::palettes {
namespace {

// Rows as the source has them; glm takes columns.
const glm::dmat3 kConesFromLinear = glm::transpose(glm::dmat3(0.4122214708, 0.5363325363, 0.0514459929,  //
                                                              0.2119034982, 0.6806995451, 0.1073969566,  //
                                                              0.0883024619, 0.2817188376, 0.6299787005));
const glm::dmat3 kLabFromCones = glm::transpose(glm::dmat3(0.2104542553, 0.7936177850, -0.0040720468,  //
                                                           1.9779984951, -2.4285922050, 0.4505937099,  //
                                                           0.0259040371, 0.7827717662, -0.8086757660));
const glm::dmat3 kConesFromLab = glm::transpose(glm::dmat3(1, 0.3963377774, 0.2158037573,    //
                                                           1, -0.1055613458, -0.0638541728,  //
                                                           1, -0.0894841775, -1.2914855480));
const glm::dmat3 kLinearFromCones = glm::transpose(glm::dmat3(4.0767416621, -3.3077115913, 0.2309699292,   //
                                                              -1.2684380046, 2.6097574011, -0.3413193965,  //
                                                              -0.0041960863, -0.7034186147, 1.7076147010));

double decoded(double x) {
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

double encoded(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace

glm::dvec3 linear_from_srgb(const glm::dvec3& c) {
  return {decoded(c.x), decoded(c.y), decoded(c.z)};
}

glm::dvec3 srgb_from_linear(const glm::dvec3& c) {
  return {encoded(c.x), encoded(c.y), encoded(c.z)};
}

glm::dvec3 oklab_from_linear(const glm::dvec3& linear) {
  const glm::dvec3 cones = kConesFromLinear * linear;
  return kLabFromCones * glm::dvec3(std::cbrt(cones.x), std::cbrt(cones.y), std::cbrt(cones.z));
}

glm::dvec3 linear_from_oklab(const glm::dvec3& lab) {
  const glm::dvec3 roots = kConesFromLab * lab;
  return kLinearFromCones * (roots * roots * roots);
}

}  // namespace brume::palettes
