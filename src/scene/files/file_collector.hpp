// Copies files that a scene names into the scene's own folder. Internal to this folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

#include "core/error.hpp"

namespace brume::scene {

class FileCollector {
 public:
  /// For the scene in `scene`: copies go into NAME_files beside it.
  explicit FileCollector(const std::filesystem::path& scene);

  /// Replaces a file outside of the scene's folder by its path below it, where copy_files() puts it. Fails
  /// when it cannot be read.
  Result<void> collect(std::filesystem::path& file);
  /// Never overwrites existing files.
  Result<void> copy_files() const;

 private:
  std::filesystem::path place_for(const std::filesystem::path& file,
                                  const std::vector<std::byte>& bytes) const;
  bool is_free_for(const std::filesystem::path& place, const std::vector<std::byte>& bytes) const;

  std::filesystem::path folder_, own_;
  std::map<std::filesystem::path, std::filesystem::path> collected_;  ///< New path by original path.
  std::map<std::filesystem::path, std::vector<std::byte>> copies_;    ///< Bytes by new path.
};

}  // namespace brume::scene
