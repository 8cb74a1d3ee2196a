// Pictures of the window on disk, with what renders them again.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "image/image.hpp"
#include "scene/timeline.hpp"

namespace brume::viewer {

/// "name_0001.png" in a folder, or the first number after it that is free.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

/// Saves the picture, and beside it under the same name (.toml) the timeline whose end it shows.
Result<void> save_snapshot(const std::filesystem::path& picture, const image::Image8& image,
                         const scene::Timeline& snapshot);

}  // namespace brume::viewer
