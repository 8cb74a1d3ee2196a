#include "core/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/atomic_file.hpp"

namespace brume {
namespace {

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
