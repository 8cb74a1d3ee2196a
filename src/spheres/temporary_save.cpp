// Stands in until the files of tanks are written: goes with temporary.cpp.
#include "spheres/file.hpp"

namespace brume::spheres {

__attribute__((weak)) Result<void> save_tank(const std::filesystem::path& path, const Tank&) {
  return Failure{ErrorCode::internal, path.string() + ": tanks cannot be saved yet"};
}

}  // namespace brume::spheres
