// A temporary folder for tests.
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace brume::cli {

/// A new folder below that for temporary files.
inline std::filesystem::path fresh_folder() {
  std::string path = (std::filesystem::temp_directory_path() / "brume_XXXXXX").string();
  if (!::mkdtemp(path.data())) throw std::runtime_error("cannot make a folder for temporary files");
  return path;
}

/// One that is removed with its contents.
class WorkFolder {
 public:
  WorkFolder() = default;
  WorkFolder(const WorkFolder&) = delete;
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  /// Writes a file in it and returns its name.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return name;
  }
  /// The names of its files, sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_ = fresh_folder();
};

}  // namespace brume::cli
