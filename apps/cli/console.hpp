// Console output and signals: results go to standard output, progress, warnings and errors to standard error.
#pragma once

#include <filesystem>
#include <string>

#include "core/progress.hpp"

namespace brume::cli {

class Json;

/// Thrown when a command notices SIGINT or SIGTERM, so that unwinding releases its resources.
struct Interrupted {
  int signal;
};

/// Routes library warnings to standard error (drops them if `quiet`) and installs signal handlers: the first
/// SIGINT or SIGTERM requests a stop, the second ends the process.
void start_console(bool quiet);

/// Throws Interrupted if a signal has arrived.
void stop_if_interrupted();

/// Progress callback for long jobs: shows a line if standard error is a terminal, and throws Interrupted on a
/// signal.
Progress::Callback progress_display();

/// Prints one line, "brume: ...", to standard error, below any progress line.
void print_failure(const std::string& message);

/// Prints to standard output.
void print(const std::string& text);

/// Writes the object to the file `target`, or to standard output if it is "-". Throws Error.
void write_json(const std::string& target, const Json& object);

/// Throws Error (bad_input) unless this file can be created: called before the work whose result goes there.
/// Leaves no file behind. Accepts an empty path and "-".
void check_output(const std::filesystem::path& path);

/// Flushes standard output; throws Error if it could not be written.
void finish_output();

}  // namespace brume::cli
