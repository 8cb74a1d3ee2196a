#include <windows.h>

#include "core/platform/library.hpp"

namespace brume::platform {

const Library kVulkanLoader{"vulkan-1.dll", "the Vulkan runtime"};
const Library kEmbree{"embree3.dll", "embree3.dll"};
const char* const kVdbIsMissing =
    "is not made for Windows; on Linux, 'brume convert' makes a .brv of such a file, and back";

void* load_library(const char* file) {
  return reinterpret_cast<void*>(::LoadLibraryA(file));
}

void* find_symbol(void* library, const char* name) {
  return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
}

}  // namespace brume::platform
