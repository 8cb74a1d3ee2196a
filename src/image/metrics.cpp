#include "image/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace brume::image {
namespace {

constexpr int kWindow = 11, kHalf = kWindow / 2;
constexpr double kWindowDeviation = 1.5, kK1 = 0.01, kK2 = 0.03;

// The range of window centres along an axis.
struct Span {
  int begin, end;
};
Span middles(std::uint32_t size) {
  const int n = static_cast<int>(size);
  return n >= kWindow ? Span{kHalf, n - kHalf} : Span{0, n};
}

// Weighted first and second moments of two planes in one window.
struct Moments {
  double weight = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
};

Moments moments(const Plane& a, const Plane& b, int x, int y, const std::array<double, kWindow>& weights) {
  Moments sum;
  const int width = static_cast<int>(a.width), height = static_cast<int>(a.height);
  for (int dy = std::max(-kHalf, -y); dy <= std::min(kHalf, height - 1 - y); ++dy) {
    for (int dx = std::max(-kHalf, -x); dx <= std::min(kHalf, width - 1 - x); ++dx) {
      const double w =
          weights[static_cast<std::size_t>(dx + kHalf)] * weights[static_cast<std::size_t>(dy + kHalf)];
      const auto at = static_cast<std::size_t>(y + dy) * a.width + static_cast<std::size_t>(x + dx);
      const double va = double{a.values[at]}, vb = double{b.values[at]};
      sum.weight += w;
      sum.a += w * va;
      sum.b += w * vb;
      sum.aa += w * va * va;
      sum.bb += w * vb * vb;
      sum.ab += w * va * vb;
    }
  }
  return sum;
}

}  // namespace

Difference difference(std::span<const float> a, std::span<const float> b) {
  BRUME_ASSERT(a.size() == b.size(), std::to_string(a.size()) + " values and " + std::to_string(b.size()));
  Difference result;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double distance = std::abs(double{a[i]} - double{b[i]});
    if (!std::isfinite(distance)) distance = std::numeric_limits<double>::infinity();
    result.max = std::max(result.max, distance);
    sum += distance;
    squares += distance * distance;
  }
  if (a.empty()) return result;
  result.mean = sum / static_cast<double>(a.size());
  result.rmse = std::sqrt(squares / static_cast<double>(a.size()));
  return result;
}

double psnr(double rmse, double peak) {
  return rmse > 0 ? 20 * std::log10(peak / rmse) : std::numeric_limits<double>::infinity();
}

std::vector<float> encoded_colours(const Image8& image) {
  std::vector<float> values;
  values.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) values.push_back(static_cast<float>(image.rgba[i]) / 255);
  return values;
}

std::vector<float> alphas(const Image8& image) {
  std::vector<float> values;
  values.reserve(image.rgba.size() / 4);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    values.push_back(static_cast<float>(image.rgba[i]) / 255);
  return values;
}

Plane luma(const Image8& image) {
  Plane plane{image.width, image.height, {}};
  plane.values.reserve(image.rgba.size() / 4);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const auto* c = &image.rgba[i];
    plane.values.push_back(static_cast<float>((0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2]) / 255));
  }
  return plane;
}

double ssim(const Plane& a, const Plane& b, double peak) {
  BRUME_ASSERT(a.width == b.width && a.height == b.height, "planes of two sizes");
  std::array<double, kWindow> weights{};
  for (int i = -kHalf; i <= kHalf; ++i)
    weights[static_cast<std::size_t>(i + kHalf)] =
        std::exp(-0.5 * i * i / (kWindowDeviation * kWindowDeviation));
  const double c1 = kK1 * peak * kK1 * peak, c2 = kK2 * peak * kK2 * peak;
  const Span across = middles(a.width), down = middles(a.height);
  double sum = 0;
  for (int y = down.begin; y < down.end; ++y) {
    for (int x = across.begin; x < across.end; ++x) {
      const Moments m = moments(a, b, x, y, weights);
      const double ma = m.a / m.weight, mb = m.b / m.weight;
      const double va = m.aa / m.weight - ma * ma, vb = m.bb / m.weight - mb * mb,
                   ab = m.ab / m.weight - ma * mb;
      sum += (2 * ma * mb + c1) * (2 * ab + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
    }
  }
  const double count = double(across.end - across.begin) * double(down.end - down.begin);
  return count > 0 ? sum / count : 1;
}

}  // namespace brume::image
