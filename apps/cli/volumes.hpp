// Volume files of every kind that commands read.
#pragma once

#include <filesystem>

#include "apps/command_line/outputs.hpp"
#include "grids/grid.hpp"

namespace brume::cli {

/// The suffixes of volume files, as expect_suffix takes them.
inline constexpr const char *kVdb = ".vdb", *kNvdb = ".nvdb", *kBrv = ".brv", *kJson = ".json";

/// Reads a volume file (grids/files.hpp) and declares all files that it read. Throws Error.
grids::GridFile load_volumes(const std::filesystem::path& path, Outputs& outputs);

}  // namespace brume::cli
