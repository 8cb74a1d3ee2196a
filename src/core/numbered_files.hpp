// Files of a sequence, whose names differ by the number of their frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace brume {

/// A name around its number.
struct NumberedName {
  std::string before, after;
  std::size_t digits = 1;  ///< At least: 4 of %04d or ####.

  std::string with(std::uint64_t number) const;
};

/// Where a name has the number of a frame, in the form of any program: %d, %04d, ####, $F, $F4, <frame>,
/// <frame04>, <f4>. Empty: it has none. At most 16 digits.
std::optional<NumberedName> numbered_name(const std::string& name);

/// The files of a sequence by their numbers, in any number of digits; the name with more digits where two
/// have one number. A file that exists under the very name is the only one, and so is a file whose name has
/// no number, whether or not it exists: each as number 0. Empty: there are no such files.
std::map<std::int64_t, std::filesystem::path> numbered_files(const std::filesystem::path& file);

}  // namespace brume
