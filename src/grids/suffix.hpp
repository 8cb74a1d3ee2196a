// The suffixes of volume files.
#pragma once

#include <filesystem>
#include <string>

namespace brume::grids {

/// ".vdb" for "Smoke.VDB".
inline std::string lower_suffix(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return suffix;
}

}  // namespace brume::grids
