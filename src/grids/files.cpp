#include "grids/files.hpp"

#include "core/atomic_file.hpp"
#include "core/file.hpp"
#include "grids/brv_file.hpp"
#include "grids/suffix.hpp"
#include "grids/worker.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

Failure in_file(const fs::path& path, const Failure& failure) {
  return {failure.code, path.string() + ": " + failure.message};
}

Result<GridFile> load_brv(const fs::path& path, const GridLimits& limits, const GridChoice& choice) {
  const auto bytes = read_file(path, limits.bytes);
  if (!bytes) return bytes.failure();
  auto file = decode_brv(*bytes, limits, choice);
  if (!file) return in_file(path, file.failure());
  return file;
}

Result<void> save_brv(const fs::path& path, const GridFile& file) {
  auto target = AtomicFile::open(path);
  if (!target) return target.failure();
  BrvWriter writer([&](std::span<const std::byte> bytes) { return target->write(bytes); });
  for (const Grid& grid : file.grids)
    if (auto added = writer.add(grid); !added)
      return added.failure().code == ErrorCode::bad_input ? in_file(path, added.failure()) : added.failure();
  if (auto finished = writer.finish(file.metadata); !finished) return finished;
  return target->commit();
}

}  // namespace

bool is_grid_file(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  return suffix == ".brv" || suffix == ".vdb" || suffix == ".nvdb";
}

Result<GridFile> load_grid_file(const fs::path& path, const GridLimits& limits, const GridChoice& choice) {
  if (!is_grid_file(path))
    return Failure{ErrorCode::bad_input,
                   path.string() + ": unknown file suffix; expected .brv, .vdb or .nvdb"};
  return lower_suffix(path) == ".brv" ? load_brv(path, limits, choice) : read_in_child(path, limits);
}

Result<void> save_grid_file(const fs::path& path, const GridFile& file) {
  if (!is_grid_file(path))
    return Failure{ErrorCode::usage, path.string() + ": unknown file suffix; expected .brv, .vdb or .nvdb"};
  return lower_suffix(path) == ".brv" ? save_brv(path, file) : write_in_child(path, file);
}

}  // namespace brume::grids
