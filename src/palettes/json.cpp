// The reader of palettes in JSON, which knows the line of every fault.
#include <algorithm>

#include "core/utf8.hpp"
#include "palettes/file.hpp"
#include "palettes/text.hpp"

namespace brume::palettes {
namespace {

constexpr std::size_t kLongestText = 256;
constexpr const char* kForm = "expected {\"colors\": [\"#rrggbb\", ...]} or a list of colours";

/// Thrown and caught in this file only.
struct Fault {
  std::string what;
  ErrorCode code = ErrorCode::bad_input;
};

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

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

  /// Of what was read last, from 1.
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

  std::string read_text() {
    expect('"');
    std::string result;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      char c = text_[at_];
      if (static_cast<unsigned char>(c) < ' ') throw Fault{"expected the end of the text, '\"'"};
      if (c == '\\') {
        ++at_;
        c = at_ < text_.size() ? text_[at_] : '\0';
        if (c != '"' && c != '\\' && c != '/')
          throw Fault{"expected \\\", \\\\ or \\/; write other characters as UTF-8"};
      }
      result += c;
      if (result.size() > kLongestText) throw Fault{"expected a text of at most 256 bytes"};
    }
    if (at_ == text_.size()) throw Fault{"expected the end of the text, '\"'"};
    ++at_;
    if (!is_utf8(result)) throw Fault{"expected UTF-8"};
    return result;
  }

  std::vector<glm::u8vec3> read_colors() {
    std::vector<glm::u8vec3> colors;
    expect('[');
    if (take(']')) return colors;
    do {
      const std::string text = read_text();
      const auto color =
          text.starts_with('#') ? color_of_hex(std::string_view(text).substr(1)) : std::nullopt;
      if (!color) throw Fault{"expected a colour such as \"#ff8000\""};
      if (colors.size() == kMostColors)
        throw Fault{"more than 4096 colours; remove some", ErrorCode::resource_limit};
      colors.push_back(*color);
    } while (take(','));
    expect(']');
    return colors;
  }

  void read_object(Palette& palette) {
    bool has_colors = false;
    expect('{');
    do {
      const std::string key = read_text();
      expect(':');
      if (key == "name") {
        palette.name = read_text();
      } else if (key == "kind") {
        const std::string kind = read_text();
        if (kind != "gradient" && kind != "qualitative")
          throw Fault{"kind: expected \"gradient\" or \"qualitative\""};
        palette.kind = kind == "gradient" ? Kind::gradient : Kind::qualitative;
      } else if (key == "colors" && !has_colors) {
        palette.colors = read_colors();
        has_colors = true;
      } else {
        throw Fault{"expected \"name\", \"kind\" or \"colors\", once"};
      }
    } while (take(','));
    expect('}');
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
