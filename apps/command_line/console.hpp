// Console output and signals: results go to standard output, progress, warnings and errors to standard error.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace brume::cli {

class Json;

/// Thrown when a command notices a signal, so that unwinding releases its resources.
struct Interrupted {
  int signal;
};

/// What one run of a command line has on the console: which signal arrived, what is quiet, the progress line
/// that is shown, and where its JSON goes. All functions below refer to it: a process has one at a time,
/// which begins without any of that. A process that runs several command lines has one for each.
class Console {
 public:
  Console();
  Console(const Console&) = delete;
  ~Console();

  struct State;

 private:
  std::unique_ptr<State> state_;
};

/// How the progress of long jobs is reported.
enum class ProgressForm {
  line,  ///< A line that is overwritten, on a terminal only.
  json,  ///< progress_json, a line every half second, wherever standard error leads to.
};

/// Routes library warnings to standard error (drops them if `quiet`) and installs signal handlers
/// (platform::catch_stops): the first signal requests a stop, the second ends the process. The handlers
/// outlive the run: a complete command ends with its own exit code.
void start_console(bool quiet, ProgressForm progress);

/// Shows the progress of long jobs (core/progress.hpp), and enforces stops, from a thread of
/// its own, until it is destroyed: where a signal has not ended the command after `grace_seconds`, which may
/// change meanwhile, calls
/// `end_of(signal)`, which reports it and returns the exit code, and ends the process. That leaves no half
/// file, since files have no name until they are complete.
class Attendant {
 public:
  Attendant(const std::atomic<double>& grace_seconds, std::function<int(int signal)> end_of);
  Attendant(const Attendant&) = delete;
  ~Attendant();

 private:
  struct Thread;
  Thread* thread_;
};

/// Whether a signal has arrived.
bool is_interrupted();

/// Throws Interrupted if a signal has arrived.
void stop_if_interrupted();

/// Returns to the first caller only, which then reports the end of the command; others wait for the process
/// to end.
void claim_end();

/// Characters of a line of the terminal that a descriptor leads to; 80 where it leads to none.
std::size_t terminal_width(int descriptor);

/// Prints one line, "brume: ...", to standard error, below any progress line.
void print_failure(const std::string& message);

/// Prints one line, "brume: ...", to standard error, below any progress line, unless it is --quiet.
void print_note(const std::string& line);

/// Prints a line to standard error, below any progress line, if that is a terminal.
void print_on_terminal(const std::string& line);

/// Prints to standard output.
void print(const std::string& text);

/// The command and the target of its --json (empty: none), for write_json and write_json_error.
void set_json(const std::string& command, const std::string& target);

/// Writes the object, after its schema and command, to the file `target`, or to standard output if it is "-".
/// Throws Error.
void write_json(const std::string& target, const Json& object);

/// Writes {"error": {...}} where the command's result was to go, if that is standard output, or a file that
/// `may_write_file` allows, and no result was written. Errors in doing so are ignored: one is being reported.
void write_json_error(int code, const std::string& message, bool may_write_file);

/// Flushes standard output; throws Error if it could not be written.
void finish_output();

}  // namespace brume::cli
