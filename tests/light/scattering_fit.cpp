#include "tests/light/scattering_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/reference/phase.hpp"

namespace brume::reference {
namespace {

shared::ManyFit fit_of(const std::vector<double>& p) {
  const auto f = [&](std::size_t i) { return static_cast<float>(p[i]); };
  return {f(0), std::min(f(1), 0.9999f), f(2), f(3), std::min(f(4), 0.9999f), f(5), f(6)};
}

}  // namespace

double misfit(std::span<const ScatteringSample> samples, const ManyFormula& formula) {
  double sum = 0;
  for (const ScatteringSample& s : samples) {
    const double dark = 0.004 * s.irradiance;
    const double ratio = (s.once + s.irradiance * formula(s) + dark) / (s.once + s.more + dark);
    sum += ratio > 0 ? std::log(ratio) * std::log(ratio) : 100;
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

double many_of(const shared::ManyFit& fit, const ScatteringSample& s) {
  const shared::ManyScatterings many = shared::multiple_scattering(
      fit, glm::vec3(static_cast<float>(s.albedo)), static_cast<float>(s.g), static_cast<float>(s.escape));
  return double{many.fraction.x} * std::exp(-double{many.decay.x} * s.depth) *
         draine(double{many.g}, 0, s.cos_angle);
}

double octaves(double a, double b, double c, const ScatteringSample& s) {
  double sum = 0;
  for (int i = 1; i <= 2; ++i)
    sum +=
        std::pow(b, i) * std::exp(-std::pow(a, i) * s.depth) * draine(std::pow(c, i) * s.g, 0, s.cos_angle);
  return sum;
}

double guessed_octaves(const ScatteringSample& s) {
  return octaves(0.5, 0.5, 0.5, s);
}

std::vector<double> minimize(const std::function<double(const std::vector<double>&)>& cost,
                             std::vector<double> start, double step, int iterations) {
  struct Corner {
    std::vector<double> at;
    double cost;
  };
  const std::size_t n = start.size();
  std::vector<Corner> corners{{start, cost(start)}};
  for (std::size_t i = 0; i < n; ++i) {
    auto at = start;
    at[i] += step;
    corners.push_back({at, cost(at)});
  }
  const auto by_cost = [](const Corner& a, const Corner& b) { return a.cost < b.cost; };
  for (int k = 0; k < iterations; ++k) {
    std::stable_sort(corners.begin(), corners.end(), by_cost);
    std::vector<double> middle(n, 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) middle[j] += corners[i].at[j] / static_cast<double>(n);
    Corner& worst = corners.back();
    const auto along = [&](double share) {
      std::vector<double> at(n);
      for (std::size_t j = 0; j < n; ++j) at[j] = middle[j] + share * (worst.at[j] - middle[j]);
      const double value = cost(at);
      return Corner{std::move(at), value};
    };
    const Corner mirrored = along(-1);
    if (mirrored.cost < corners.front().cost) {
      const Corner further = along(-2);
      worst = further.cost < mirrored.cost ? further : mirrored;
    } else if (mirrored.cost < corners[n - 1].cost) {
      worst = mirrored;
    } else {
      const Corner nearer = along(mirrored.cost < worst.cost ? -0.5 : 0.5);
      if (nearer.cost < std::min(mirrored.cost, worst.cost)) {
        worst = nearer;
      } else {
        for (std::size_t i = 1; i <= n; ++i) {
          for (std::size_t j = 0; j < n; ++j) corners[i].at[j] = 0.5 * (corners[i].at[j] + corners[0].at[j]);
          corners[i].cost = cost(corners[i].at);
        }
      }
    }
  }
  return std::min_element(corners.begin(), corners.end(), by_cost)->at;
}

shared::ManyFit fit_many(std::span<const ScatteringSample> samples) {
  const auto cost = [&](const std::vector<double>& p) {
    if (p[0] <= 0 || p[1] < 0 || p[4] < 0) return 1e9;
    const shared::ManyFit fit = fit_of(p);
    return misfit(samples, [&](const ScatteringSample& s) { return many_of(fit, s); });
  };
  std::vector<double> best{1, 0.9, 0.8, 0.5, 0.7, 3, 4};
  for (const double step : {0.2, 0.05, 0.2}) best = minimize(cost, best, step, 250);
  return fit_of(best);
}

}  // namespace brume::reference
