// Console output and signals: results go to standard output, progress, warnings and errors to standard error.
#pragma once

#include <string>

#include "core/progress.hpp"

namespace brume::cli {

class Json;

/// Thrown when a command notices a signal, so that unwinding releases its resources.
struct Interrupted {
  int signal;
  std::string state = {};  ///< What is there and what is not, for the message; may be empty.
};

/// Opens the standard descriptors that the caller closed, without access: otherwise the next file that is
/// opened would get what is printed. Comes first in the program.
void reserve_standard_descriptors();

/// Routes library warnings to standard error (drops them if `quiet`) and installs signal handlers. The first
/// SIGINT, SIGTERM, SIGHUP (unless the caller ignores it, as nohup does) or SIGXCPU requests a stop, the
/// second ends the process. A file that reaches the size limit fails to be written, like one on a full disk
/// (SIGXFSZ is ignored).
void start_console(bool quiet);

/// Throws Interrupted if a signal has arrived.
void stop_if_interrupted();

/// Progress callback for long jobs: shows a line if standard error is a terminal, and throws Interrupted on a
/// signal.
Progress::Callback progress_display();

/// Prints one line, "brume: ...", to standard error, below any progress line.
void print_failure(const std::string& message);

/// Prints a line to standard error, below any progress line, if that is a terminal.
void print_on_terminal(const std::string& line);

/// Prints to standard output.
void print(const std::string& text);

/// Writes the object to the file `target`, or to standard output if it is "-". Throws Error.
void write_json(const std::string& target, const Json& object);

/// Flushes standard output; throws Error if it could not be written.
void finish_output();

}  // namespace brume::cli
