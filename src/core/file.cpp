#include "core/file.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

namespace brume {
namespace {

namespace fs = std::filesystem;

struct Descriptor {
  int value = -1;
  ~Descriptor() {
    if (value >= 0) ::close(value);  // Read-only: errors lose no data.
  }
};

// Reads as many bytes as `wanted` returns for the size of the file.
template <typename Container, typename Wanted>
Result<Container> read_bytes(const std::filesystem::path& path, const Wanted& wanted) {
  // Open the file and check its type and size. O_NONBLOCK: a pipe without a writer is refused, not waited
  // for.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (file.value < 0) return system_failure(path, "open", errno);
  struct stat info {};
  if (::fstat(file.value, &info) != 0) return system_failure(path, "inspect", errno);
  if (!S_ISREG(info.st_mode))
    return Failure{ErrorCode::bad_input, path.string() + ": not a regular file; check the path"};
  const Result<std::size_t> size = wanted(static_cast<std::uint64_t>(info.st_size));
  if (!size) return size.failure();

  // Read it.
  Container bytes(*size, {});
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(file.value, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_failure(path, "read", errno);
    if (got == 0) break;  // The file has shrunk since fstat.
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

template <typename Container>
Result<Container> read_whole(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_bytes<Container>(path, [&](std::uint64_t size) -> Result<std::size_t> {
    if (size <= max_bytes) return size;
    return Failure{ErrorCode::resource_limit, path.string() + ": has " + std::to_string(size) +
                                                  " bytes, at most " + std::to_string(max_bytes) +
                                                  " are read"};
  });
}

// The temporary file of an AtomicFile.

constexpr std::string_view kPartMark = ".brume-part-";
constexpr std::size_t kLongestStem = 200;  // leaves room for the mark in a name of 255 bytes

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path fresh_part(const fs::path& target) {
  static std::atomic<unsigned> number{0};
  const std::string stem = target.filename().string().substr(0, kLongestStem);
  return folder_of(target) /
         ("." + stem + std::string(kPartMark) + std::to_string(::getpid()) + "-" + std::to_string(number++));
}

// ".NAME.brume-part-PID-N"
bool is_part(std::string_view name) {
  const std::size_t mark = name.rfind(kPartMark);
  if (name.empty() || name.front() != '.' || mark == std::string_view::npos || mark == 0) return false;
  const std::string_view numbers = name.substr(mark + kPartMark.size());
  return std::count(numbers.begin(), numbers.end(), '-') == 1 &&
         numbers.find_first_not_of("0123456789-") == std::string_view::npos;
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

// Removes a part if its writer is gone.
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

// Once per folder and process: a sequence of frames would otherwise list its folder at every frame.
bool is_first_visit(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<std::tuple<pid_t, dev_t, ino_t>> visited;  // A forked child is another process.
  struct stat info {};
  if (::stat(folder.c_str(), &info) != 0) return false;
  const std::lock_guard lock(mutex);
  return visited.emplace(::getpid(), info.st_dev, info.st_ino).second;
}

void remove_stale_parts(const fs::path& folder) {
  if (!is_first_visit(folder)) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_part(entry->path().filename().string())) remove_if_stale(entry->path());
}

// The path of an open file, to link it or to open it again.
std::string descriptor_path(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
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

// Creates and locks a part. A process that cleans up may remove it before the lock: then tries again.
int open_part(const fs::path& target, fs::path& part) {
  // Readable by others only once it has the permissions of the file that it replaces.
  const mode_t mode = ::access(target.c_str(), F_OK) == 0 ? 0600 : 0666;
  for (;;) {
    part = fresh_part(target);
    const int descriptor = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return -1;
    retry_lock(descriptor, LOCK_EX);
    struct stat info {};
    if (::fstat(descriptor, &info) != 0 || info.st_nlink > 0) return descriptor;
    ::close(descriptor);
  }
}

// Why a file that exists cannot be replaced.
std::optional<Failure> obstacle(const fs::path& path, const fs::path& target) {
  struct stat info {};
  if (::stat(target.c_str(), &info) != 0) return std::nullopt;
  if (S_ISDIR(info.st_mode))
    return Failure{ErrorCode::bad_input, path.string() + ": is a folder; name a file inside it"};
  if (!S_ISREG(info.st_mode))
    return Failure{ErrorCode::bad_input, path.string() + ": is not a regular file; name another file"};
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return system_failure(path, "write", errno);
  return std::nullopt;
}

Failure cannot_open(const fs::path& path, const fs::path& folder, int error) {
  std::error_code ignored;
  if (error == ENOENT && !fs::exists(folder, ignored)) {
    return {ErrorCode::bad_input, path.string() + ": cannot write: the folder " + folder.string() +
                                      " does not exist; create it first"};
  }
  return system_failure(path, "write", error);
}

// Gives the new file the owner and the permissions of the one that it replaces.
void copy_permissions(int descriptor, const fs::path& target) {
  struct stat info {};
  if (::stat(target.c_str(), &info) != 0) return;
  // Only root may give files away; the group is often allowed alone.
  if (::fchown(descriptor, info.st_uid, info.st_gid) != 0)
    (void)!::fchown(descriptor, static_cast<uid_t>(-1), info.st_gid);
  (void)!::fchmod(descriptor, info.st_mode & 0777);
}

}  // namespace

Failure system_failure(const std::filesystem::path& path, const char* action, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  std::string fix;
  if (error == ENOENT) fix = "; check the path";
  if (error == EACCES || error == EPERM || error == EROFS) fix = "; check its permissions";
  if (full) fix = "; free some space or choose another folder";
  return {full ? ErrorCode::resource_limit : ErrorCode::bad_input,
          path.string() + ": cannot " + action + ": " + std::strerror(error) + fix};
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::vector<std::byte>>(path, max_bytes);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::string>(path, max_bytes);
}

Result<std::string> read_file_start(const std::filesystem::path& path, std::size_t max_bytes) {
  return read_bytes<std::string>(path, [max_bytes](std::uint64_t size) -> Result<std::size_t> {
    return std::min<std::uint64_t>(size, max_bytes);
  });
}

Result<std::filesystem::path> follow_links(const std::filesystem::path& path) {
  constexpr int kMostLinks = 40;  // as the kernel
  std::filesystem::path place = path;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code error;
    if (!std::filesystem::is_symlink(place, error)) return place;
    const std::filesystem::path next = std::filesystem::read_symlink(place, error);
    if (error) return system_failure(path, "follow the link", error.value());
    place = place.parent_path() / next;  // An absolute path replaces the folder.
  }
  return system_failure(path, "follow the link", ELOOP);
}

Result<AtomicFile> AtomicFile::open(const fs::path& path, Naming naming) {
  const auto target = follow_links(path);
  if (!target) return target.failure();
  if (const auto found = obstacle(path, *target)) return *found;
  const fs::path folder = folder_of(*target);
  remove_stale_parts(folder);
  fs::path part;
  int descriptor = -1;
  if (naming == Naming::nameless_if_possible) descriptor = open_nameless(folder);
  if (descriptor < 0) descriptor = open_part(*target, part);
  if (descriptor < 0) return cannot_open(path, folder, errno);
  return AtomicFile(path, *target, std::move(part), descriptor);
}

AtomicFile::AtomicFile(fs::path path, fs::path target, fs::path part, int descriptor)
    : path_(std::move(path)), target_(std::move(target)), part_(std::move(part)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      part_(std::exchange(other.part_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  if (!part_.empty()) ::unlink(part_.c_str());
  ::close(descriptor_);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return system_failure(path_, "write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
  return {};
}

// Gives the file its final name. Returns 0 or an errno.
int AtomicFile::publish() {
  // A nameless file gets a free name directly. To replace a file it needs a name that can be renamed, for as
  // long as that takes.
  if (part_.empty()) {
    const std::string open_file = descriptor_path(descriptor_);
    const auto link_as = [&](const fs::path& name) {
      return ::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0
                                                                                                   : errno;
    };
    int error = link_as(target_);
    if (error != EEXIST) return error;
    fs::path part;
    do error = link_as(part = fresh_part(target_));
    while (error == EEXIST);
    if (error != 0) return error;
    part_ = std::move(part);
  }
  if (::rename(part_.c_str(), target_.c_str()) != 0) return errno;
  part_.clear();
  return 0;
}

Result<void> AtomicFile::commit() {
  BRUME_ASSERT(descriptor_ >= 0, path_.string());
  if (::fsync(descriptor_) != 0) return system_failure(path_, "write", errno);
  copy_permissions(descriptor_, target_);
  const int error = publish();
  if (error != 0) return system_failure(path_, "write", error);
  ::close(std::exchange(descriptor_, -1));  // All bytes are on disk already.
  return {};
}

Result<void> write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  auto file = AtomicFile::open(path);
  if (!file) return file.failure();
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

Result<void> write_file_atomic(const std::filesystem::path& path, const std::string& text) {
  return write_file_atomic(path, std::as_bytes(std::span(text)));
}

}  // namespace brume
