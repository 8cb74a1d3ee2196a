// What this process uses of its machine.
#pragma once

#include <cstdint>
#include <string>

namespace brume::platform {

/// Processor time of all threads so far.
double processor_seconds();
/// "AMD EPYC 9654"; "unknown" where the system does not say.
std::string processor_name();

/// Bytes that are in memory, and of data and stacks; 0 where the system does not say.
struct MemoryUse {
  std::uint64_t resident = 0, data = 0;
};
MemoryUse memory_use();

}  // namespace brume::platform
