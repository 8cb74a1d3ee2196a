// Validates timelines that were built by a program, as if they had been read from a file.
#pragma once

#include "core/error.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// Fails with bad_input at the first event that a file could not contain: a number that is NaN or outside the
/// range in scene/options.hpp, invalid UTF-8, a shot without a direction; the message names the event, its
/// time and the number. Does not check whether doors, pictures and fonts exist.
Result<void> check_events(const Timeline& timeline);

/// The same for everything but the events: settings, carriers and their names where volumes and decals refer
/// to them, and all keys, which must be sorted by time.
Result<void> check_settings(const Timeline& timeline);

}  // namespace brume::scene
