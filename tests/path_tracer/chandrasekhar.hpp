// Light reflected and transmitted by a slab that scatters evenly in all directions (Chandrasekhar 1960,
// "Radiative Transfer", chapters 7 and 8), in double precision.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace brume::reference {

/// Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method from Tricomi's starting points.
inline std::vector<std::pair<double, double>> gauss_nodes(int count) {
  std::vector<std::pair<double, double>> nodes;
  for (int i = 1; i <= count; ++i) {
    double x = std::cos(std::numbers::pi * (i - 0.25) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= count; ++k)
        before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
      slope = count * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    nodes.emplace_back((1 - x) / 2, 1 / ((1 - x * x) * slope * slope));
  }
  return nodes;
}

/// The radiances that a slab of depth `depth` and this albedo reflects towards cosine `mu` and transmits with
/// scattering, for a beam of cosine `mu0` that has unit irradiance on a surface that faces it.
struct SlabLight {
  double reflected = 0, transmitted = 0;
};
inline SlabLight slab_light(double albedo, double depth, double mu, double mu0) {
  // X and Y grow with the slab: dX/dt = Y I, dY/dt = X I - Y / mu, I the integral of albedo/2 Y / mu.
  std::vector<std::pair<double, double>> nodes = gauss_nodes(24);
  nodes.emplace_back(mu, 0.0);
  nodes.emplace_back(mu0, 0.0);
  using Values = std::vector<std::pair<double, double>>;
  Values values(nodes.size(), {1.0, 1.0});
  const auto slopes = [&](const Values& at) {
    double integral = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      integral += nodes[i].second * albedo / 2 * at[i].second / nodes[i].first;
    Values slope(at.size());
    for (std::size_t i = 0; i < at.size(); ++i)
      slope[i] = {at[i].second * integral, at[i].first * integral - at[i].second / nodes[i].first};
    return slope;
  };
  const auto moved = [](Values at, const Values& slope, double by) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i].first += by * slope[i].first;
      at[i].second += by * slope[i].second;
    }
    return at;
  };
  const int steps = static_cast<int>(std::ceil(depth / 1e-3));
  const double dt = depth / steps;
  for (int step = 0; step < steps; ++step) {
    const Values a = slopes(values), b = slopes(moved(values, a, dt / 2)),
                 c = slopes(moved(values, b, dt / 2)), d = slopes(moved(values, c, dt));
    for (const auto& [slope, weight] :
         {std::pair(&a, 1.0), std::pair(&b, 2.0), std::pair(&c, 2.0), std::pair(&d, 1.0)})
      values = moved(std::move(values), *slope, weight * dt / 6);
  }
  const auto [x, y] = values[nodes.size() - 2];
  const auto [x0, y0] = values[nodes.size() - 1];
  const double flux = albedo / (4 * std::numbers::pi) * mu0;
  return {flux / (mu + mu0) * (x * x0 - y * y0), flux / (mu - mu0) * (y * x0 - x * y0)};
}

/// The same of a half-space: H by iteration of its integral equation.
inline double half_space_light(double albedo, double mu, double mu0) {
  const auto nodes = gauss_nodes(64);
  std::vector<double> h(nodes.size(), 1.0);
  const auto value = [&](double at) {
    double integral = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      integral += nodes[i].second * albedo / 2 * h[i] * nodes[i].first / (at + nodes[i].first);
    return 1 / (std::sqrt(1 - albedo) + integral);
  };
  for (int step = 0; step < 2000; ++step) {
    std::vector<double> next;
    for (const auto& node : nodes) next.push_back(value(node.first));
    h = std::move(next);
  }
  return albedo / (4 * std::numbers::pi) * mu0 / (mu + mu0) * value(mu) * value(mu0);
}

}  // namespace brume::reference
