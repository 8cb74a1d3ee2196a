// The rules that hold the folders apart, as functions of a file's text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace brume::house {

/// The includes of a file in src/FOLDER, or "apps", that reach upwards in core < image < scene < voxel < sim
/// < gpu < passes < render < apps, or into a folder that is not in this list.
std::vector<std::string> upward_includes(std::string_view folder, std::string_view text);

/// The places where Vulkan is called or its headers are included: `vkName(`.
std::vector<std::string> vulkan_calls(std::string_view text);

/// The structs of a shared header that have no SHARED_SIZE in it.
std::vector<std::string> unsized_structs(std::string_view text);

}  // namespace brume::house
