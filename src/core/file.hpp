// Reads and writes whole files. Readers never see a half-written file: one is written completely or not at
// all, whenever the program ends.
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

/// A file that appears under its name only when it is complete. Until then it has no name (O_TMPFILE): a
/// killed program leaves nothing behind. On a file system without nameless files it is called
/// ".NAME.brume-part-PID-N", and holds a lock for as long as its writer lives: the first `open` of a process
/// in a folder removes parts that nobody locks. Windows has no nameless files.
///
/// Symbolic links are followed: the file that they lead to is replaced. A replaced file keeps its
/// permissions, and its owner where the system allows it; on Windows, it gets those of its folder. Its other
/// hard links keep the old contents.
class AtomicFile {
 public:
  enum class Naming {
    nameless_if_possible,
    named,  ///< As on a file system without nameless files.
  };

  /// Opens the temporary file. Fails with bad_input when the folder does not exist or is not writable, and
  /// when the file exists and is not writable or not a regular file.
  static Result<AtomicFile> open(const std::filesystem::path& path,
                                 Naming naming = Naming::nameless_if_possible);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Discards the file unless it was committed.
  ~AtomicFile();

  /// Appends bytes. Fails with resource_limit when the disk is full.
  Result<void> write(std::span<const std::byte> bytes);
  /// Syncs the bytes to disk and gives the file its final name.
  Result<void> commit();
  /// The open file until the commit, for programs that write the file themselves.
  int descriptor() const { return descriptor_; }
  /// Where a child that inherits the descriptor opens the file.
  std::string path_for_child() const;

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path target, std::filesystem::path part,
             int descriptor);
  int publish();
  std::filesystem::path path_;    ///< As the caller names it.
  std::filesystem::path target_;  ///< Where its links lead.
  std::filesystem::path part_;    ///< Name until the commit; empty: none.
  int descriptor_ = -1;
};

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
