#include "grids/volume_files.hpp"

#include "core/file.hpp"
#include "grids/brv_file.hpp"
#include "grids/suffix.hpp"
#include "grids/worker.hpp"

namespace brume::grids {
namespace {

Result<GridFile> load_brv(const std::filesystem::path& path, const GridLimits& limits,
                          const GridChoice& choice) {
  const auto bytes = read_file(path, limits.bytes);
  if (!bytes) return bytes.failure();
  auto file = decode_brv(*bytes, limits, choice);
  if (!file) return Failure{file.failure().code, path.string() + ": " + file.failure().message};
  return file;
}

}  // namespace

bool is_volume_file(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  return suffix == ".brv" || suffix == ".vdb" || suffix == ".nvdb";
}

Result<GridFile> load_volume_file(const std::filesystem::path& path, const GridLimits& limits,
                                  const GridChoice& choice) {
  if (lower_suffix(path) == ".brv") return load_brv(path, limits, choice);
  if (is_volume_file(path)) return read_in_child(path, limits);
  return Failure{ErrorCode::bad_input, path.string() + ": unknown file suffix; expected .brv, .vdb or .nvdb"};
}

}  // namespace brume::grids
