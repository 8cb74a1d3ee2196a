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

/// A file that appears under its name only when it is complete: bytes go to a temporary file in the same
/// folder; `commit` syncs and renames it. Without a commit the destructor removes it.
class AtomicFile {
 public:
  /// Opens the temporary file. Fails with bad_input when the folder does not exist or is not writable.
  static Result<AtomicFile> open(const std::filesystem::path& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  /// Appends bytes. Fails with resource_limit when the disk is full.
  Result<void> write(std::span<const std::byte> bytes);
  /// Syncs the bytes to disk and gives the file its final name.
  Result<void> commit();
  /// The path until the commit, for programs that write the file themselves.
  const std::filesystem::path& temporary_path() const { return temporary_; }

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor);
  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
};

/// Writes the whole file through AtomicFile.
Result<void> write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_file_atomic(const std::filesystem::path& path, const std::string& text);

}  // namespace brume
