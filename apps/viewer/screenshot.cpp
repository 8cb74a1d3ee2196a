#include "apps/viewer/screenshot.hpp"

#include <cstdio>

#include "image/png.hpp"
#include "scene/timeline_writer.hpp"

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

Result<void> save_snapshot(const std::filesystem::path& picture, const image::Image8& image,
                           const scene::Timeline& snapshot) {
  if (auto done = scene::save_timeline(snapshot_timeline(picture), snapshot); !done) return done;
  return image::save_png(picture, image);
}

}  // namespace brume::viewer
