// Whether what a program puts into a timeline could stand in its file.
#pragma once

#include "core/error.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// Fails with bad_input at the first event that a file could not have: a number out of the range of
/// scene/options.hpp or none, a text that is no UTF-8, a shot without a direction; the message names the
/// event, its time and the number. Whether doors are in the scene, and pictures and fonts there, is not
/// looked at.
Result<void> check_events(const Timeline& timeline);

/// The same for all but the events: settings, and the keys of the camera, which must be in order of time.
Result<void> check_settings(const Timeline& timeline);

}  // namespace brume::scene
