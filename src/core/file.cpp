#include "core/file.hpp"

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

#include "core/platform/files.hpp"
#include "core/platform/process.hpp"
#include "core/utf8.hpp"

namespace brume {
namespace {

namespace fs = std::filesystem;

// Reads as many bytes as `wanted` returns for the size of the file.
template <typename Container, typename Wanted>
Result<Container> read_bytes(const std::filesystem::path& path, const Wanted& wanted) {
  // Open the file and check its type and size.
  const platform::Descriptor file(platform::open_to_read(path));
  if (file.get() < 0) return system_failure(path, "open", errno);
  const auto info = platform::info_of(file.get());
  if (!info) return system_failure(path, "inspect", errno);
  if (!info->is_regular)
    return Failure{ErrorCode::bad_input, path.string() + ": not a regular file; check the path"};
  const Result<std::size_t> size = wanted(info->size);
  if (!size) return size.failure();

  // Read it.
  Container bytes(*size, {});
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::ptrdiff_t got =
        platform::read_some(file.get(), std::as_writable_bytes(std::span(bytes)).subspan(done));
    if (got < 0) return system_failure(path, "read", errno);
    if (got == 0) break;  // The file has shrunk meanwhile.
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
  return folder_of(target) / to_path("." + stem + std::string(kPartMark) +
                                     std::to_string(platform::process_id()) + "-" + std::to_string(number++));
}

// ".NAME.brume-part-PID-N"
bool is_part(std::string_view name) {
  const std::size_t mark = name.rfind(kPartMark);
  if (name.empty() || name.front() != '.' || mark == std::string_view::npos || mark == 0) return false;
  const std::string_view numbers = name.substr(mark + kPartMark.size());
  return std::count(numbers.begin(), numbers.end(), '-') == 1 &&
         numbers.find_first_not_of("0123456789-") == std::string_view::npos;
}

// Once per folder and process: a sequence of frames would otherwise list its folder at every frame.
bool is_first_visit(const fs::path& folder) {
  static std::mutex mutex;
  // A forked child is another process.
  static std::set<std::tuple<int, std::uint64_t, std::uint64_t>> visited;
  const auto info = platform::info_of(folder);
  if (!info) return false;
  const std::lock_guard lock(mutex);
  return visited.emplace(platform::process_id(), info->device, info->file).second;
}

void remove_stale_parts(const fs::path& folder) {
  if (!is_first_visit(folder)) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_part(entry->path().filename().string())) platform::remove_if_stale(entry->path());
}

// Creates and locks a part.
int open_part(const fs::path& target, fs::path& part) {
  int descriptor = -1;
  do descriptor = platform::create_part(part = fresh_part(target), target);
  while (descriptor < 0 && errno == EEXIST);
  return descriptor;
}

// Why a file that exists cannot be replaced.
std::optional<Failure> obstacle(const fs::path& path, const fs::path& target) {
  if (const std::string why = platform::why_not_a_name(target); !why.empty())
    return Failure{ErrorCode::bad_input, path.string() + ": " + why + "; choose another name"};
  const auto info = platform::info_of(target);
  if (!info) return std::nullopt;
  if (info->is_folder)
    return Failure{ErrorCode::bad_input, path.string() + ": is a folder; name a file inside it"};
  if (!info->is_regular)
    return Failure{ErrorCode::bad_input, path.string() + ": is not a regular file; name another file"};
  if (!platform::may_write(target)) return system_failure(path, "write", errno);
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

}  // namespace

Failure system_failure(const std::filesystem::path& path, const char* action, int error) {
  const bool full = platform::is_full(error);
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
  if (naming == Naming::nameless_if_possible) descriptor = platform::open_nameless(folder);
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
  platform::close(descriptor_);
  if (!part_.empty()) platform::remove(part_);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::ptrdiff_t put = platform::write_some(descriptor_, bytes);
    if (put < 0) return system_failure(path_, "write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
  return {};
}

// Closes the file and gives it its final name. Returns 0 or an errno.
int AtomicFile::publish() {
  // A nameless file gets a free name directly. To replace a file it needs a name that can be renamed, for as
  // long as that takes.
  if (part_.empty()) {
    int error = platform::link_nameless(descriptor_, target_);
    if (error == 0) platform::close(std::exchange(descriptor_, -1));  // All bytes are on disk already.
    if (error != EEXIST) return error;
    fs::path part;
    do error = platform::link_nameless(descriptor_, part = fresh_part(target_));
    while (error == EEXIST);
    if (error != 0) return error;
    part_ = std::move(part);
  }
  return platform::replace(std::exchange(descriptor_, -1), std::exchange(part_, {}), target_);
}

std::string AtomicFile::path_for_child() const {
  return platform::path_for_child(descriptor_, part_);
}

Result<void> AtomicFile::commit() {
  BRUME_ASSERT(descriptor_ >= 0, path_.string());
  if (!platform::sync(descriptor_)) return system_failure(path_, "write", errno);
  platform::copy_permissions(descriptor_, target_);
  const int error = publish();
  if (error != 0) return system_failure(path_, "write", error);
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
