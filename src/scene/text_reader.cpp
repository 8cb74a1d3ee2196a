#include "scene/text_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/utf8.hpp"

namespace brume::scene {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}

std::string utf8_from_utf16(std::string_view text) {
  const std::size_t high = text.starts_with("\xfe\xff") ? 0 : 1;  // Index of the high byte of a unit.
  const auto unit = [&](std::size_t at) {
    const auto byte = [&](std::size_t i) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    };
    return byte(at + high) << 8 | byte(at + 1 - high);
  };
  const auto is_surrogate = [](std::uint32_t code, std::uint32_t first) { return code >> 10 == first >> 10; };
  std::string result;
  for (std::size_t at = 2; at + 1 < text.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (is_surrogate(code, 0xd800) && at + 3 < text.size() && is_surrogate(unit(at + 2), 0xdc00)) {
      at += 2;
      code = 0x10000 + ((code & 0x3ff) << 10) + (unit(at) & 0x3ff);
    } else if (is_surrogate(code, 0xd800) || is_surrogate(code, 0xdc00)) {
      code = 0xfffd;
    }
    append_utf8(result, code);
  }
  return result;
}

TextReader::TextReader(std::string_view text, std::string name, Continuation continuation)
    : rest_(text), name_(std::move(name)), continuation_(continuation) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextReader::next_line() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  cursor_ = word_begin_ = 0;
  ++line_number_;
  return true;
}

std::string_view TextReader::next_word() {
  for (;;) {
    while (cursor_ < line_.size() && is_blank(line_[cursor_])) ++cursor_;
    word_begin_ = cursor_;
    if (cursor_ == line_.size() || line_[cursor_] == '#') {
      cursor_ = line_.size();
      return {};
    }
    while (cursor_ < line_.size() && !is_blank(line_[cursor_])) ++cursor_;
    const std::string_view word = line_.substr(word_begin_, cursor_ - word_begin_);
    if (continuation_ == Continuation::none || word != "\\") return word;
    if (!next_line()) return {};
  }
}

std::string_view TextReader::rest_of_line() {
  while (cursor_ < line_.size() && is_blank(line_[cursor_])) ++cursor_;
  word_begin_ = cursor_;
  std::size_t end = line_.size();
  while (end > cursor_ && is_blank(line_[end - 1])) --end;
  const std::string_view rest = line_.substr(cursor_, end - cursor_);
  cursor_ = line_.size();
  return rest;
}

std::string TextReader::line_place() const {
  return name_ + ":" + std::to_string(line_number_);
}

std::string TextReader::place() const {
  return line_place() + ":" + std::to_string(word_begin_ + 1);
}

Failure TextReader::expected(const std::string& what, std::string_view found) const {
  return {ErrorCode::bad_input, place() + ": expected " + what + ", found " + in_quotes(found)};
}

Result<float> TextReader::number(const std::string& what) {
  return number_from(next_word(), what);
}

Result<float> TextReader::number_from(std::string_view word, const std::string& what) const {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || digits.empty() || error == std::errc::invalid_argument) {
    return expected("a number for " + what, word);
  }
  if (error != std::errc() || !(std::abs(value) <= std::numeric_limits<float>::max())) {
    return expected("a finite number for " + what, word);
  }
  return static_cast<float>(value);
}

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string in_quotes(std::string_view text) {
  if (text.empty()) return "the end of the line";
  constexpr std::size_t kMost = 40;
  std::string shown(text.substr(0, kMost));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return "\"" + shown + (text.size() > kMost ? "...\"" : "\"");
}

LineColumn line_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0: the first line.
  return {1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')),
          1 + before.size() - line_start};
}

}  // namespace brume::scene
