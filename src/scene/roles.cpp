#include "scene/roles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace brume::scene {
namespace {

constexpr int kRows = 8;  // rows of places in a triangle: 8 * 9 / 2 = 36
constexpr std::uint64_t kFew = 64;
constexpr double kOpaque = 0.5, kHole = 1.0 / 16;

/// The alpha of the texel at a place.
double texel_alpha(const Image& image, glm::dvec2 uv) {
  const auto index = [](double at, std::uint32_t size, Wrap wrap) {
    const double texel = std::floor(wrapped_coordinate(at, wrap) * size);
    return std::size_t{std::isfinite(texel) ? wrapped_texel(static_cast<std::int64_t>(texel), size, wrap)
                                            : 0};
  };
  const image::Image8& pixels = image.pixels;
  const std::size_t texel =
      index(uv.x, pixels.width, image.wraps.u) + pixels.width * index(uv.y, pixels.height, image.wraps.v);
  return pixels.rgba[4 * texel + 3] / 255.0;
}

}  // namespace

std::optional<Role> role_of_prefix(std::string_view name) {
  if (name.starts_with("IGNORE_")) return Role::ghost;
  if (name.starts_with("GLASS_")) return Role::glass;
  if (name.starts_with("GRILLE_")) return Role::grille;
  return std::nullopt;
}

Role role_of_alpha(const Mesh& mesh, const Alpha& alpha) {
  std::uint64_t places = 0, cut = 0, holes = 0, opaque = 0;
  const bool has_texels = alpha.image && !alpha.image->pixels.rgba.empty();
  const auto add = [&](const std::array<const Vertex*, 3>& corners, double u, double v) {
    // Exact where all corners have the same alpha.
    const auto at = [&](const auto& first, const auto& second, const auto& third) {
      return first + u * (second - first) + v * (third - first);
    };
    const auto uv_of = [&](std::size_t k) { return glm::dvec2(corners[k]->uv); };
    const auto alpha_of = [&](std::size_t k) { return double{corners[k]->color.a}; };
    double a = alpha.factor * at(alpha_of(0), alpha_of(1), alpha_of(2));
    if (has_texels) a *= texel_alpha(*alpha.image, at(uv_of(0), uv_of(1), uv_of(2)));
    ++places;
    opaque += a >= kOpaque;
    if (a >= alpha.cutoff) return;
    ++cut;
    holes += a < kHole;
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<const Vertex*, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &mesh.vertices[mesh.indices[i + k]];
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; row + column < kRows; ++column)
        add(corners, (row + 1.0 / 3) / kRows, (column + 1.0 / 3) / kRows);
  }
  if (places == 0) return Role::wall;
  if (opaque == 0 || cut == places) return Role::glass;
  if (cut * kFew < places) return Role::wall;
  return holes * kFew < places ? Role::glass : Role::grille;
}

}  // namespace brume::scene
