// Phase functions and integrals over directions in double.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "shared/phase.h"

namespace brume::reference {

/// Henyey and Greenstein 1941 times what Draine 2003 adds to it (alpha 0: nothing) [1/sr].
inline double draine(double g, double alpha, double cos_angle) {
  const double d = (1 - g) * (1 - g) + 2 * g * (1 - cos_angle);
  return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d)) * (1 + alpha * cos_angle * cos_angle) /
         (1 + alpha * (1 + 2 * g * g) / 3);
}

/// shared::phase_value.
inline double phase_value(const shared::Phase& phase, double cos_angle) {
  const double w = double{phase.draine_weight};
  return (1 - w) * draine(double{phase.g_hg}, 0, cos_angle) +
         w * draine(double{phase.g_draine}, double{phase.alpha}, cos_angle);
}

/// Eight nodes and weights of Gauss and Legendre on [-1, 1], by Newton's method.
inline std::array<std::array<double, 2>, 8> gauss_legendre() {
  std::array<std::array<double, 2>, 8> rule{};
  for (std::size_t i = 0; i < rule.size(); ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / 8.5), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double before = 1, value = x;
      for (int n = 2; n <= 8; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value;
        value = next;
      }
      slope = 8 * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule[i] = {x, 2 / ((1 - x * x) * slope * slope)};
  }
  return rule;
}

/// The integral over all directions of a function of the cosine. Panels halve towards both ends, so that a
/// peak there is resolved: a function whose singularities are real and outside of [-1, 1] is at least a
/// panel's length away from them, at 3 half-lengths from its middle, and Gauss's rule of 8 nodes is exact to
/// about (3 + sqrt 8)^-16 = 6e-13.
template <typename Function>
double integrate_directions(const Function& function) {
  const auto rule = gauss_legendre();
  double sum = 0;
  for (const double end : {-1.0, 1.0}) {
    double from = 0;
    for (int panel = 0; panel < 48; ++panel) {
      const double to = panel == 47 ? 0 : std::ldexp(1.0, -panel - 1), apart_from = panel == 0 ? 1 : from;
      for (const auto& [x, weight] : rule) {
        const double apart = 0.5 * (apart_from + to) + 0.5 * (apart_from - to) * x;  // from the end
        sum += weight * 0.5 * (apart_from - to) * function(end * (1 - apart));
      }
      from = to;
    }
  }
  return 2 * std::numbers::pi * sum;
}

}  // namespace brume::reference
