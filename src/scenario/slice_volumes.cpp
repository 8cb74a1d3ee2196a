#include "scenario/slice_volumes.hpp"

#include <algorithm>
#include <cmath>
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

/// Where a mesh is whose occlusion volumes hold: inside of it both are large, outside one of them is small.
struct Occluder {
  glm::dvec3 middle{0};
  double radius = 0;
};

/// The mean of places and, times sqrt(2), their deviation: the radius of a disk of that deviation.
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

struct Loaded {
  grids::DenseVolume volume;
  glm::dmat4 file_from_box{1};
  Occluder occluder = {};
};

Result<Loaded> resampled(std::span<const Grid* const> chosen,
                         std::uint64_t most_voxels = grids::kMostAtlasTexels) {
  const auto box = grids::box_of(chosen);
  if (!box) return box.failure();
  const auto voxels = std::uint64_t{box->size.x} * box->size.y * box->size.z;
  if (voxels > most_voxels)
    return Failure{ErrorCode::resource_limit, "has " + std::to_string(voxels) + " voxels; at most " +
                                                  std::to_string(most_voxels) + " are sampled"};
  Loaded loaded{{}, box->world_from_box};
  for (const Grid* grid : chosen) {
    auto dense = grids::resample(*grid, *box);
    if (!dense) return dense.failure();
    loaded.volume.push_back(std::move(*dense));
  }
  // One grid twice is the same for all normals.
  if (chosen.front() != chosen.back())
    loaded.occluder = occluder_of(loaded.volume.front(), loaded.volume.back());
  return loaded;
}

/// The failure of a table of a timeline, whose file it names.
Failure failed_at(const std::string& place, const Failure& failure, const std::string& file) {
  return {failure.code, (place.empty() ? "" : place + ": ") + file + failure.message};
}

Result<Loaded> load_decal(const scene::DecalOptions& decal) {
  const auto failed = [&](const Failure& failure, const std::string& file) {
    return failed_at(decal.place, failure, file);
  };
  const auto file = grids::load_grid_file(decal.file);
  if (!file) return failed(file.failure(), "");
  const auto chosen = occlusion_grids(*file, decal);
  if (!chosen) return failed(chosen.failure(), decal.file.string() + ": ");
  auto loaded = resampled(*chosen);
  if (!loaded) return failed(loaded.failure(), decal.file.string() + ": ");
  return loaded;
}

/// The masks of a volume.
Result<Loaded> load_masks_of(const scene::VolumeOptions& volume) {
  if (volume.file.filename().string().find('%') != std::string::npos)
    return failed_at(volume.place, {ErrorCode::bad_input, "particles show one file, not a sequence"}, "");
  const auto file = grids::load_grid_file(volume.file);
  if (!file) return failed_at(volume.place, file.failure(), "");
  std::vector<const Grid*> chosen;
  for (const scene::VolumeMask& mask : volume.masks) {
    // Volumes::load has found it.
    if (const Grid* grid = find_grid(*file, mask.grid)) chosen.push_back(grid);
  }
  // What is marched may be shown by particles in a while: as long as it is small.
  constexpr std::uint64_t kSmall = 1u << 22;
  auto loaded = resampled(chosen, volume.particles > 0 ? grids::kMostAtlasTexels : kSmall);
  if (!loaded) return failed_at(volume.place, loaded.failure(), volume.file.string() + ": ");
  return loaded;
}

/// Adds what decals sample; decals of one file have one volume.
Result<void> add_decals(std::span<const scene::DecalOptions> decals, std::vector<grids::DenseVolume>& volumes,
                        SliceVolumes& slices) {
  for (std::size_t i = 0; i < decals.size(); ++i) {
    std::size_t first = 0;
    while (decals[first].file != decals[i].file || decals[first].grid != decals[i].grid) ++first;
    if (first < i) {
      slices.of_decals.push_back(slices.of_decals[first]);
      continue;
    }
    auto loaded = load_decal(decals[i]);
    if (!loaded) return loaded.failure();
    slices.of_decals.push_back({volumes.size(), glm::mat4(loaded->file_from_box),
                                glm::vec3(loaded->occluder.middle),
                                static_cast<float>(loaded->occluder.radius)});
    volumes.push_back(std::move(loaded->volume));
  }
  return {};
}

/// Adds the masks of volumes, also of those that are marched: the other display is chosen while it plays.
Result<void> add_masks(std::span<const scene::VolumeOptions> options,
                       std::vector<grids::DenseVolume>& volumes, SliceVolumes& slices) {
  slices.of_volumes.resize(options.size());
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i].masks.empty()) continue;
    const auto same = [&](const scene::VolumeOptions& other) {
      return other.file == options[i].file &&
             std::ranges::equal(other.masks, options[i].masks, {}, &scene::VolumeMask::grid,
                                &scene::VolumeMask::grid);
    };
    const auto first = static_cast<std::size_t>(std::ranges::find_if(options, same) - options.begin());
    if (first < i) {
      slices.of_volumes[i] = slices.of_volumes[first];
      continue;
    }
    auto loaded = load_masks_of(options[i]);
    if (!loaded && options[i].particles > 0) return loaded.failure();
    if (!loaded) continue;
    slices.of_volumes[i] = {volumes.size(), glm::mat4(loaded->file_from_box)};
    volumes.push_back(std::move(loaded->volume));
  }
  return {};
}

}  // namespace

Result<SliceVolumes> load_slice_volumes(const scene::Timeline& timeline) {
  SliceVolumes slices;
  auto volumes = std::make_shared<std::vector<grids::DenseVolume>>();
  if (auto done = add_decals(timeline.decals, *volumes, slices); !done) return done.failure();
  if (auto done = add_masks(timeline.volumes, *volumes, slices); !done) return done.failure();
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
