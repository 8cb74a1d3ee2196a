// Reads and writes whole files. Readers never see a half-written file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace brume {

/// Reads the whole file. Fails with bad_input when it is missing, unreadable or not a regular file, and
/// with resource_limit when it is longer than `max_bytes`.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                         std::uint64_t max_bytes = 1ull << 31);

/// The same as text.
Result<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes = 1ull << 28);

/// The first bytes of a regular file, at most `max_bytes`. Fails as read_file does.
Result<std::string> read_file_start(const std::filesystem::path& path, std::size_t max_bytes);

/// Writes the whole file through AtomicFile.
Result<void> write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_file_atomic(const std::filesystem::path& path, const std::string& text);

/// The path that remains after following every symbolic link in the last component: the file itself, or the
/// place where writing through the links creates one. Fails with bad_input for a cycle of links.
Result<std::filesystem::path> follow_links(const std::filesystem::path& path);

/// The failure of a system call on a file, with its errno: resource_limit when the disk or a quota is full or
/// a size limit is reached, otherwise bad_input.
Failure system_failure(const std::filesystem::path& path, const char* action, int error);

}  // namespace brume
