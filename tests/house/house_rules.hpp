// The architecture rules, as functions of the text of a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace brume::house {

/// The includes of a file in src/FOLDER, or "apps", that reach upwards in core < image < scene < voxel < volume < sim
/// < smoke < wire < scenario < planning < gpu < passes < render < bench < apps, or into any other folder.
std::vector<std::string> upward_includes(std::string_view folder, std::string_view text);

/// The calls of Vulkan functions, `vkName(`, and includes of its headers.
std::vector<std::string> vulkan_calls(std::string_view text);

/// The structs of a shared header without SHARED_SIZE.
std::vector<std::string> unsized_structs(std::string_view text);

}  // namespace brume::house
