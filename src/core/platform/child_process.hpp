// Runs another program as a child that never outlives this process, without a shell.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/platform/files.hpp"

namespace brume::platform {

/// How a child ended.
struct ChildEnd {
  enum class Cause { exited, killed, crashed, processor_time, file_size };
  Cause cause = Cause::exited;
  int code = 0;  ///< Exit code, or the signal; on Windows the exception that ended it.
  bool is_success() const { return cause == Cause::exited && code == 0; }
};

/// A stream between this process and a child. Only `childs` is inherited.
struct ChildStream {
  Descriptor ours, childs;
};
/// What we write with send_some, and the child reads as its standard input; fails with errno.
std::optional<ChildStream> make_child_input();
/// What the child writes to its standard output, and we read with read_some.
std::optional<ChildStream> make_child_output();
/// As write_some, where the reader may have ended: that is a failure, not a signal.
std::ptrdiff_t send_some(int descriptor, std::span<const std::byte> bytes);
/// Waits at most so long for bytes or the end of what a child writes. False: there are none yet.
bool wait_readable(int descriptor, int milliseconds);

/// A child process. It ends with the thread that started it (on Windows: with the process), and is ended by
/// the destructor. Ctrl-C does not reach it.
class ChildProcess {
 public:
  /// Descriptors that the child gets; -1: nothing to read, and what it writes is dropped.
  struct Streams {
    int input = -1, output = -1;
    int inherited = -1;  ///< Stays open under its number; -1: none.
  };

  ChildProcess() = default;
  ChildProcess(const ChildProcess&) = delete;
  ~ChildProcess();

  /// Starts the program arguments[0], searched on the PATH if it names no folder. Standard error goes to a
  /// file that has no name, which unlike a pipe never fills up. Returns 0 or an errno: ENOENT for a program
  /// that does not exist. Must not be called while a child runs.
  int start(const std::vector<std::string>& arguments, const Streams& streams);

  bool running() const { return process_ > 0; }
  /// Ends the child at once; wait() then returns.
  void kill();
  /// Waits for its end.
  ChildEnd wait();
  /// The end of what it wrote to standard error, at most 4 KiB.
  std::string messages() const;

 private:
  Descriptor messages_;
  std::int64_t process_ = -1;  ///< Its number; on Windows its handle.
};

/// The last line of a text that is not empty.
std::string last_line(const std::string& text);

}  // namespace brume::platform
