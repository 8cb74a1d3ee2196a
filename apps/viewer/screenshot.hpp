// Screenshots, saved together with the timeline that reproduces them.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "image/image.hpp"
#include "scene/timeline.hpp"

namespace brume::viewer {

/// "folder/name_0001.png", or with the first higher number that is not in use.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

/// Saves the image and, next to it with the extension .toml, the timeline whose last frame it shows.
Result<void> save_snapshot(const std::filesystem::path& picture, const image::Image8& image,
                           const scene::Timeline& snapshot);

}  // namespace brume::viewer
