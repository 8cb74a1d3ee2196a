// Writes timelines as files for load_timeline, in a readable order.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// The text of a timeline file in `folder`. Omits settings with default values; events are sorted by time.
/// parse_timeline restores the same timeline, every number bit for bit, angles included: each is written as
/// the shortest decimal with that property. Three members may differ: the `place` of events; paths outside of
/// the folder, which become relative to it; and the unused anisotropy of a smoke with droplets, which becomes
/// the default.
///
/// The lists must be sorted as Timeline requires. The scene's path is relative to the folder (absolute if
/// they share no folder); pictures and fonts must lie below the folder to be read again.
std::string format_timeline(const Timeline& timeline, const std::filesystem::path& folder);

/// Writes the file, completely or not at all, into an existing folder. Copies pictures and fonts from outside
/// of that folder into NAME_files beside the file and refers to the copies; never overwrites existing files.
/// Fails with bad_input when a picture or font cannot be read, or for a timeline that could not be read back
/// (a number out of range, invalid UTF-8), and as write_file_atomic does.
Result<void> save_timeline(const std::filesystem::path& path, const Timeline& timeline);

}  // namespace brume::scene
