// Photons in cells, and what a point gathers of them.
#include <algorithm>
#include <bit>

#include "core/tasks.hpp"
#include "spheres/light_paths.hpp"

namespace brume::spheres {

LightPaths sort_photons(std::vector<shared::Photon> photons, float radius) {
  LightPaths paths;
  if (photons.empty()) return paths;
  const std::uint32_t hashes = std::bit_ceil(static_cast<std::uint32_t>(photons.size()));
  paths.grid = {radius, hashes - 1};
  std::vector<std::uint32_t> keys(photons.size());
  parallel_for(photons.size(), 1u << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = shared::photon_hash(paths.grid, shared::photon_cell(paths.grid, photons[i].position));
  });

  // By counting.
  paths.cells.assign(std::size_t{hashes} + 1, 0);
  for (const std::uint32_t key : keys) ++paths.cells[std::size_t{key} + 1];
  for (std::size_t i = 1; i < paths.cells.size(); ++i) paths.cells[i] += paths.cells[i - 1];
  std::vector<std::uint32_t> next(paths.cells.begin(), paths.cells.end() - 1);
  paths.photons.resize(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i) paths.photons[next[keys[i]]++] = photons[i];
  return paths;
}

glm::vec3 LightPaths::gather(const glm::vec3& at, std::uint32_t sphere, const Sphere& ball,
                             float extinction) const {
  glm::vec3 sum(0);
  if (photons.empty()) return sum;
  const bool is_medium = extinction > 0;
  const glm::vec3 normal = glm::normalize(at - ball.center);
  const glm::ivec3 corner = shared::photon_corner(grid, at);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 cell = corner + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    const std::uint32_t hash = shared::photon_hash(grid, cell);
    for (std::uint32_t k = cells[hash]; k < cells[std::size_t{hash} + 1]; ++k) {
      const shared::Photon& photon = photons[k];
      if (!shared::photon_counts(grid, photon, cell, sphere + 1, at)) continue;
      const float cosine = -glm::dot(normal, shared::unpacked_direction(photon.direction));
      sum += photon.flux * (is_medium ? 1.0f : shared::photon_per_area(grid.radius, ball.radius, cosine));
    }
  }
  if (!is_medium) return sum;
  return sum *
         shared::photon_per_volume(grid.radius, ball.radius, glm::distance(at, ball.center), extinction);
}

glm::dvec3 LightPaths::flux() const {
  glm::dvec3 sum(0);
  for (const shared::Photon& photon : photons) sum += glm::dvec3(photon.flux);
  return sum;
}

}  // namespace brume::spheres
