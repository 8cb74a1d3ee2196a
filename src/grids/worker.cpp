#include "grids/worker.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "core/log.hpp"
#include "core/platform/child_process.hpp"
#include "core/platform/library.hpp"
#include "core/platform/process.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"
#include "grids/brv_file.hpp"
#include "grids/suffix.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;
using Cause = platform::ChildEnd::Cause;
using Bytes = std::vector<std::byte>;
using Clock = std::chrono::steady_clock;

constexpr const char* kPrefix = "brume-vdb: ";
constexpr const char* kWarning = "warning: ";
constexpr std::size_t kMaxWarnings = 8;
constexpr std::size_t kReadBytes = 1 << 20;
/// A child whose processor time is used up ends by itself. This ends one that hangs otherwise: it gives a
/// machine with other work this many times as long, and never less than a minute.
constexpr double kWallFactor = 10, kLeastWallSeconds = 60;

std::string program() {
  if (const std::string named = platform::environment("BRUME_VDB"); !named.empty()) return named;
  std::error_code ignored;
  const fs::path beside =
      platform::program_file().parent_path() / to_path(platform::program_name("brume-vdb"));
  return fs::exists(beside, ignored) ? beside.string() : "brume-vdb";
}

Failure cannot_start(const fs::path& path, int error) {
  if (error == ENOENT)
    return {ErrorCode::no_device,
            path.string() + ": requires the program brume-vdb, which " + platform::kVdbIsMissing};
  return {ErrorCode::internal, path.string() + ": cannot start brume-vdb: " + std::strerror(error)};
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(kPrefix, 0) == 0) lines.push_back(line.substr(std::strlen(kPrefix)));
  return lines;
}

void pass_warnings(const fs::path& path, const std::string& messages) {
  std::size_t count = 0;
  for (const std::string& line : split_lines(messages))
    if (line.rfind(kWarning, 0) == 0 && count++ < kMaxWarnings)
      log_warning(path.string() + ": " + line.substr(std::strlen(kWarning)));
}

// Why the child ended without success.
Failure failure_of(const fs::path& path, const platform::ChildEnd& end, const std::string& messages) {
  const std::string file = path.string();
  switch (end.cause) {
    case Cause::exited:
      break;
    case Cause::processor_time:
      return {ErrorCode::resource_limit, file + ": takes more processor time than a file of its size may"};
    case Cause::killed:
      return {ErrorCode::resource_limit, file + ": brume-vdb was killed; is there enough memory?"};
    case Cause::file_size:
      return system_failure(path, "write", EFBIG);
    case Cause::crashed:
      return {ErrorCode::bad_input, file + ": OpenVDB's reader crashed on it (signal " +
                                        std::to_string(end.code) + "); the file is damaged"};
  }
  const int code = end.code;
  const std::vector<std::string> lines = split_lines(messages);
  std::string reason = lines.empty() ? platform::last_line(messages) : lines.back();
  if (reason.empty()) reason = "brume-vdb ended with exit code " + std::to_string(code);
  const bool known =
      code == static_cast<int>(ErrorCode::bad_input) || code == static_cast<int>(ErrorCode::resource_limit);
  return {known ? static_cast<ErrorCode>(code) : ErrorCode::internal, file + ": " + reason};
}

// All that the child writes until it closes its end; nothing when that is too much or takes too long.
Result<Bytes> read_all(int descriptor, const fs::path& path, const GridLimits& limits) {
  // The directory takes less than the bricks; what is not a volume fits into the rest.
  const std::uint64_t max_bytes = limits.bytes + limits.bytes / 8 + (std::uint64_t{64} << 20);
  const double max_seconds = std::max(kLeastWallSeconds, kWallFactor * limits.seconds);
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(max_seconds));
  Bytes bytes;
  for (std::size_t used = 0;;) {
    const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (limits.is_stopped()) return Failure{ErrorCode::internal, path.string() + ": stopped"};
    if (rest <= 0) return Failure{ErrorCode::resource_limit, path.string() + ": brume-vdb does not answer"};
    const auto wait = std::min<std::int64_t>(rest, limits.stopped ? 100 : 1000);
    if (!platform::wait_readable(descriptor, static_cast<int>(wait))) continue;
    if (bytes.size() < used + kReadBytes) bytes.resize(std::max(2 * bytes.size(), used + kReadBytes));
    const std::ptrdiff_t got = platform::read_some(descriptor, std::span(bytes).subspan(used));
    if (got <= 0) {
      bytes.resize(used);
      return bytes;
    }
    used += static_cast<std::size_t>(got);
    if (used > max_bytes)
      return Failure{ErrorCode::resource_limit,
                     path.string() + ": brume-vdb returned more than the limits allow"};
  }
}

}  // namespace

Result<GridFile> read_in_child(const fs::path& path, const GridLimits& limits) {
  // The file exists, and the child can be reached.
  if (const auto start = read_file_start(path, 1); !start) return start.failure();
  auto stream = platform::make_child_output();
  if (!stream) return system_failure(path, "read", errno);
  platform::ChildProcess child;
  const int error = child.start(
      {program(), "read", path.string(), "--bytes", std::to_string(limits.bytes), "--active-voxels",
       std::to_string(limits.active_voxels), "--seconds", std::to_string(limits.seconds)},
      {.output = stream->childs.get()});
  if (error != 0) return cannot_start(path, error);
  stream->childs.close();

  // Its bytes.
  const Progress progress("read " + path.filename().string());
  const auto bytes = read_all(stream->ours.get(), path, limits);
  if (!bytes) return bytes.failure();
  const platform::ChildEnd end = child.wait();
  if (!end.is_success()) return failure_of(path, end, child.messages());
  pass_warnings(path, child.messages());
  auto file = decode_brv(*bytes, limits);
  if (file) return file;
  return Failure{file.failure().code, path.string() + ": " + file.failure().message};
}

Result<void> write_in_child(const fs::path& path, const GridFile& file) {
  auto target = AtomicFile::open(path);
  if (!target) return target.failure();

  auto stream = platform::make_child_input();
  if (!stream) return system_failure(path, "write", errno);
  platform::ChildProcess child;
  const int error = child.start({program(), "write", lower_suffix(path).substr(1)},
                                {.input = stream->childs.get(), .output = target->descriptor()});
  if (error != 0) return cannot_start(path, error);
  stream->childs.close();

  // It writes to our open file, which has no name until it is complete.
  const Progress progress("write " + path.filename().string());
  bool closed = false;
  BrvWriter writer(
      [&](std::span<const std::byte> bytes) {
        while (!bytes.empty() && !closed) {
          const std::ptrdiff_t put = platform::send_some(stream->ours.get(), bytes);
          closed = put < 0;  // Why, its exit code tells.
          if (!closed) bytes = bytes.subspan(static_cast<std::size_t>(put));
        }
        return Result<void>();
      },
      {.compression_level = 0});
  for (const Grid& grid : file.grids) {
    const auto added = writer.add(grid);
    if (!added) return Failure{added.failure().code, path.string() + ": " + added.failure().message};
  }
  if (auto finished = writer.finish(file.metadata); !finished) return finished;
  stream->ours.close();
  const platform::ChildEnd end = child.wait();
  if (!end.is_success()) return failure_of(path, end, child.messages());
  pass_warnings(path, child.messages());
  return target->commit();
}

}  // namespace brume::grids
