// Reads timelines: the grammar of their TOML.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// Reads a timeline: TOML with `version = 1`, `scene`, the keys of visit_timeline_options, the tables [grid]
/// (voxel, size, origin), [smoke], [sky] and [sun] with the members above as keys, [[volume]] (file, first,
/// last, density, heat, color, position, clip, ping_pong, loop, range, opacity, color_map, carrier,
/// [[volume.mask]], [volume.disturb], [volume.detail], particles and its members), [[carrier]] (name, object,
/// [[carrier.key]]), [[decal]], [[tank]], [[role]] (object, role), and
/// [[camera]] (time, position, target, fov in degrees, [1, 170]) in order of time, [[event]] with type, time
/// and the fields of its type (scene/event_fields.hpp). Points are in metres, [-10^6, 10^6]; the
/// points of events [-16384, 16384]. check_objects checks whether the objects of doors, roles and carriers
/// exist. Fails with bad_input and file:line:column for malformed TOML, an unknown key (suggesting what was
/// probably meant), and a value of the wrong type or out of range.
Result<Timeline> load_timeline(const std::filesystem::path& path);

/// The same from text; `path` names it in messages and is the base of its relative paths.
Result<Timeline> parse_timeline(std::string_view text, const std::filesystem::path& path);

/// Fails with bad_input at the first door, role or carrier whose object is missing from the scene, suggesting
/// what was probably meant.
Result<void> check_objects(const Timeline& timeline, const Scene& scene);

}  // namespace brume::scene
