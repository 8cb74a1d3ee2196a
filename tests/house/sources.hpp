// The sources of the project.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace brume::house {

inline const std::filesystem::path kRoot = BRUME_SOURCE_DIR;

/// Calls visit(path, text) for each C++ file and shader below a folder of the project, and returns their
/// number.
int for_each_source(const std::filesystem::path& folder,
                    const std::function<void(const std::filesystem::path&, const std::string&)>& visit);

}  // namespace brume::house
