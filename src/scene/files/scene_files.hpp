// The files that a scene refers to: meshes, textures, buffers. Loaders access them only through this
// interface, so that the same code reads a folder and, in tests, memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace brume::scene {

/// True for a relative path that cannot leave its folder: not empty, not absolute, no "..", no drive letter,
/// no control byte. Both slashes count as separators.
bool is_safe_relative(const std::string& name);

/// Why a file of this name is not there, such as "does not exist".
std::string why_not_found(const std::string& name);

/// What the images of a scene are for: all, or only to decide roles, or nothing. One that is not needed gives
/// no warning where it is missing or damaged.
enum class ImageUse { pictures, roles, none };

class SceneFiles {
 public:
  virtual ~SceneFiles() = default;
  /// The actual name of the file, or nothing. Without an exact match, returns a file whose name differs only
  /// in letter case (the first in byte order). Unsafe names never match.
  virtual std::optional<std::string> find(const std::string& name) const = 0;
  /// Reads a file by a name that `find` returned.
  virtual Result<std::vector<std::byte>> read(const std::string& found) const = 0;
};

/// The files below one folder. Not for several threads.
class FolderFiles : public SceneFiles {
 public:
  explicit FolderFiles(std::filesystem::path folder);
  std::optional<std::string> find(const std::string& name) const override;
  Result<std::vector<std::byte>> read(const std::string& found) const override;
  /// The paths of the files that were read, in order, each once.
  const std::vector<std::filesystem::path>& files_read() const { return read_; }

 private:
  std::filesystem::path folder_;
  mutable std::vector<std::filesystem::path> read_;
};

/// Files in memory, by name.
class MemoryFiles : public SceneFiles {
 public:
  std::map<std::string, std::vector<std::byte>> files;
  void add_text(const std::string& name, const std::string& text);
  std::optional<std::string> find(const std::string& name) const override;
  Result<std::vector<std::byte>> read(const std::string& found) const override;
};

}  // namespace brume::scene
