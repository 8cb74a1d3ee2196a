// Names of files with a place for the number of a frame: "smoke_%04d.png".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace brume::cli {

/// Whether a file name has a frame's number: one %d or %04d. %% stands for %. Throws Error (usage) for any
/// other % that might have been meant for a number.
bool is_numbered(const std::string& option, const std::filesystem::path& path);

/// The name of a picture or film: %% stands for %.
std::filesystem::path plain_name(const std::filesystem::path& path);

/// "smoke_%04d.png" and 7: "smoke_0007.png"; %% stands for %.
std::filesystem::path sequence_name(const std::filesystem::path& pattern, std::uint32_t number);

}  // namespace brume::cli
