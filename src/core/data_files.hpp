// Where a program finds the files that it comes with.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace brume {

/// A file or folder of those that the program comes with, such as "scenes/demo.toml" or "shaders": beside the
/// program, in ../share/brume relative to it, or in the source tree that brume-source.txt beside it names,
/// relative to its folder; the first that exists. The build writes that file, an installed program has none.
/// Throws Error (bad_input), which lists these places, if none has it.
std::filesystem::path data_file(const std::string& name);

/// The same; nothing if it is missing.
std::optional<std::filesystem::path> find_data_file(const std::string& name);

}  // namespace brume
