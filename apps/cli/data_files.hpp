// The scenes that the program comes with, and how it was built.
#pragma once

#include <filesystem>
#include <string>

namespace brume::cli {

/// The folder of the scenes: `folder` if it is not empty, else data_file("scenes"). Throws Error (usage)
/// unless it holds demo.toml.
std::filesystem::path scenes_folder(const std::string& folder);

/// Version, commit, compiler, kind of build and parts, one a line.
std::string build_facts();

}  // namespace brume::cli
