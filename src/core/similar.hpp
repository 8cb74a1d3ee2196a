// Names that are nearly right: which known one was meant.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace brume {

/// Minimum number of insertions, deletions and replacements of a character and of swaps of two neighbours
/// that turn a into b, no character edited twice (Damerau 1964, "optimal string alignment"). Compares the
/// first 64 bytes only.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `name` without regard to case, if at most a third of the longer one's letters
/// differ (at least one, at most three); a beginning of at least three letters counts as near, too. Of
/// equally near names the first.
std::optional<std::string> similar_name(std::string_view name, std::span<const std::string> known);

/// What to add to a message about an unknown name: `; did you mean "time"?`, else the known names if there
/// are no more than twelve, `; expected one of "a", "b"`, else at most six that have most of its words in
/// common, `; did you mean one of "door_leaf", "door_frame"?`, else nothing. `quote` surrounds names.
std::string suggestion(std::string_view name, std::span<const std::string> known, std::string_view quote);

}  // namespace brume
