#include <windows.h>
// after windows.h
#include <psapi.h>

#include "core/platform/machine.hpp"
#include "core/platform/utf16.hpp"

namespace brume::platform {
namespace {

double to_seconds(const FILETIME& time) {
  return 1e-7 * static_cast<double>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime);
}

}  // namespace

double processor_seconds() {
  FILETIME created, ended, kernel, user;
  if (!::GetProcessTimes(::GetCurrentProcess(), &created, &ended, &kernel, &user)) return 0;
  return to_seconds(kernel) + to_seconds(user);
}

std::string processor_name() {
  std::wstring name(256, 0);
  DWORD bytes = static_cast<DWORD>(name.size() * sizeof(wchar_t));
  if (::RegGetValueW(HKEY_LOCAL_MACHINE, L"HARDWARE\\DESCRIPTION\\System\\CentralProcessor\\0",
                     L"ProcessorNameString", RRF_RT_REG_SZ, nullptr, name.data(), &bytes) != ERROR_SUCCESS)
    return "unknown";
  return to_utf8(name.c_str());
}

MemoryUse memory_use() {
  PROCESS_MEMORY_COUNTERS counters{};
  if (!::GetProcessMemoryInfo(::GetCurrentProcess(), &counters, sizeof counters)) return {};
  return {counters.WorkingSetSize, counters.PagefileUsage};
}

}  // namespace brume::platform
