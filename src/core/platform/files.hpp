// Files as the system has them. What fails leaves its reason in errno, on Windows too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace brume::platform {

void close(int descriptor);

/// An open file, closed with this.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    value_ = std::exchange(other.value_, -1);
    return *this;
  }
  ~Descriptor() { close(); }
  int get() const { return value_; }
  void close() {
    if (value_ >= 0) platform::close(std::exchange(value_, -1));
  }

 private:
  int value_;
};

struct FileInfo {
  bool is_regular = false, is_folder = false;
  std::uint64_t size = 0;
  std::uint64_t device = 0, file = 0;  ///< Together they identify the file.
};

/// Symbolic links are followed.
std::optional<FileInfo> info_of(const std::filesystem::path& path);
std::optional<FileInfo> info_of(int descriptor);

/// Why no file can have this name on this system: "has a '?' in its name"; empty if it can.
std::string why_not_a_name(const std::filesystem::path& path);

/// Whether the process may write to what exists.
bool may_write(const std::filesystem::path& path);

/// Opens what exists, also what is no file; never waits. -1: it failed.
int open_to_read(const std::filesystem::path& path);
/// The number of bytes, at least 1; 0 at the end; -1: it failed.
std::ptrdiff_t read_some(int descriptor, std::span<std::byte> bytes);
std::ptrdiff_t write_some(int descriptor, std::span<const std::byte> bytes);
/// Waits until all bytes are on disk.
bool sync(int descriptor);

/// The values of errno that say that a disk, a quota or the largest size of a file is exhausted.
std::span<const int> full_errors();
bool is_full(int error);

// ---- The temporary file of an AtomicFile ----

/// A file without a name, which a killed program does not leave behind, locked. -1: the file system has none.
int open_nameless(const std::filesystem::path& folder);
/// A new file for what replaces `target`, locked as long as it is open. -1 with EEXIST: try another name.
int create_part(const std::filesystem::path& part, const std::filesystem::path& target);
/// Removes a part that nobody locks.
void remove_if_stale(const std::filesystem::path& part);
void remove(const std::filesystem::path& part);
/// Gives the open file the permissions of the one that it is going to replace, and where allowed its owner.
void copy_permissions(int descriptor, const std::filesystem::path& target);
/// Gives a file without a name a free name. Returns 0 or an errno.
int link_nameless(int descriptor, const std::filesystem::path& name);
/// Closes the part and gives it the name of `target`, or removes it. Returns 0 or an errno.
int replace(int descriptor, const std::filesystem::path& part, const std::filesystem::path& target);
/// Where a child that inherits the descriptor opens the file.
std::string path_for_child(int descriptor, const std::filesystem::path& part);

}  // namespace brume::platform
