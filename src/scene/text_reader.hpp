// Reads text files by lines and words, with the position of each word for error messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume::scene {

/// Iterates over a text: `next_line`, then `next_word` until it is empty. Words are separated by blanks and
/// tabs; a word that begins with '#' ends the line. Lines end with LF or CR LF. Returns views into the text,
/// which must outlive the reader.
class TextReader {
 public:
  enum class Continuation { none, backslash };

  /// `name` names the text in error messages. With Continuation::backslash, a line whose last word is a lone
  /// backslash continues on the next.
  TextReader(std::string_view text, std::string name, Continuation continuation = Continuation::none);

  /// Advances to the next line; false at the end of the text.
  bool next_line();
  /// The next word of the line; empty at its end.
  std::string_view next_word();
  /// The rest of the line, trimmed: for names that may contain blanks.
  std::string_view rest_of_line();

  /// "name:line".
  std::string line_place() const;
  /// "name:line:column" of the last word returned; columns count bytes from 1.
  std::string place() const;
  std::uint32_t line() const { return line_number_; }
  const std::string& name() const { return name_; }

  /// bad_input: "place: expected WHAT, found FOUND".
  Failure expected(const std::string& what, std::string_view found) const;

  /// Reads a finite number that fits a float. `what` completes "expected a number for ...".
  Result<float> number(const std::string& what);
  /// The same from a word already taken.
  Result<float> number_from(std::string_view word, const std::string& what) const;

 private:
  std::string_view rest_, line_;
  std::string name_;
  Continuation continuation_;
  std::size_t cursor_ = 0, word_begin_ = 0;
  std::uint32_t line_number_ = 0;
};

/// True for a text that begins with the byte order mark of UTF-16, in either byte order.
bool is_utf16(std::string_view text);
/// Such a text as UTF-8, without the mark. Unpaired surrogates become U+FFFD.
std::string utf8_from_utf16(std::string_view text);

/// The text between quotes, cut at 40 bytes, with control bytes shown as '?'; "the end of the line" for
/// an empty one.
std::string in_quotes(std::string_view text);
/// A number formatted for messages: at most six digits.
std::string shown(double value);

/// Line and column, both from 1, of a byte of the text.
struct LineColumn {
  std::size_t line = 1, column = 1;
};
LineColumn line_column(std::string_view text, std::size_t byte);

}  // namespace brume::scene
