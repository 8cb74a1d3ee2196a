#include "apps/command_line/unit_key.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <sstream>
#include <utility>

#include "apps/command_line/console.hpp"
#include "core/key.hpp"
#include "core/platform/process.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

using Part = std::pair<const char*, const std::string*>;

std::array<Part, 4> parts_of(const UnitKey& key) {
  return {{{"inputs", &key.inputs},
           {"settings", &key.settings},
           {"device", &key.device},
           {"program", &key.program}}};
}

}  // namespace

std::string to_text(const UnitKey& key, std::uint32_t unit) {
  std::string text = std::to_string(unit);
  for (const auto& [name, hash] : parts_of(key))
    if (!hash->empty()) text += std::string(" ") + name + ":" + *hash;
  return text;
}

std::string difference(const std::string& text, const UnitKey& key, std::uint32_t unit) {
  if (text == to_text(key, unit)) return "";
  std::istringstream words(text);
  std::string number, word;
  words >> number;
  std::map<std::string, std::string> found;
  while (words >> word) {
    const std::size_t colon = word.find(':');
    if (colon != std::string::npos) found[word.substr(0, colon)] = word.substr(colon + 1);
  }
  if (found.empty()) return "without a key";
  if (number != std::to_string(unit)) return "of another number";
  std::string causes;
  for (const auto& [name, hash] : parts_of(key))
    if (found[name] != *hash)
      causes += (causes.empty() ? "of " : ", ") +
                std::string(std::string_view(name).ends_with('s') ? "other " : "another ") + name;
  return causes.empty() ? "without a key" : causes;
}

std::string hash_of_files(const std::vector<fs::path>& files) {
  KeyHasher hasher;
  for (const fs::path& file : files) {
    stop_if_interrupted();
    if (file.empty())
      hasher.add("");
    else
      hasher.add_file(file, stop_if_interrupted).value_or_throw();
  }
  return hasher.digest();
}

std::string hash_of_texts(const std::vector<std::string>& texts) {
  KeyHasher hasher;
  for (const std::string& text : texts) hasher.add(text);
  return hasher.digest();
}

std::string exact_text(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

std::string program_hash() {
  std::error_code ignored;
  const fs::path helper =
      platform::program_file().parent_path() / to_path(platform::program_name("brume-vdb"));
  return hash_of_files({platform::program_image(), fs::exists(helper, ignored) ? helper : fs::path()});
}

void print_reasons(std::uint32_t first, const std::vector<std::string>& reasons) {
  for (auto begin = reasons.begin(); begin != reasons.end();) {
    const auto end = std::find_if(begin, reasons.end(), [&](const auto& reason) { return reason != *begin; });
    const auto low = first + static_cast<std::uint64_t>(begin - reasons.begin());
    const auto high = first + static_cast<std::uint64_t>(end - reasons.begin()) - 1;
    const std::string numbers =
        low == high ? " " + std::to_string(low) : "s " + std::to_string(low) + "-" + std::to_string(high);
    const bool is_there = *begin != "missing";
    if (!begin->empty()) print_note("frame" + numbers + ": " + *begin + (is_there ? "; made again" : ""));
    begin = end;
  }
}

}  // namespace brume::cli
