// Where tests find brume-vdb, what it costs, and where its files go.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace brume::grids {

/// Lets the code under test start this program as brume-vdb while it lives.
class ChildProgram {
 public:
  explicit ChildProgram(const std::string& program = BRUME_VDB_PROGRAM) {
    ::setenv("BRUME_VDB", program.c_str(), 1);
  }
  ChildProgram(const ChildProgram&) = delete;
  ~ChildProgram() { ::unsetenv("BRUME_VDB"); }
};

/// A temporary folder, removed with its contents.
class WorkFolder {
 public:
  WorkFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "brume-grids-XXXXXX").string();
    path_ = ::mkdtemp(path.data());
  }
  WorkFolder(const WorkFolder&) = delete;
  ~WorkFolder() { std::filesystem::remove_all(path_); }
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
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

/// Of the children that have ended.
struct ChildCosts {
  double cpu_seconds = 0;
  double max_megabytes = 0;  ///< Of the largest, resident.
};
inline ChildCosts child_costs() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024};
}

}  // namespace brume::grids
