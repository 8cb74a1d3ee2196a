#include "apps/cli/volumes.hpp"

#include "grids/files.hpp"
#include "grids/raw_file.hpp"

namespace brume::cli {

bool is_volume_file(const std::filesystem::path& path) {
  return grids::is_grid_file(path) || grids::is_raw_description(path);
}

grids::GridFile load_volumes(const std::filesystem::path& path, Outputs& outputs) {
  outputs.reads(path);
  if (!grids::is_raw_description(path)) return grids::load_grid_file(path).value_or_throw();
  outputs.reads(grids::read_raw_path(path).value_or_throw());
  return grids::load_raw(path).value_or_throw();
}

}  // namespace brume::cli
