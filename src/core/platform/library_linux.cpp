#include <dlfcn.h>

#include "core/platform/library.hpp"

namespace brume::platform {

const Library kVulkanLoader{"libvulkan.so.1", "libvulkan1"};
const Library kEmbree{"libembree3.so.3", "libembree3-3"};
const char* const kVdbIsMissing = "is neither beside brume nor on the PATH; install it with cmake --install";

void* load_library(const char* file) {
  return ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
}

void* find_symbol(void* library, const char* name) {
  return ::dlsym(library, name);
}

}  // namespace brume::platform
