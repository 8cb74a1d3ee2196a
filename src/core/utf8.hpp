// UTF-8.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace brume {

/// Removes and returns the first character of a text; nothing, and no change, when it is not valid UTF-8 (RFC
/// 3629). The text must not be empty.
std::optional<char32_t> take_character(std::string_view& text);

/// Whether a text is valid UTF-8; the empty one is.
bool is_utf8(std::string_view text);

/// A path by its text in UTF-8. A path that is made of a std::string is read in another code page on Windows.
std::filesystem::path to_path(std::string_view utf8);

/// Appends a character, which is at most U+10FFFF and no surrogate.
void append_utf8(std::string& text, char32_t character);

/// A text of more than `most` bytes as whole characters of at most that many and "...".
std::string shortened(std::string_view text, std::size_t most);

}  // namespace brume
