#include "apps/command_line/frame_names.hpp"

#include <cctype>
#include <optional>
#include <string_view>

#include "core/error.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

// A file name as literal parts with the frame's number in between.
struct NamePattern {
  std::string before, after;
  std::optional<std::size_t> digits;  // Minimum digits of the number; nothing: there is no number.
};

// %d, %04d: the number. %%: a percent sign, as is one before anything but a letter or digit. Nothing for any
// other use of %.
std::optional<NamePattern> parse_name(const std::string& name) {
  NamePattern pattern;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& part = pattern.digits ? pattern.after : pattern.before;
    const std::string_view rest = std::string_view(name).substr(i + 1);
    if (name[i] != '%') {
      part += name[i];
    } else if (rest.starts_with('%')) {
      part += '%';
      ++i;
    } else if (!pattern.digits && rest.starts_with('d')) {
      pattern.digits = 1;
      ++i;
    } else if (!pattern.digits && rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' &&
               rest[2] == 'd') {
      pattern.digits = static_cast<std::size_t>(rest[1] - '0');
      i += 3;
    } else if (rest.empty() || std::isalnum(static_cast<unsigned char>(rest[0]))) {
      return std::nullopt;
    } else {
      part += '%';
    }
  }
  return pattern;
}

}  // namespace

bool is_numbered(const std::string& option, const std::filesystem::path& path) {
  const auto pattern = parse_name(path.filename().string());
  if (!pattern)
    throw Error(ErrorCode::usage,
                option + " " + path.string() +
                    ": expected one %d or %04d in the name, for the frame number, or %% for "
                    "a percent sign");
  return pattern->digits.has_value();
}

std::filesystem::path plain_name(const std::filesystem::path& path) {
  return path.parent_path() / to_path(parse_name(path.filename().string()).value().before);
}

std::filesystem::path sequence_name(const std::filesystem::path& path, std::uint32_t number) {
  const NamePattern pattern = parse_name(path.filename().string()).value();
  std::string digits = std::to_string(number);
  if (digits.size() < *pattern.digits) digits.insert(0, *pattern.digits - digits.size(), '0');
  return path.parent_path() / to_path(pattern.before + digits + pattern.after);
}

}  // namespace brume::cli
