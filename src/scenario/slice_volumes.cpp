#include "scenario/slice_volumes.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "core/similar.hpp"
#include "grids/files.hpp"
#include "grids/slice_layout.hpp"

namespace brume::scenario {
namespace {

using grids::Grid;

/// The grid of a name; null: there is none.
const Grid* find_grid(const grids::GridFile& file, const std::string& name) {
  const auto found = std::ranges::find(file.grids, name, &Grid::name);
  return found == file.grids.end() ? nullptr : &*found;
}

/// What faces up and what faces down: of one grid twice the same.
Result<std::vector<const Grid*>> occlusion_grids(const grids::GridFile& file,
                                                 const scene::DecalOptions& decal) {
  if (!decal.grid.empty()) {
    if (const Grid* one = find_grid(file, decal.grid)) return std::vector<const Grid*>{one, one};
    std::vector<std::string> known;
    for (const Grid& grid : file.grids) known.push_back(grid.name);
    return Failure{ErrorCode::bad_input,
                   "has no grid \"" + decal.grid + "\"" + suggestion(decal.grid, known, "\"")};
  }
  const Grid *const up = find_grid(file, "up"), *const down = find_grid(file, "down");
  if (up && down) return std::vector{up, down};
  if (file.grids.empty()) return Failure{ErrorCode::bad_input, "has no grids"};
  return std::vector{&file.grids.front(), &file.grids.front()};
}

struct Loaded {
  grids::DenseVolume volume;
  glm::dmat4 file_from_box{1};
};

Result<Loaded> resampled(std::span<const Grid* const> chosen) {
  const auto box = grids::box_of(chosen);
  if (!box) return box.failure();
  const auto voxels = std::uint64_t{box->size.x} * box->size.y * box->size.z;
  if (voxels > grids::kMostAtlasTexels)
    return Failure{ErrorCode::resource_limit, "has " + std::to_string(voxels) + " voxels; at most " +
                                                  std::to_string(grids::kMostAtlasTexels) + " are sampled"};
  Loaded loaded{{}, box->world_from_box};
  for (const Grid* grid : chosen) {
    auto dense = grids::resample(*grid, *box);
    if (!dense) return dense.failure();
    loaded.volume.push_back(std::move(*dense));
  }
  return loaded;
}

Result<Loaded> load_decal(const scene::DecalOptions& decal) {
  const auto failed = [&](const Failure& failure, const std::string& file) {
    return Failure{failure.code, (decal.place.empty() ? "" : decal.place + ": ") + file + failure.message};
  };
  const auto file = grids::load_grid_file(decal.file);
  if (!file) return failed(file.failure(), "");
  const auto chosen = occlusion_grids(*file, decal);
  if (!chosen) return failed(chosen.failure(), decal.file.string() + ": ");
  auto loaded = resampled(*chosen);
  if (!loaded) return failed(loaded.failure(), decal.file.string() + ": ");
  return loaded;
}

}  // namespace

Result<SliceVolumes> load_slice_volumes(const scene::Timeline& timeline) {
  SliceVolumes slices;
  auto volumes = std::make_shared<std::vector<grids::DenseVolume>>();
  for (std::size_t i = 0; i < timeline.decals.size(); ++i) {
    const scene::DecalOptions& decal = timeline.decals[i];
    // Decals of one file have one volume.
    const auto same =
        std::find_if(timeline.decals.begin(), timeline.decals.begin() + static_cast<std::ptrdiff_t>(i),
                     [&](const scene::DecalOptions& other) {
                       return other.file == decal.file && other.grid == decal.grid;
                     });
    const auto first = static_cast<std::size_t>(same - timeline.decals.begin());
    if (first < i) {
      slices.of_decals.push_back(slices.of_decals[first]);
      continue;
    }
    auto loaded = load_decal(decal);
    if (!loaded) return loaded.failure();
    slices.of_decals.push_back({volumes->size(), glm::mat4(loaded->file_from_box)});
    volumes->push_back(std::move(loaded->volume));
  }
  if (!volumes->empty()) slices.volumes = std::move(volumes);
  return slices;
}

std::vector<std::filesystem::path> slice_files_of(const scene::Timeline& timeline) {
  std::vector<std::filesystem::path> files;
  for (const scene::DecalOptions& decal : timeline.decals) {
    const auto all = grids::files_of(decal.file);
    if (all) files.insert(files.end(), all->begin(), all->end());
  }
  return files;
}

glm::mat4 world_from_file(std::span<const scene::Carrier> carriers, const scene::DecalOptions& decal,
                          double seconds) {
  const glm::mat4 placed = scene::pose_of(carriers, decal.carrier, seconds) *
                           glm::translate(glm::mat4(1), decal.position_world) *
                           scene::rotation_of(decal.rotation);
  return glm::scale(placed, glm::vec3(decal.scale));
}

}  // namespace brume::scenario
