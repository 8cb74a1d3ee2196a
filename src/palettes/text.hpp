// Words and lines of texts. Internal to this folder.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace brume::palettes {

/// Letters of ASCII in lower case.
inline std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

/// Removes and returns what comes before the first blank, which is removed, too.
inline std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

/// Removes and returns the first line, without its end, "\n" or "\r\n".
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// All of a text as a hexadecimal number, without a sign.
inline std::optional<std::uint32_t> hex_number(std::string_view digits) {
  std::uint32_t value = 0;
  const char* const end = digits.data() + digits.size();
  if (digits.starts_with('-')) return std::nullopt;
  const auto [last, error] = std::from_chars(digits.data(), end, value, 16);
  if (error != std::errc() || last != end) return std::nullopt;
  return value;
}

/// Six digits.
inline std::optional<glm::u8vec3> color_of_hex(std::string_view digits) {
  const auto value = digits.size() == 6 ? hex_number(digits) : std::nullopt;
  if (!value) return std::nullopt;
  return glm::u8vec3(*value >> 16, *value >> 8 & 0xff, *value & 0xff);
}

/// A text without the byte order mark that some editors write before UTF-8.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

}  // namespace brume::palettes
