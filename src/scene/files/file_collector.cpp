#include "scene/files/file_collector.hpp"

#include <string>

#include "core/file.hpp"
#include "core/utf8.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/files/toml_text.hpp"

namespace brume::scene {

namespace fs = std::filesystem;

FileCollector::FileCollector(const fs::path& scene)
    : folder_(scene.parent_path()), own_(scene.parent_path() / to_path(scene.stem().string() + "_files")) {}

Result<void> FileCollector::collect(fs::path& file) {
  if (file.empty() || is_safe_relative(path_from(file, folder_).generic_string())) return {};
  const auto known = collected_.find(file);
  if (known != collected_.end()) {
    file = known->second;
    return {};
  }
  auto bytes = read_file(file);
  if (!bytes) return bytes.failure();
  const fs::path copy = place_for(file, *bytes);
  copies_[copy] = std::move(*bytes);
  collected_[file] = copy;
  file = copy;
  return {};
}

Result<void> FileCollector::copy_files() const {
  std::error_code error;
  if (!copies_.empty()) fs::create_directories(own_, error);
  if (error)
    return Failure{ErrorCode::bad_input, own_.string() + ": cannot create the folder: " + error.message()};
  for (const auto& [place, bytes] : copies_)
    if (!fs::exists(place, error))
      if (auto written = write_file_atomic(place, bytes); !written) return written;
  return {};
}

/// A path that is unused, or that holds the same bytes.
fs::path FileCollector::place_for(const fs::path& file, const std::vector<std::byte>& bytes) const {
  fs::path place = own_ / file.filename();
  for (int number = 2; !is_free_for(place, bytes); ++number)
    place = own_ / to_path(file.stem().string() + "-" + std::to_string(number) + file.extension().string());
  return place;
}

bool FileCollector::is_free_for(const fs::path& place, const std::vector<std::byte>& bytes) const {
  if (const auto planned = copies_.find(place); planned != copies_.end()) return planned->second == bytes;
  std::error_code error;
  if (!fs::exists(place, error)) return true;
  const auto existing = read_file(place);
  return existing && *existing == bytes;
}

}  // namespace brume::scene
