// A temporary folder for tests.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace brume::cli {

/// A new folder below that for temporary files.
inline std::filesystem::path fresh_folder() {
  static std::atomic<int> number{0};
  const auto path = std::filesystem::temp_directory_path() /
                    ("brume_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
  std::filesystem::create_directories(path);
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
