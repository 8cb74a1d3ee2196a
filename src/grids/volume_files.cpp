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

Result<GridFile> chosen_of(Result<GridFile> file, const GridChoice& choice) {
  if (!file || !choice) return file;
  std::vector<const Grid*> heads;
  for (const Grid& grid : file->grids) heads.push_back(&grid);
  const auto positions = choice(heads);
  if (!positions) return positions.failure();
  GridFile chosen{{}, std::move(file->metadata)};
  for (const std::size_t position : *positions) chosen.grids.push_back(std::move(file->grids[position]));
  return chosen;
}

bool is_volume_file(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  return suffix == ".brv" || suffix == ".vdb" || suffix == ".nvdb";
}

Result<GridFile> load_volume_file(const std::filesystem::path& path, const GridLimits& limits,
                                  const GridChoice& choice) {
  if (lower_suffix(path) == ".brv") return load_brv(path, limits, choice);
  if (is_volume_file(path)) return chosen_of(read_in_child(path, limits), choice);
  return Failure{ErrorCode::bad_input, path.string() + ": unknown file suffix; expected .brv, .vdb or .nvdb"};
}

}  // namespace brume::grids
