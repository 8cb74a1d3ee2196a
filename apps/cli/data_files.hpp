// Where the program finds the files that it comes with, and how it was built.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace brume::cli {

/// A file or folder of those that the program comes with, such as "scenes/demo.toml" or "shaders": beside the
/// program, in ../share/brume relative to it, or in the source tree that it was built from; the first that
/// exists. Throws Error (bad_input), which lists these places, if none does.
std::filesystem::path data_file(const std::string& name);

/// The same; nothing if it is missing.
std::optional<std::filesystem::path> find_data_file(const std::string& name);

/// The folder of the scenes: `folder` if it is not empty, else data_file("scenes"). Throws Error (usage)
/// unless it holds demo.toml.
std::filesystem::path scenes_folder(const std::string& folder);

/// Version, commit, compiler, kind of build and parts, one a line.
std::string build_facts();

}  // namespace brume::cli
