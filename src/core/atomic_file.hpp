// A file that is written completely or not at all, whenever the program ends.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/error.hpp"

namespace brume {

/// A file that appears under its name only when it is complete. Until then it has no name (O_TMPFILE): a
/// killed program leaves nothing behind. On a file system without nameless files it is called
/// ".NAME.brume-part-PID-N", and holds a lock for as long as its writer lives: the first `open` of a process
/// in a folder removes parts that nobody locks.
///
/// Symbolic links are followed: the file that they lead to is replaced. A replaced file keeps its
/// permissions, and its owner where the system allows it. Its other hard links keep the old contents.
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

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path target, std::filesystem::path part,
             int descriptor);
  int publish();
  std::filesystem::path path_;    ///< As the caller names it.
  std::filesystem::path target_;  ///< Where its links lead.
  std::filesystem::path part_;    ///< Name until the commit; empty: none.
  int descriptor_ = -1;
};

}  // namespace brume
