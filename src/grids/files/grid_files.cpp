#include "grids/files/grid_files.hpp"

#include <algorithm>

#include "core/file.hpp"
#include "grids/brv_file.hpp"
#include "grids/files/raw_file.hpp"
#include "grids/files/slice_atlas.hpp"
#include "grids/files/tank_grids.hpp"
#include "grids/suffix.hpp"
#include "grids/volume_files.hpp"
#include "grids/worker.hpp"
#include "spheres/file.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

Result<void> save_brv(const fs::path& path, const GridFile& file) {
  auto target = AtomicFile::open(path);
  if (!target) return target.failure();
  BrvWriter writer([&](std::span<const std::byte> bytes) { return target->write(bytes); });
  for (const Grid& grid : file.grids)
    if (auto added = writer.add(grid); !added)
      return added.failure().code == ErrorCode::bad_input
                 ? Failure{ErrorCode::bad_input, path.string() + ": " + added.failure().message}
                 : added.failure();
  if (auto finished = writer.finish(file.metadata); !finished) return finished;
  return target->commit();
}

bool is_image(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  return suffix == ".png" || suffix == ".exr";
}

/// The description of an image.
fs::path description_of(const fs::path& path) {
  fs::path json = path;
  return json.replace_extension(".json");
}

/// An image belongs to the description beside it only if that names it: a PNG and an EXR of one name share
/// it.
Result<void> check_described(const fs::path& image) {
  if (const auto start = read_file_start(image, 1); !start) return start.failure();
  const auto images = read_atlas_images(description_of(image));
  if (!images) return images.failure();
  if (std::ranges::find(*images, image.filename(), &fs::path::filename) != images->end()) return {};
  return Failure{ErrorCode::bad_input, image.string() + ": " + description_of(image).filename().string() +
                                           " beside it describes " + images->front().filename().string() +
                                           "; name that, or bake this one again"};
}

Result<GridFile> load_described(const fs::path& json, const GridLimits& limits) {
  const auto is_atlas = is_slice_atlas(json);
  if (!is_atlas) return is_atlas.failure();
  if (!*is_atlas) return load_raw(json, limits);
  const auto atlas = load_slice_atlas(json, limits);
  if (!atlas) return atlas.failure();
  return to_grids(*atlas);
}

Result<GridFile> load_spheres(const fs::path& path, const GridLimits& limits, const GridChoice& choice) {
  const auto tank = spheres::load_tank(path);
  if (!tank) return tank.failure();
  return tank_grids(*tank, path.string(), limits, choice);
}

constexpr const char* kExpected = ": unknown file suffix; expected .brv, .vdb, .nvdb, .json or .spheres";

}  // namespace

bool is_grid_file(const fs::path& path) {
  if (is_volume_file(path) || lower_suffix(path) == ".json" || spheres::is_tank_file(path)) return true;
  if (!is_image(path) || !fs::exists(description_of(path))) return false;
  const auto is_atlas = is_slice_atlas(description_of(path));
  return is_atlas && *is_atlas;
}

Result<std::vector<fs::path>> files_of(const fs::path& path) {
  const bool is_picture = is_image(path);
  if (!is_picture && lower_suffix(path) != ".json") return std::vector<fs::path>{path};
  if (is_picture)
    if (const auto start = read_file_start(path, 1); !start) return start.failure();
  const fs::path json = is_picture ? description_of(path) : path;
  const auto is_atlas = is_slice_atlas(json);
  if (!is_atlas) return is_atlas.failure();
  if (*is_atlas) {
    if (auto described = is_picture ? check_described(path) : Result<void>(); !described)
      return described.failure();
    auto images = read_atlas_images(json);
    if (!images) return images.failure();
    images->insert(images->begin(), json);
    return images;
  }
  auto raw = read_raw_path(json);
  if (!raw) return raw.failure();
  return std::vector<fs::path>{json, std::move(*raw)};
}

Result<GridFile> load_grid_file(const fs::path& path, const GridLimits& limits, const GridChoice& choice) {
  if (lower_suffix(path) == ".json") return chosen_of(load_described(path, limits), choice);
  if (is_image(path)) {
    if (auto described = check_described(path); !described) return described.failure();
    return chosen_of(load_described(description_of(path), limits), choice);
  }
  if (spheres::is_tank_file(path)) return load_spheres(path, limits, choice);
  if (is_volume_file(path)) return load_volume_file(path, limits, choice);
  return Failure{ErrorCode::bad_input, path.string() + kExpected};
}

Result<void> save_grid_file(const fs::path& path, const GridFile& file) {
  const std::string suffix = lower_suffix(path);
  if (suffix == ".brv") return save_brv(path, file);
  if (suffix == ".vdb" || suffix == ".nvdb") return write_in_child(path, file);
  return Failure{ErrorCode::usage, path.string() + ": unknown file suffix; expected .brv, .vdb or .nvdb"};
}

}  // namespace brume::grids
