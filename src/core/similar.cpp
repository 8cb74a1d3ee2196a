#include "core/similar.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace brume {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_word_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

/// The words of at least three letters.
std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && is_word_letter(text[end])) ++end;
    if (end - i >= 3) words.push_back(lower(text.substr(i, end - i)));
    i = end + 1;
  }
  return words;
}

/// The known names that contain most of the words of a name, in order.
std::vector<std::string> names_of_same_words(std::string_view name, std::span<const std::string> known) {
  const std::vector<std::string> words = split_words(name);
  std::size_t most = 1;
  std::vector<std::string> found;
  for (const std::string& candidate : known) {
    const std::string other = lower(candidate);
    const auto same = static_cast<std::size_t>(std::ranges::count_if(
        words, [&](const std::string& word) { return other.find(word) != std::string::npos; }));
    if (same < most) continue;
    if (same > most) found.clear();
    most = same;
    found.push_back(candidate);
  }
  return found;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Long names are not typing errors, and comparing them would take long.
  a = a.substr(0, 64);
  b = b.substr(0, 64);
  // Row i: distances of the first i letters of a to each beginning of b.
  std::vector<std::size_t> before, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    before = std::exchange(last, std::exchange(row, std::vector<std::size_t>(b.size() + 1)));
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      row[k + 1] = std::min({last[k + 1] + 1, row[k] + 1, last[k] + (a[i] == b[k] ? 0u : 1u)});
      const bool swapped = i > 0 && k > 0 && a[i] == b[k - 1] && a[i - 1] == b[k];
      if (swapped) row[k + 1] = std::min(row[k + 1], before[k - 1] + 1);
    }
  }
  return row.back();
}

std::optional<std::string> similar_name(std::string_view name, std::span<const std::string> known) {
  constexpr std::size_t kMostEdits = 3, kLeastBeginning = 3;
  const std::string wanted = lower(name);
  std::optional<std::string> best;
  std::size_t least = kMostEdits + 1;
  for (const std::string& candidate : known) {
    const std::string other = lower(candidate);
    const std::size_t most =
        std::clamp<std::size_t>(std::max(wanted.size(), other.size()) / 3, 1, kMostEdits);
    std::size_t edits = edit_distance(wanted, other);
    if (wanted.size() >= kLeastBeginning && other.starts_with(wanted))
      edits = std::min<std::size_t>(edits, 1);
    if (edits > most || edits >= least) continue;
    least = edits;
    best = candidate;
  }
  return best;
}

std::string suggestion(std::string_view name, std::span<const std::string> known, std::string_view quote) {
  constexpr std::size_t kMostListed = 12, kMostAlike = 6;
  const auto quoted = [&](const std::string& text) { return std::string(quote) + text + std::string(quote); };
  if (const auto similar = similar_name(name, known)) return "; did you mean " + quoted(*similar) + "?";
  const auto listed = [&](std::span<const std::string> names) {
    std::string list;
    for (const std::string& one : names) list += (list.empty() ? "" : ", ") + quoted(one);
    return (names.size() > 1 ? "one of " : "") + list;
  };
  if (known.empty()) return "";
  if (known.size() <= kMostListed) return "; expected " + listed(known);
  std::vector<std::string> alike = names_of_same_words(name, known);
  if (alike.empty()) return "";
  alike.resize(std::min(alike.size(), kMostAlike));
  return "; did you mean " + listed(alike) + "?";
}

}  // namespace brume
