// brume-vdb: reads and writes the volume files of OpenVDB and NanoVDB for brume, which starts it as a child
// process (src/grids/worker.hpp). It speaks .brv on its standard streams (docs/reference/formats.md):
//
//   brume-vdb read FILE.vdb|FILE.nvdb [--bytes N] [--active-voxels N] [--seconds S]  > FILE.brv
//   brume-vdb write vdb|nvdb  < FILE.brv > FILE
//
// Files are untrusted, and the libraries crash on damaged ones: the program limits its own memory, processor
// time and files before it opens one.
#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "apps/vdb/formats.hpp"
#include "core/error.hpp"
#include "core/tasks.hpp"
#include "grids/brv_file.hpp"
#include "grids/suffix.hpp"

#ifdef __SANITIZE_ADDRESS__
/// OpenVDB leaks what it has read of a damaged file, asks for more memory than there is, and crashes.
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0:allocator_may_return_null=1:abort_on_error=1";
}
#endif

namespace brume::vdb {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMiB = 1 << 20;
/// Address space of the libraries and of the threads that compress.
constexpr std::uint64_t kBaseBytes = 1024 * kMiB;
/// A leaf of 512 equal values takes 130 bytes of a .vdb file, and 4 KiB in the trees of OpenVDB and ours;
/// zip, which .nvdb files may use, packs a thousand bytes into one.
constexpr std::uint64_t kMaxGrowth = 4096;
/// Both trees of a grid, and the bytes on their path to the pipe.
constexpr std::uint64_t kCopies = 3;
/// A damaged file may make the libraries count to 2^32. A valid one takes a fraction of this time.
constexpr double kBaseSeconds = 2, kSecondsPerMiB = 1;
/// What is written besides the pipe: messages.
constexpr std::uint64_t kMessageBytes = 65536;
constexpr unsigned kMaxThreads = 4;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // A sanitizer's shadow takes terabytes of address space.
#else
constexpr bool kLimitsMemory = true;
#endif

void print_line(const std::string& text) {
  std::string line = "brume-vdb: " + text;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  std::fprintf(stderr, "%s\n", line.c_str());
}

// The soft limit of processor time ends the program with a signal of its own, the hard one kills it.
void set_limit(__rlimit_resource_t resource, std::uint64_t value, std::uint64_t beyond = 0) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
  limit.rlim_max = std::min<rlim_t>(value + beyond, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

// A small file gets little: it cannot need more.
void limit_reading(const std::string& path, const grids::GridLimits& limits, int output) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0)
    throw Error(ErrorCode::bad_input, std::string("cannot read it: ") + std::strerror(errno));
  const auto bytes = static_cast<std::uint64_t>(info.st_size);
  const double seconds =
      std::min(limits.seconds, kBaseSeconds + kSecondsPerMiB * static_cast<double>(bytes / kMiB));
  if (kLimitsMemory)
    set_limit(RLIMIT_AS,
              kBaseBytes + std::min(kCopies * limits.bytes, kMaxGrowth * std::max(bytes, std::uint64_t{1})));
  set_limit(RLIMIT_CPU, static_cast<std::uint64_t>(seconds) + 1, 1);
  // Unless the result goes to a file, as a shell may direct it.
  if (::fstat(output, &info) == 0 && !S_ISREG(info.st_mode)) set_limit(RLIMIT_FSIZE, kMessageBytes);
}

