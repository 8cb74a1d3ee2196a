// The reader of palettes in JSON, which knows the line of every fault.
#include <algorithm>

#include "core/utf8.hpp"
#include "palettes/file.hpp"
#include "palettes/text.hpp"

namespace brume::palettes {
namespace {

constexpr std::size_t kLongestText = 256;
constexpr int kDeepest = 64;  // values within values
constexpr const char* kForm = "expected {\"colors\": [\"#rrggbb\", ...]} or a list of colours";

/// Thrown and caught in this file only.
struct Fault {
  std::string what;
  ErrorCode code = ErrorCode::bad_input;
};

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(without_byte_order_mark(text)) {}

  Palette read() {
    Palette palette;
    const char first = next();
    if (first == '{') {
      read_object(palette);
    } else if (first == '[') {
      palette.colors = read_colors();
    } else {
      throw Fault{kForm};
    }
    if (next() != '\0' || at_ < text_.size()) throw Fault{"expected the end of the file"};
    if (palette.colors.size() < kLeastColors)
      throw Fault{"expected at least two colours, found " + std::to_string(palette.colors.size())};
    return palette;
  }

  /// The line of what was read last, from 1.
  std::size_t line() const {
    const std::string_view before = text_.substr(0, std::min(last_, text_.size()));
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  }

 private:
  /// The next character that is not a blank, without taking it; 0 at the end.
  char next() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
    last_ = at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    return true;
  }

  void expect(char wanted) {
    if (!take(wanted)) throw Fault{std::string("expected '") + wanted + "'"};
  }

  std::string read_text(std::size_t longest = kLongestText) {
    expect('"');
    std::string result;
    while (at_ < text_.size() && text_[at_] != '"') {
      const char c = text_[at_++];
      if (static_cast<unsigned char>(c) < ' ') throw Fault{"expected the end of the text, '\"'"};
      if (c == '\\') {
        append_utf8(result, read_escape());
      } else {
        result += c;
      }
      if (result.size() > longest)
        throw Fault{"expected a text of at most " + std::to_string(longest) + " bytes"};
    }
    if (at_ == text_.size()) throw Fault{"expected the end of the text, '\"'"};
    ++at_;
    if (!is_utf8(result)) throw Fault{"expected UTF-8"};
    return result;
  }

  /// The character behind a backslash (RFC 8259, section 7).
  char32_t read_escape() {
    constexpr std::string_view kLetters = "\"\\/bfnrt", kMeant = "\"\\/\b\f\n\r\t";
    const char letter = at_ < text_.size() ? text_[at_++] : '\0';
    if (letter != 'u') {
      const std::size_t which = kLetters.find(letter);
      if (which == kLetters.npos) throw Fault{"unknown escape in a text"};
      return static_cast<unsigned char>(kMeant[which]);
    }
    const char32_t first = read_unit();
    const bool is_high = first >= 0xd800 && first < 0xdc00;
    if (!is_high && (first < 0xdc00 || first >= 0xe000)) return first;
    // Characters above U+FFFF are two surrogates.
    const bool has_low = is_high && text_.substr(at_).starts_with("\\u");
    if (has_low) at_ += 2;
    const char32_t second = has_low ? read_unit() : 0;
    if (second < 0xdc00 || second >= 0xe000) throw Fault{"expected a pair of surrogates, \\ud800\\udc00"};
    return 0x10000 + ((first - 0xd800) << 10) + (second - 0xdc00);
  }

  char32_t read_unit() {
    const std::string_view digits = text_.substr(at_, 4);
    const auto value = digits.size() == 4 ? hex_number(digits) : std::nullopt;
    if (!value) throw Fault{"expected four hexadecimal digits behind \\u"};
    at_ += 4;
    return *value;
  }

  std::vector<glm::u8vec3> read_colors() {
    std::vector<glm::u8vec3> colors;
    if (!take('[')) throw Fault{"\"colors\": expected a list, [\"#rrggbb\", ...]"};
    if (take(']')) return colors;
    do {
      const auto color = next() == '"' ? to_color(read_text()) : std::nullopt;
      if (!color) throw Fault{"expected a colour such as \"#ff8000\" or \"#f80\""};
      if (colors.size() == kMostColors)
        throw Fault{"more than 4096 colours; remove some", ErrorCode::resource_limit};
      colors.push_back(*color);
    } while (take(','));
    expect(']');
    return colors;
  }

  static std::optional<glm::u8vec3> to_color(const std::string& text) {
    if (!text.starts_with('#')) return std::nullopt;
    if (text.size() != 4) return color_of_hex(std::string_view(text).substr(1));
    return color_of_hex(std::string{text[1], text[1], text[2], text[2], text[3], text[3]});
  }

  void read_object(Palette& palette) {
    bool has_colors = false;
    expect('{');
    bool goes_on = next() != '}';
    while (goes_on) {
      const std::string key = read_text(kMostFileBytes);
      expect(':');
      if (key == "name") {
        if (next() != '"') throw Fault{"\"name\": expected a text"};
        palette.name = read_text();
      } else if (key == "kind") {
        const std::string kind = next() == '"' ? read_text() : "";
        if (kind != "gradient" && kind != "qualitative")
          throw Fault{"\"kind\": expected \"gradient\" or \"qualitative\""};
        palette.kind = kind == "gradient" ? Kind::gradient : Kind::qualitative;
      } else if (key == "colors") {
        if (has_colors) throw Fault{"\"colors\" is there twice; remove one"};
        palette.colors = read_colors();
        has_colors = true;
      } else {
        // Keys of other programs mean nothing here.
        skip_value(0);
      }
      goes_on = take(',');
    }
    expect('}');
    if (!has_colors) throw Fault{std::string("\"colors\" is missing; ") + kForm};
  }

  /// The value of a key that means nothing here.
  void skip_value(int depth) {
    if (depth > kDeepest) throw Fault{"values lie too deep within each other"};
    const char first = next();
    if (first == '"') {
      read_text(kMostFileBytes);
    } else if (first == '[' || first == '{') {
      skip_values(first == '{', depth);
    } else {
      // A number, true, false or null.
      const std::size_t begin = at_;
      while (at_ < text_.size() && std::string_view(" \t\r\n,]}:\"[{").find(text_[at_]) == text_.npos) ++at_;
      if (!is_word(text_.substr(begin, at_ - begin))) throw Fault{"expected a value"};
    }
  }

  void skip_values(bool is_object, int depth) {
    const char end = is_object ? '}' : ']';
    ++at_;
    if (take(end)) return;
    do {
      if (is_object) {
        read_text(kMostFileBytes);
        expect(':');
      }
      skip_value(depth + 1);
    } while (take(','));
    expect(end);
  }

  static bool is_word(std::string_view word) {
    if (word == "true" || word == "false" || word == "null") return true;
    double number = 0;
    const bool begins =
        !word.empty() && (word.front() == '-' || (word.front() >= '0' && word.front() <= '9'));
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return begins && error != std::errc::invalid_argument && end == word.data() + word.size();
  }

  std::string_view text_;
  std::size_t at_ = 0, last_ = 0;
};

}  // namespace

Result<Palette> parse_json(std::string_view text, const std::string& file) {
  Reader reader(text);
  try {
    return reader.read();
  } catch (const Fault& fault) {
    return Failure{fault.code, file + ":" + std::to_string(reader.line()) + ": " + fault.what};
  }
}

}  // namespace brume::palettes
