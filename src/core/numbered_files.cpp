#include "core/numbered_files.hpp"
#include "core/utf8.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <system_error>

namespace brume {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::size_t digits_from(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end;
}

/// Past the mark of a number that begins at i; i: none does.
std::size_t end_of_mark(std::string_view name, std::size_t i) {
  const auto lower = [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); };
  switch (name[i]) {
    case '%': {
      const std::size_t end = digits_from(name, i + 1);
      return end < name.size() && name[end] == 'd' ? end + 1 : i;
    }
    case '#':
      return std::min(name.find_first_not_of('#', i), name.size());
    case '$':
      return i + 1 < name.size() && name[i + 1] == 'F' ? digits_from(name, i + 2) : i;
    case '<': {
      std::string word;
      std::size_t end = i + 1;
      for (; end < name.size() && std::isalpha(static_cast<unsigned char>(name[end])); ++end)
        word += lower(name[end]);
      end = digits_from(name, end);
      return (word == "f" || word == "frame") && end < name.size() && name[end] == '>' ? end + 1 : i;
    }
    default:
      return i;
  }
}

std::size_t digits_of_mark(std::string_view mark) {
  constexpr std::size_t kMost = 16;
  std::size_t digits = mark[0] == '#' ? mark.size() : 1;
  if (const std::size_t first = mark.find_first_of("0123456789"); first != mark.npos)
    std::from_chars(mark.data() + first, mark.data() + mark.size(), digits);
  return std::clamp(digits, std::size_t{1}, kMost);
}

}  // namespace

std::optional<NumberedName> numbered_name(const std::string& name) {
  for (std::size_t i = 0; i < name.size(); ++i)
    if (const std::size_t end = end_of_mark(name, i); end > i)
      return NumberedName{name.substr(0, i), name.substr(end),
                          digits_of_mark(std::string_view(name).substr(i, end - i))};
  return std::nullopt;
}

std::string NumberedName::with(std::uint64_t number) const {
  std::string text = std::to_string(number);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  return before + text + after;
}

std::map<std::int64_t, fs::path> numbered_files(const fs::path& file) {
  const auto place = numbered_name(file.filename().string());
  std::error_code error;
  if (!place || fs::exists(file, error)) return {{0, file}};
  std::map<std::int64_t, fs::path> found;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  error.clear();
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::size_t around = place->before.size() + place->after.size();
    if (name.size() <= around || !name.starts_with(place->before) || !name.ends_with(place->after)) continue;
    const char* const last = name.data() + name.size() - place->after.size();
    std::int64_t number = 0;
    const auto read = std::from_chars(name.data() + place->before.size(), last, number);
    if (read.ec != std::errc() || read.ptr != last) continue;
    const auto [same, is_new] = found.emplace(number, file.parent_path() / to_path(name));
    if (!is_new && same->second.filename().string().size() < name.size())
      same->second = file.parent_path() / to_path(name);
  }
  return found;
}

}  // namespace brume
