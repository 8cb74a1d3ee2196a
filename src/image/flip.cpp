// FLIP for low dynamic range images: Andersson et al. 2020, "FLIP: A Difference Evaluator for
// Alternating Images".
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "core/tasks.hpp"
#include "image/metrics.hpp"

namespace brume::image {
namespace {

constexpr double kPi = std::numbers::pi;

// The paper's constants: exponents of the colour and the feature difference, the knee of the colour
// difference, and the width of a feature [degrees].
constexpr double kColourExponent = 0.7, kBendAt = 0.4, kBendTo = 0.95, kFeatureExponent = 0.5,
                 kFeatureWidth = 0.082;

// Contrast sensitivity of the opponent channels: sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
// degrees (Table 1 of the paper).
struct Gaussian {
  double a, b;
};
constexpr Gaussian kLuminance{1, 0.0047}, kRedGreen{1, 0.0053}, kBlueYellow{34.1, 0.04},
    kBlueYellowToo{13.5, 0.025};

// XYZ of the primaries of sRGB (columns) under D65, exact from their chromaticities; white is their sum.
const glm::dmat3 kXyzFromRgb{{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                             {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                             {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::dvec3 kWhite = kXyzFromRgb * glm::dvec3(1);

double linear_from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
}

// YCxCz: linear opponent colours.
glm::dvec3 opponent_from_rgb(glm::dvec3 rgb) {
  const glm::dvec3 v = kXyzFromRgb * rgb / kWhite;
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}
glm::dvec3 rgb_from_opponent(glm::dvec3 c) {
  const double y = (c.x + 16) / 116;
  return kRgbFromXyz * (glm::dvec3(y + c.y / 500, y, y - c.z / 200) * kWhite);
}

// CIELAB with the Hunt effect: colours fade as they darken.
glm::dvec3 hunt_lab_from_rgb(glm::dvec3 rgb) {
  const glm::dvec3 v = kXyzFromRgb * rgb / kWhite;
  const auto f = [](double t) {
    constexpr double kEdge = 6.0 / 29;
    return t > kEdge * kEdge * kEdge ? std::cbrt(t) : t / (3 * kEdge * kEdge) + 4.0 / 29;
  };
  const double lightness = 116 * f(v.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(v.x) - f(v.y)), 0.01 * lightness * 200 * (f(v.y) - f(v.z))};
}

// Abasi et al. 2020: city-block distance in lightness, Euclidean in chromaticity.
double hyab(glm::dvec3 a, glm::dvec3 b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

template <typename T>
struct Field {
  int width = 0, height = 0;
  std::vector<T> values;
  T at(int x, int y) const {
    return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  }
};

// Weights for offsets -radius .. radius.
using Kernel = std::vector<double>;

template <typename Weight>
Kernel kernel(int radius, const Weight& weight) {
  Kernel weights;
  for (int i = -radius; i <= radius; ++i) weights.push_back(weight(double(i)));
  return weights;
}

// A separable filter: one kernel along x, another along y.
template <typename T>
Field<T> filtered(const Field<T>& in, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size()) / 2;
  Field<T> rows{in.width, in.height, std::vector<T>(in.values.size())}, out = rows;
  const auto pass = [&](const Field<T>& from, Field<T>& to, const Kernel& weights, int dx, int dy) {
    parallel_for(static_cast<std::size_t>(in.height), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin * static_cast<std::size_t>(in.width);
           at < end * static_cast<std::size_t>(in.width); ++at) {
        const int x = static_cast<int>(at % static_cast<std::size_t>(in.width));
        const int y = static_cast<int>(at / static_cast<std::size_t>(in.width));
        T sum(0);
        for (int i = -radius; i <= radius; ++i)
          sum += from.at(x + i * dx, y + i * dy) * weights[static_cast<std::size_t>(i + radius)];
        to.values[at] = sum;
      }
    });
  };
  pass(in, rows, across, 1, 0);
  pass(rows, out, down, 0, 1);
  return out;
}

// The image filtered by contrast sensitivity, in CIELAB.
Field<glm::dvec3> perceived_lab(const Field<glm::dvec3>& opponent, double pixels_per_degree) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kBlueYellow.b / (2 * kPi * kPi)) * pixels_per_degree));
  const auto blurred = [&](const Gaussian& g, double& total) {
    Kernel weights = kernel(radius, [&](double i) {
      const double x = i / pixels_per_degree;
      return std::exp(-kPi * kPi * x * x / g.b);
    });
    double sum = 0;
    for (const double w : weights) sum += w;
    for (double& w : weights) w /= sum;
    total = g.a * std::sqrt(kPi / g.b) * sum * sum;
    return filtered(opponent, weights, weights);
  };
  double unused = 0, wide = 0, narrow = 0;
  const auto y = blurred(kLuminance, unused), x = blurred(kRedGreen, unused);
  const auto z1 = blurred(kBlueYellow, wide), z2 = blurred(kBlueYellowToo, narrow);
  Field<glm::dvec3> lab = opponent;
  for (std::size_t i = 0; i < lab.values.size(); ++i) {
    const double z = (wide * z1.values[i].z + narrow * z2.values[i].z) / (wide + narrow);
    const glm::dvec3 rgb = rgb_from_opponent({y.values[i].x, x.values[i].y, z});
    lab.values[i] = hunt_lab_from_rgb(glm::clamp(rgb, 0.0, 1.0));
  }
  return lab;
}

