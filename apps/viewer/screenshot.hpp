// Screenshots, saved together with the timeline that reproduces them.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "image/image.hpp"
#include "scene/timeline.hpp"

namespace brume::viewer {

/// "folder/name_0001.png", or with the first higher number that no file uses, a snapshot's timeline included.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

/// Where save_snapshot puts the timeline of this picture: next to it, with the extension .toml.
std::filesystem::path snapshot_timeline(const std::filesystem::path& picture);

/// Saves the image and the timeline whose last frame it shows.
Result<void> save_snapshot(const std::filesystem::path& picture, const image::Image8& image,
                           const scene::Timeline& snapshot);

}  // namespace brume::viewer
