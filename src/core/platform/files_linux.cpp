#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "core/platform/files.hpp"

namespace brume::platform {
namespace {

namespace fs = std::filesystem;

FileInfo to_info(const struct stat& info) {
  return {S_ISREG(info.st_mode), S_ISDIR(info.st_mode), static_cast<std::uint64_t>(info.st_size), info.st_dev,
          info.st_ino};
}

int retry_lock(int descriptor, int operation) {
  int locked = 0;
  do locked = ::flock(descriptor, operation);
  while (locked != 0 && errno == EINTR);
  return locked;
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// The path of an open file, to link it or to open it again.
std::string descriptor_path(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace

std::optional<FileInfo> info_of(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return std::nullopt;
  return to_info(info);
}

std::optional<FileInfo> info_of(int descriptor) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) return std::nullopt;
  return to_info(info);
}

std::string why_not_a_name(const fs::path&) {
  return "";  // The kernel says what its file systems do not accept.
}

bool may_write(const fs::path& path) {
  return ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

// O_NONBLOCK: a pipe without a writer is refused, not waited for.
int open_to_read(const fs::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
}

std::ptrdiff_t read_some(int descriptor, std::span<std::byte> bytes) {
  ssize_t got = 0;
  do got = ::read(descriptor, bytes.data(), bytes.size());
  while (got < 0 && errno == EINTR);
  return got;
}

std::ptrdiff_t write_some(int descriptor, std::span<const std::byte> bytes) {
  ssize_t put = 0;
  do put = ::write(descriptor, bytes.data(), bytes.size());
  while (put < 0 && errno == EINTR);
  return put;
}

bool sync(int descriptor) {
  return ::fsync(descriptor) == 0;
}

void close(int descriptor) {
  ::close(descriptor);
}

std::span<const int> full_errors() {
  static constexpr std::array kFull{ENOSPC, EDQUOT, EFBIG};
  return kFull;
}

bool is_full(int error) {
  return std::ranges::find(full_errors(), error) != full_errors().end();
}

int open_nameless(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor < 0) return -1;
  if (::access(descriptor_path(descriptor).c_str(), F_OK) == 0) {
    retry_lock(descriptor, LOCK_EX);
    return descriptor;
  }
  ::close(descriptor);  // Without /proc it could never get a name.
  errno = EOPNOTSUPP;
  return -1;
}

// A process that cleans up may remove it before the lock.
int create_part(const fs::path& part, const fs::path& target) {
  // Readable by others only once it has the permissions of the file that it replaces.
  const mode_t mode = ::access(target.c_str(), F_OK) == 0 ? 0600 : 0666;
  const int descriptor = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (descriptor < 0) return -1;
  retry_lock(descriptor, LOCK_EX);
  struct stat info {};
  if (::fstat(descriptor, &info) != 0 || info.st_nlink > 0) return descriptor;
  ::close(descriptor);
  errno = EEXIST;
  return -1;
}

void remove_if_stale(const fs::path& part) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat opened {
  }, named{};
  if (::fstat(descriptor, &opened) == 0 && S_ISREG(opened.st_mode) &&
      retry_lock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::lstat(part.c_str(), &named) == 0 &&
      same_file(opened, named)) {
    ::unlink(part.c_str());
  }
  ::close(descriptor);
}

void remove(const fs::path& part) {
  ::unlink(part.c_str());
}

void copy_permissions(int descriptor, const fs::path& target) {
  struct stat info {};
  if (::stat(target.c_str(), &info) != 0) return;
  // Only root may give files away; the group is often allowed alone.
  if (::fchown(descriptor, info.st_uid, info.st_gid) != 0)
    (void)!::fchown(descriptor, static_cast<uid_t>(-1), info.st_gid);
  (void)!::fchmod(descriptor, info.st_mode & 0777);
}

int link_nameless(int descriptor, const fs::path& name) {
  const std::string open_file = descriptor_path(descriptor);
  return ::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

int replace(int descriptor, const fs::path& part, const fs::path& target) {
  const int error = ::rename(part.c_str(), target.c_str()) == 0 ? 0 : errno;
  if (error != 0) ::unlink(part.c_str());
  ::close(descriptor);
  return error;
}

std::string path_for_child(int descriptor, const fs::path&) {
  return descriptor_path(descriptor);
}

}  // namespace brume::platform
