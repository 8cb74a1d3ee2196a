// Characters of texts.
#pragma once

#include <optional>
#include <string_view>

namespace brume {

/// The first character of a text, taken off it; nothing, and nothing taken, when it is no UTF-8 (RFC 3629).
/// The text must not be empty.
std::optional<char32_t> take_character(std::string_view& text);

/// Whether all of a text is UTF-8; the empty one is.
bool is_utf8(std::string_view text);

}  // namespace brume
