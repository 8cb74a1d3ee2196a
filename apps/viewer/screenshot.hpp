// Names of screenshots, and of the scenes and timelines that reproduce them.
#pragma once

#include <filesystem>

namespace brume::viewer {

/// "folder/name_0001.png", or with the first higher number that no file uses, a snapshot's timeline included.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

/// Where the scene or timeline whose last frame a picture shows is saved: next to it, with the extension
/// .toml.
std::filesystem::path snapshot_timeline(const std::filesystem::path& picture);

}  // namespace brume::viewer
