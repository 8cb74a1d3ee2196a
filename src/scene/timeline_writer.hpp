// Timelines as files: what load_timeline reads, in the order in which a person reads it.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// The file of a timeline that lies in `folder`. Settings that are as they would be without a word are left
/// out; events stand in order of time. parse_timeline makes the same timeline of it, every number bit for
/// bit, angles included: each is the shortest decimal of which that holds. Three things may differ: events
/// name their new places; a path that did not begin with the folder's name is spelled from there; of a smoke
/// of droplets the anisotropy, which does not count, is that of SmokeOptions().
///
/// The lists must be in the orders that Timeline names. The scene is named from the folder (absolute where
/// they have no folder in common); pictures and fonts must lie below the folder to be read again.
std::string format_timeline(const Timeline& timeline, const std::filesystem::path& folder);

/// Writes the file, whole or not at all, into a folder that exists. Pictures and fonts that do not lie below
/// its folder are copied into one beside the file, NAME_files, from where it then takes them; nothing that is
/// there already is changed. Fails with bad_input when a picture or font cannot be read, or for a timeline
/// that could not be read again: a number out of range, a name that is no UTF-8; and as write_file_atomic
/// does.
Result<void> save_timeline(const std::filesystem::path& path, const Timeline& timeline);

}  // namespace brume::scene
