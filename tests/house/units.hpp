// Units of code: a header and its source, together one thing.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace brume::house {

/// By the path of its files without the suffix, such as "src/smoke/sight".
struct Unit {
  std::size_t lines = 0;
  std::set<std::string> included;  ///< Paths as they are included: "core/file.hpp".
};
using Units = std::map<std::string, Unit>;

/// Adds a file of the project, whose path begins at the project's root.
void add_file(Units& units, const std::string& path, std::string_view text);

/// The largest groups of units of which each includes, perhaps through others, each of the same group: none
/// of them can be read, built or tested without the others. In the order of their names.
std::vector<std::vector<std::string>> circles(const Units& units);

}  // namespace brume::house
