#include "volumes/decal_volume.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/similar.hpp"

namespace brume::volumes {
namespace {

using grids::Grid;

/// What faces up and what faces down: of one grid twice the same.
Result<std::vector<const Grid*>> occlusion_grids(const grids::GridFile& file, const std::string& name) {
  if (!name.empty()) {
    if (const Grid* one = find_grid(file, name)) return std::vector<const Grid*>{one, one};
    std::vector<std::string> known;
    for (const Grid& grid : file.grids) known.push_back(grid.name);
    return Failure{ErrorCode::bad_input, "has no grid \"" + name + "\"" + suggestion(name, known, "\"")};
  }
  const Grid *const up = find_grid(file, "up"), *const down = find_grid(file, "down");
  if (up && down) return std::vector{up, down};
  if (file.grids.empty()) return Failure{ErrorCode::bad_input, "has no grids"};
  return std::vector{&file.grids.front(), &file.grids.front()};
}

}  // namespace

Occluder occluder_of(const grids::DenseGrid& up, const grids::DenseGrid& down) {
  double weights = 0, squares = 0;
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < up.values.size(); ++i) {
    const double both = std::max(double{std::min(up.values[i], down.values[i])}, 0.0), weight = both * both;
    const glm::dvec3 voxel(i % up.size.x, i / up.size.x % up.size.y, i / up.size.x / up.size.y);
    const glm::dvec3 at = up.voxel_size() * (voxel + 0.5);
    weights += weight;
    sum += weight * at;
    squares += weight * glm::dot(at, at);
  }
  if (!(weights > 0 && std::isfinite(squares))) return {};
  const glm::dvec3 mean = sum / weights;
  return {up.box.low + mean, std::sqrt(2 * std::max(squares / weights - glm::dot(mean, mean), 0.0))};
}

const Grid* find_grid(const grids::GridFile& file, const std::string& name) {
  const auto found = std::ranges::find(file.grids, name, &Grid::name);
  return found == file.grids.end() ? nullptr : &*found;
}

Result<SampledGrids> sample_grids(std::span<const Grid* const> chosen, std::uint64_t most_voxels) {
  const auto box = grids::box_of(chosen);
  if (!box) return box.failure();
  const auto voxels = std::uint64_t{box->size.x} * box->size.y * box->size.z;
  if (voxels > most_voxels)
    return Failure{ErrorCode::resource_limit, "has " + std::to_string(voxels) + " voxels; at most " +
                                                  std::to_string(most_voxels) + " are sampled"};
  auto volume = std::make_shared<grids::DenseVolume>();
  for (const Grid* grid : chosen) {
    auto dense = grids::resample(*grid, *box);
    if (!dense) return dense.failure();
    volume->push_back(std::move(*dense));
  }
  return SampledGrids{std::move(volume), box->world_from_box};
}

Result<SampledGrids> decal_volume(const grids::GridFile& file, const std::string& grid) {
  const auto chosen = occlusion_grids(file, grid);
  if (!chosen) return chosen.failure();
  auto sampled = sample_grids(*chosen);
  // One grid twice is the same for all normals.
  if (sampled && chosen->front() != chosen->back())
    sampled->occluder = occluder_of(sampled->volume->front(), sampled->volume->back());
  return sampled;
}

}  // namespace brume::volumes