// The strength of edges and points: magnitudes of the first and second derivatives.
struct Features {
  std::vector<double> edges, points;
};

Features features(const Field<double>& lightness, double pixels_per_degree) {
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree, square = deviation * deviation;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto bell = [&](double i) { return std::exp(-i * i / (2 * square)); };
  // Normalize each derivative: its positive weights sum to 1, its negative ones to -1.
  const auto balanced = [](Kernel weights) {
    double plus = 0, minus = 0;
    for (const double w : weights) (w > 0 ? plus : minus) += std::abs(w);
    for (double& w : weights) w /= w > 0 ? plus : minus;
    return weights;
  };
  Kernel smooth = kernel(radius, bell);
  double sum = 0;
  for (const double w : smooth) sum += w;
  for (double& w : smooth) w /= sum;
  const Kernel slope = balanced(kernel(radius, [&](double i) { return -i * bell(i); }));
  const Kernel bend = balanced(kernel(radius, [&](double i) { return (i * i / square - 1) * bell(i); }));
  const auto lengths = [&](const Kernel& derivative) {
    const auto x = filtered(lightness, derivative, smooth), y = filtered(lightness, smooth, derivative);
    std::vector<double> out(x.values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(x.values[i], y.values[i]);
    return out;
  };
  return {lengths(slope), lengths(bend)};
}

struct Perceived {
  Field<glm::dvec3> lab;
  Features features;
};

Perceived perceive(const Image8& image, double pixels_per_degree) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  Field<glm::dvec3> opponent{width, height, {}};
  Field<double> lightness{width, height, {}};
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const auto channel = [&](std::size_t c) { return linear_from_srgb(image.rgba[i + c] / 255.0); };
    opponent.values.push_back(opponent_from_rgb({channel(0), channel(1), channel(2)}));
    lightness.values.push_back((opponent.values.back().x + 16) / 116);
  }
  return {perceived_lab(opponent, pixels_per_degree), features(lightness, pixels_per_degree)};
}

}  // namespace

Plane flip(const Image8& reference, const Image8& test, double pixels_per_degree) {
  BRUME_ASSERT(reference.width == test.width && reference.height == test.height, "images of two sizes");
  const Perceived a = perceive(reference, pixels_per_degree), b = perceive(test, pixels_per_degree);
  // Green and blue are the most distant colours of a screen.
  const double most =
      std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), kColourExponent);
  const double bend = kBendAt * most;
  Plane map{reference.width, reference.height, {}};
  map.values.reserve(a.lab.values.size());
  for (std::size_t i = 0; i < a.lab.values.size(); ++i) {
    const double apart = std::pow(hyab(a.lab.values[i], b.lab.values[i]), kColourExponent);
    const double colour =
        apart < bend ? kBendTo / bend * apart : kBendTo + (apart - bend) / (most - bend) * (1 - kBendTo);
    const double edge = std::abs(a.features.edges[i] - b.features.edges[i]);
    const double point = std::abs(a.features.points[i] - b.features.points[i]);
    const double feature = std::pow(std::max(edge, point) / std::sqrt(2.0), kFeatureExponent);
    map.values.push_back(static_cast<float>(std::pow(std::min(colour, 1.0), 1 - std::min(feature, 1.0))));
  }
  return map;
}

Image8 heat_map(const Plane& map) {
  constexpr std::array<glm::vec3, 6> kStops{
      {{0, 0, 0}, {64, 18, 110}, {148, 38, 103}, {221, 81, 58}, {251, 165, 36}, {252, 253, 191}}};
  Image8 image{map.width, map.height, {}};
  image.rgba.reserve(4 * map.values.size());
  for (const float value : map.values) {
    const float at = std::clamp(value, 0.0f, 1.0f) * static_cast<float>(kStops.size() - 1);
    const std::size_t stop = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
    const glm::vec3 colour = glm::mix(kStops[stop], kStops[stop + 1], at - static_cast<float>(stop));
    for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(std::lround(colour[c])));
    image.rgba.push_back(255);
  }
  return image;
}

}  // namespace brume::image
