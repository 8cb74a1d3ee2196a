#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "core/platform/machine.hpp"

namespace brume::platform {

double processor_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

// /proc/self/statm in pages: all, resident, shared, code, 0, data and stacks, 0.
MemoryUse memory_use() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0, shared = 0, code = 0, libraries = 0, data = 0;
  file >> all >> resident >> shared >> code >> libraries >> data;
  if (!file) return {};
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {resident * page, data * page};
}

}  // namespace brume::platform
