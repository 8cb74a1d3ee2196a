// Runs another program as a child that never outlives this process, without a shell.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace brume {

/// An open file, closed with this.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { close(); }
  int get() const { return value_; }
  void close();

 private:
  int value_;
};

/// A child process. It ends with the thread that started it, and is ended by the destructor. Ctrl-C does not
/// reach it.
class ChildProcess {
 public:
  /// Descriptors that the child gets; -1: /dev/null.
  struct Streams {
    int input = -1, output = -1;
    int inherited = -1;  ///< Stays open under its number; -1: none.
  };

  ChildProcess() = default;
  ChildProcess(const ChildProcess&) = delete;
  ~ChildProcess();

  /// Starts the program arguments[0], searched on the PATH if it has no '/'. Standard error goes to a file in
  /// memory, which unlike a pipe never fills up. Returns 0 or an errno: ENOENT for a program that does not
  /// exist. Must not be called while a child runs.
  int start(const std::vector<std::string>& arguments, const Streams& streams);

  bool running() const { return process_ > 0; }
  /// Ends the child at once; wait() then returns.
  void kill();
  /// Waits for its end and returns its status, as waitpid reports it.
  int wait();
  /// The end of what it wrote to standard error, at most 4 KiB.
  std::string messages() const;

 private:
  Descriptor messages_;
  pid_t process_ = -1;
};

/// The last line of a text that is not empty.
std::string last_line(const std::string& text);

}  // namespace brume
