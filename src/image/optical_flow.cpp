#include "image/optical_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace brume::image {
namespace {

// What is followed: brightness and alpha, each at most 1.
using Feature = glm::vec2;

// Values at the texels of a picture.
template <typename Value>
struct Raster {
  int width = 0, height = 0;
  std::vector<Value> values;

  Raster(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  }
  Value& at(int x, int y) { return values[index(x, y)]; }
  const Value& at(int x, int y) const { return values[index(x, y)]; }
  // Linearly interpolated; continues the rim.
  Value sample(glm::vec2 p) const {
    const glm::vec2 low = glm::floor(p), f = p - low;
    const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), f.x), glm::mix(at(x, y + 1), at(x + 1, y + 1), f.x),
                    f.y);
  }
};

constexpr int kLeastEdge = 8;         // Shortest edge of the coarsest level [texels].
constexpr int kWarps = 4;             // Warps of each level.
constexpr int kSweeps = 40;           // Sweeps over the linear system of a warp.
constexpr float kSmoothness = 1e-2f;  // Weight of differences of neighbours [1 / texel^2].
constexpr float kMostStep =
    2;  // Most that a warp changes the flow [texels]: its linearization holds for less.

float brightness(glm::vec4 texel) {
  return std::max(glm::dot(glm::vec3(texel), glm::vec3(0.2126f, 0.7152f, 0.0722f)), 0.0f);
}

// Both pictures by the same scale, so that faint smoke is followed as well as a dense one.
float brightest_of(const Texels& a, const Texels& b) {
  float most = 0;
  for (const Texels* picture : {&a, &b})
    for (const glm::vec4& texel : picture->rgba) most = std::max(most, brightness(texel));
  return std::isfinite(most) ? most : 65504.0f;
}

Raster<Feature> features_of(const Texels& picture, float brightest) {
  Raster<Feature> features(static_cast<int>(picture.width), static_cast<int>(picture.height));
  for (std::size_t i = 0; i < features.values.size(); ++i) {
    const float light = brightest > 0 ? std::min(brightness(picture.rgba[i]) / brightest, 1.0f) : 0;
    // As displays encode it: dark detail counts.
    features.values[i] = {std::sqrt(light), std::clamp(picture.rgba[i].a, 0.0f, 1.0f)};
  }
  return features;
}

Raster<Feature> halved(const Raster<Feature>& from) {
  Raster<Feature> half((from.width + 1) / 2, (from.height + 1) / 2);
  // 1 3 3 1 in each direction, around the middle of two by two.
  constexpr std::array kWeights{1.0f / 8, 3.0f / 8, 3.0f / 8, 1.0f / 8};
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          half.at(x, y) += kWeights[static_cast<std::size_t>(i)] * kWeights[static_cast<std::size_t>(j)] *
                           from.at(2 * x - 1 + i, 2 * y - 1 + j);
  return half;
}

// The equation of brightness at a texel, of both features: [xx xy; xy yy] * flow = right.
struct Equation {
  float xx = 0, xy = 0, yy = 0;
  glm::vec2 right{0};
};

// Linearized around the flow so far.
Raster<Equation> make_equations(const Raster<Feature>& from, const Raster<Feature>& to,
                                const Raster<glm::vec2>& flow) {
  Raster<Feature> there(from.width, from.height);
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) there.at(x, y) = to.sample(glm::vec2(x, y) + flow.at(x, y));
  Raster<Equation> equations(from.width, from.height);
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const Feature dx =
          0.25f * (there.at(x + 1, y) - there.at(x - 1, y) + from.at(x + 1, y) - from.at(x - 1, y));
      const Feature dy =
          0.25f * (there.at(x, y + 1) - there.at(x, y - 1) + from.at(x, y + 1) - from.at(x, y - 1));
      const glm::vec2 known = flow.at(x, y);
      const Feature rest = known.x * dx + known.y * dy - (there.at(x, y) - from.at(x, y));
      equations.at(x, y) = {
          glm::dot(dx, dx), glm::dot(dx, dy), glm::dot(dy, dy), {glm::dot(dx, rest), glm::dot(dy, rest)}};
    }
  }
  return equations;
}

// Gauss-Seidel sweeps over the equations and the differences of neighbours.
void solve(const Raster<Equation>& equations, Raster<glm::vec2>& flow) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int y = 0; y < flow.height; ++y) {
      for (int x = 0; x < flow.width; ++x) {
        const Equation& e = equations.at(x, y);
        const glm::vec2 around =
            flow.at(x - 1, y) + flow.at(x + 1, y) + flow.at(x, y - 1) + flow.at(x, y + 1);
        const float xx = e.xx + 4 * kSmoothness, yy = e.yy + 4 * kSmoothness;
        const glm::vec2 right = e.right + kSmoothness * around;
        const float determinant = xx * yy - e.xy * e.xy;
        flow.at(x, y) = glm::vec2(yy * right.x - e.xy * right.y, xx * right.y - e.xy * right.x) / determinant;
      }
    }
  }
}

Raster<glm::vec2> flow_between(const Raster<Feature>& from, const Raster<Feature>& to) {
  Raster<glm::vec2> flow(from.width, from.height);
  if (std::min(from.width, from.height) >= 2 * kLeastEdge) {
    const Raster<glm::vec2> coarse = flow_between(halved(from), halved(to));
    for (int y = 0; y < flow.height; ++y)
      for (int x = 0; x < flow.width; ++x)
        flow.at(x, y) = 2.0f * coarse.sample(0.5f * glm::vec2(x, y) - 0.25f);
  }
  for (int warp = 0; warp < kWarps; ++warp) {
    const Raster<glm::vec2> before = flow;
    solve(make_equations(from, to, flow), flow);
    for (std::size_t i = 0; i < flow.values.size(); ++i) {
      const glm::vec2 step = flow.values[i] - before.values[i];
      if (const float length = glm::length(step); length > kMostStep)
        flow.values[i] = before.values[i] + step * (kMostStep / length);
    }
  }
  return flow;
}

}  // namespace

std::vector<glm::vec2> optical_flow(const Texels& from, const Texels& to) {
  const float brightest = brightest_of(from, to);
  return flow_between(features_of(from, brightest), features_of(to, brightest)).values;
}

Texels warped(const Texels& picture, const std::vector<glm::vec2>& offset) {
  Texels moved = picture;
  const glm::ivec2 size(picture.width, picture.height);
  const auto texel = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= size.x || y >= size.y) return glm::vec4(0);
    return picture.rgba[static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x);
      const glm::vec2 p = glm::clamp(glm::vec2(x, y) + offset[i], glm::vec2(-1), glm::vec2(size));
      const glm::vec2 low = glm::floor(p), f = p - low;
      const glm::ivec2 at(low);
      moved.rgba[i] = glm::mix(glm::mix(texel(at.x, at.y), texel(at.x + 1, at.y), f.x),
                               glm::mix(texel(at.x, at.y + 1), texel(at.x + 1, at.y + 1), f.x), f.y);
    }
  }
  return moved;
}

}  // namespace brume::image
