#include "apps/cli/volumes.hpp"

#include "grids/files/grid_files.hpp"

namespace brume::cli {

grids::GridFile load_volumes(const std::filesystem::path& path, Outputs& outputs) {
  outputs.reads(path);
  outputs.reads(grids::files_of(path).value_or_throw());
  return grids::load_grid_file(path).value_or_throw();
}

}  // namespace brume::cli
