#include "apps/viewer/screenshot.hpp"

#include <cstdio>

namespace brume::viewer {

std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension) {
  std::filesystem::path path;
  for (int number = 1; number < 100000; ++number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "_%04d", number);
    path = folder / (name + digits + extension);
    std::error_code error;
    if (!std::filesystem::exists(path, error) && !std::filesystem::exists(snapshot_timeline(path), error))
      break;
  }
  return path;
}

std::filesystem::path snapshot_timeline(const std::filesystem::path& picture) {
  return std::filesystem::path(picture).replace_extension(".toml");
}

}  // namespace brume::viewer
