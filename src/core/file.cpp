#include "core/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace brume {
namespace {

Failure system_failure(const std::filesystem::path& path, const char* action, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  std::string fix;
  if (error == ENOENT) fix = "; check the path";
  if (error == EACCES || error == EPERM || error == EROFS) fix = "; check its permissions";
  if (full) fix = "; free some space or choose another folder";
  return {full ? ErrorCode::resource_limit : ErrorCode::bad_input,
          path.string() + ": cannot " + action + ": " + std::strerror(error) + fix};
}

struct Descriptor {
  int value = -1;
  ~Descriptor() {
    if (value >= 0) ::close(value);  // Read-only: errors lose no data.
  }
};

template <typename Container>
Result<Container> read_whole(const std::filesystem::path& path, std::uint64_t max_bytes) {
  // Open the file and check its type and size.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.value < 0) return system_failure(path, "open", errno);
  struct stat info {};
  if (::fstat(file.value, &info) != 0) return system_failure(path, "inspect", errno);
  if (!S_ISREG(info.st_mode))
    return Failure{ErrorCode::bad_input, path.string() + ": not a regular file; check the path"};
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes) {
    return Failure{ErrorCode::resource_limit, path.string() + ": has " + std::to_string(size) +
                                                  " bytes, at most " + std::to_string(max_bytes) +
                                                  " are read"};
  }

  // Read it.
  Container bytes(size, {});
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

}  // namespace

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::vector<std::byte>>(path, max_bytes);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::string>(path, max_bytes);
}

Result<AtomicFile> AtomicFile::open(const std::filesystem::path& path) {
  std::filesystem::path temporary = path;
  temporary += ".part" + std::to_string(::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const int error = errno;
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::error_code ignored;
    if (error == ENOENT && !std::filesystem::exists(folder, ignored)) {
      return Failure{ErrorCode::bad_input, path.string() + ": cannot write: the folder " + folder.string() +
                                               " does not exist; create it first"};
    }
    return system_failure(path, "write", error);
  }
  return AtomicFile(path, std::move(temporary), descriptor);
}

AtomicFile::AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
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

Result<void> AtomicFile::commit() {
  BRUME_ASSERT(descriptor_ >= 0, path_.string());
  if (::fsync(descriptor_) != 0) return system_failure(path_, "write", errno);
  const int closed = ::close(std::exchange(descriptor_, -1));
  const int error = closed != 0 ? errno : (::rename(temporary_.c_str(), path_.c_str()) != 0 ? errno : 0);
  if (error == 0) return {};
  ::unlink(temporary_.c_str());
  return system_failure(path_, "write", error);
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
