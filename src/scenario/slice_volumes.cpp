#include "scenario/slice_volumes.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "grids/files/grid_files.hpp"
#include "volumes/decal_volume.hpp"

namespace brume::scenario {
namespace {

using grids::Grid;

/// The failure of a table of a timeline, whose file it names.
Failure failed_at(const std::string& place, const Failure& failure, const std::string& file) {
  return {failure.code, (place.empty() ? "" : place + ": ") + file + failure.message};
}

Result<volumes::SampledGrids> load_decal(const scene::DecalOptions& decal) {
  const auto failed = [&](const Failure& failure, const std::string& file) {
    return failed_at(decal.place, failure, file);
  };
  const auto file = grids::load_grid_file(decal.file);
  if (!file) return failed(file.failure(), "");
  auto loaded = volumes::decal_volume(*file, decal.grid);
  if (!loaded) return failed(loaded.failure(), decal.file.string() + ": ");
  return loaded;
}

/// The masks of a volume.
Result<volumes::SampledGrids> load_masks_of(const scene::VolumeOptions& volume) {
  if (volume.file.filename().string().find('%') != std::string::npos)
    return failed_at(volume.place, {ErrorCode::bad_input, "particles show one file, not a sequence"}, "");
  const auto file = grids::load_grid_file(volume.file);
  if (!file) return failed_at(volume.place, file.failure(), "");
  std::vector<const Grid*> chosen;
  for (const scene::VolumeMask& mask : volume.masks) {
    // Volumes::load has found it.
    if (const Grid* grid = volumes::find_grid(*file, mask.grid)) chosen.push_back(grid);
  }
  // What is marched may be shown by particles in a while: as long as it is small.
  constexpr std::uint64_t kSmall = 1u << 22;
  auto loaded = volumes::sample_grids(chosen, volume.particles > 0 ? grids::kMostAtlasTexels : kSmall);
  if (!loaded) return failed_at(volume.place, loaded.failure(), volume.file.string() + ": ");
  return loaded;
}

/// Adds what decals sample; decals of one file have one volume.
Result<void> add_decals(std::span<const scene::DecalOptions> decals, grids::DenseVolumes& volumes,
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
Result<void> add_masks(std::span<const scene::VolumeOptions> options, grids::DenseVolumes& volumes,
                       SliceVolumes& slices) {
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
  auto volumes = std::make_shared<grids::DenseVolumes>();
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
