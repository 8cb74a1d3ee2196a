// UTF-8 decoding.
#pragma once

#include <optional>
#include <string_view>

namespace brume {

/// Removes and returns the first character of a text; nothing, and no change, when it is not valid UTF-8 (RFC
/// 3629). The text must not be empty.
std::optional<char32_t> take_character(std::string_view& text);

/// Whether a text is valid UTF-8; the empty one is.
bool is_utf8(std::string_view text);

}  // namespace brume
