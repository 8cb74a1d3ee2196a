// The files that a scene names: meshes, textures, buffers. Loaders see them only through this interface, so
// that the same code reads a folder and, in tests, memory.
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

/// True when the name stays below the folder it is relative to: not empty, not absolute, no "..", no drive
/// letter, no control byte. Both slashes count as separators.
bool is_safe_relative(const std::string& name);

class SceneFiles {
 public:
  virtual ~SceneFiles() = default;
  /// The name under which the file exists, or nothing. Where the exact name is missing, a file whose name
  /// differs only in letter case is taken (the first in byte order). Unsafe names exist nowhere.
  virtual std::optional<std::string> find(const std::string& name) const = 0;
  /// Reads a file that `find` gave.
  virtual Result<std::vector<std::byte>> read(const std::string& found) const = 0;
};

/// The files below one folder.
class FolderFiles : public SceneFiles {
 public:
  explicit FolderFiles(std::filesystem::path folder);
  std::optional<std::string> find(const std::string& name) const override;
  Result<std::vector<std::byte>> read(const std::string& found) const override;

 private:
  std::filesystem::path folder_;
};

/// Files in memory, by their names.
class MemoryFiles : public SceneFiles {
 public:
  std::map<std::string, std::vector<std::byte>> files;
  void add_text(const std::string& name, const std::string& text);
  std::optional<std::string> find(const std::string& name) const override;
  Result<std::vector<std::byte>> read(const std::string& found) const override;
};

}  // namespace brume::scene
