// Where tests find brume-vdb, and what it costs.
#pragma once

#include <sys/resource.h>

#include <cstdlib>
#include <string>

#include "tests/work_folder.hpp"

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

using cli::WorkFolder;

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
