// Libraries that are loaded when something first needs them.
#pragma once

namespace brume::platform {

struct Library {
  const char* file;     ///< As the system's loader searches it.
  const char* install;  ///< What brings it: "libvulkan1".
};

extern const Library kVulkanLoader, kEmbree;
/// After "requires the program brume-vdb, which ": where it could be, and what else helps.
extern const char* const kVdbIsMissing;

/// Loads the library with this file name, which stays loaded; null: it is missing.
void* load_library(const char* file);
/// Null: it has none of that name.
void* find_symbol(void* library, const char* name);

}  // namespace brume::platform