Bytes read_all() {
  Bytes bytes;
  for (std::size_t used = 0;;) {
    if (bytes.size() < used + kMiB) bytes.resize(std::max(2 * bytes.size(), used + kMiB));
    const ssize_t got = ::read(STDIN_FILENO, &bytes[used], bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(ErrorCode::bad_input, std::string("cannot read: ") + std::strerror(errno));
    if (got == 0) {
      bytes.resize(used);
      return bytes;
    }
    used += static_cast<std::size_t>(got);
  }
}

void read(const std::string& path, const grids::GridLimits& limits, int output) {
  limit_reading(path, limits, output);
  grids::BrvWriter writer([&](std::span<const std::byte> bytes) { return write_all(output, bytes); },
                          {.compression_level = 0});
  const Reader reader{[&](const grids::Grid& grid) { writer.add(grid).value_or_throw(); },
                      [](const std::string& text) { print_line("warning: " + text); }};
  const std::string suffix = grids::lower_suffix(path);
  if (suffix != ".vdb" && suffix != ".nvdb")
    throw Error(ErrorCode::usage, "unknown file suffix; expected .vdb or .nvdb");
  writer.finish(suffix == ".vdb" ? read_vdb(path, limits, reader) : read_nvdb(path, limits, reader))
      .value_or_throw();
}

void write(const std::string& format, int output) {
  if (format != "vdb" && format != "nvdb") throw Error(ErrorCode::usage, "expected vdb or nvdb");
  grids::GridFile file;
  {
    const Bytes bytes = read_all();
    file = grids::decode_brv(bytes, {.bytes = UINT64_MAX, .active_voxels = UINT64_MAX}).value_or_throw();
  }
  format == "vdb" ? write_vdb(file, output) : write_nvdb(file, output);
}

template <typename Number>
Number parse(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(ErrorCode::usage, text + ": is no number");
  return value;
}

void run(const std::vector<std::string>& arguments) {
  constexpr const char* kUsage =
      "usage: brume-vdb read FILE.vdb|FILE.nvdb [--bytes N] [--active-voxels N] [--seconds S] > FILE.brv, "
      "or brume-vdb write vdb|nvdb < FILE.brv > FILE";
  if (arguments.size() < 2 || arguments.size() % 2 != 0) throw Error(ErrorCode::usage, kUsage);
  grids::GridLimits limits;
  for (std::size_t i = 2; i < arguments.size(); i += 2) {
    const std::string& name = arguments[i];
    if (name == "--bytes")
      limits.bytes = std::min<std::uint64_t>(parse<std::uint64_t>(arguments[i + 1]), 1ull << 60);
    else if (name == "--active-voxels")
      limits.active_voxels = parse<std::uint64_t>(arguments[i + 1]);
    else if (name == "--seconds")
      limits.seconds = parse<double>(arguments[i + 1]);
    else
      throw Error(ErrorCode::usage, kUsage);
  }
  // OpenVDB logs to standard output.
  const int output = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (output < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw Error(ErrorCode::internal, std::string("standard output: ") + std::strerror(errno));
  if (arguments[0] == "read") return read(arguments[1], limits, output);
  if (arguments[0] == "write") return write(arguments[1], output);
  throw Error(ErrorCode::usage, kUsage);
}

int run_and_report(const std::vector<std::string>& arguments) {
  // A crash is reported by the parent: no core file.
  set_limit(RLIMIT_CORE, 0);
  ::mallopt(M_ARENA_MAX, 2);
  set_thread_count(std::clamp(std::thread::hardware_concurrency(), 1u, kMaxThreads));
  try {
    run(arguments);
    return 0;
  } catch (const Error& error) {
    print_line(error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    print_line("takes more memory than a file of its size may");
    return static_cast<int>(ErrorCode::resource_limit);
  } catch (const std::exception& error) {
    print_line(std::string("a damaged file: ") + error.what());
    return static_cast<int>(ErrorCode::bad_input);
  }
}

}  // namespace

Result<void> write_all(int output, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(output, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0)
      return Failure{ErrorCode::resource_limit, std::string("cannot write: ") + std::strerror(errno)};
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
  return {};
}

void check_limits(const std::string& name, std::uint64_t active, std::uint64_t bytes, std::uint64_t& used,
                  const grids::GridLimits& limits) {
  if (active > limits.active_voxels)
    throw Error(ErrorCode::resource_limit, "grid \"" + name + "\" has " + std::to_string(active) +
                                               " active voxels, more than the limit of " +
                                               std::to_string(limits.active_voxels));
  used += bytes;
  if (used > limits.bytes)
    throw Error(ErrorCode::resource_limit, "its volumes take " + std::to_string(used / kMiB) +
                                               " MiB, more than the limit of " +
                                               std::to_string(limits.bytes / kMiB) + " MiB");
}

}  // namespace brume::vdb

int main(int argc, char** argv) {
  return brume::vdb::run_and_report({argv + 1, argv + argc});
}
