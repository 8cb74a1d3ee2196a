// What the program says and where: results on standard output, all else on standard error.
#pragma once

#include <filesystem>
#include <string>

#include "core/progress.hpp"

namespace brume::cli {

class Json;

/// Thrown where a command notices that SIGINT or SIGTERM has arrived, so that what it holds is cleaned up.
struct Interrupted {
  int signal;
};

/// Warnings of the library go to standard error from here on (nowhere when quiet), and the first SIGINT or
/// SIGTERM only asks the command to end; the second one ends the process.
void start_console(bool quiet);

/// Throws Interrupted when a signal has arrived.
void stop_if_interrupted();

/// For long jobs: shows a line on standard error where that is a terminal, and stops on a signal.
Progress::Callback progress_display();

/// One line on standard error, "brume: ...", over what progress may stand there.
void say_failure(const std::string& message);

/// Text on standard output.
void print(const std::string& text);

/// Writes the object to `target`, "-" for standard output. Throws Error.
void write_json(const std::string& target, const Json& object);

/// Throws Error (bad_input) unless a file of this name can be made: asked before any work is done for it.
/// Nothing is left behind. An empty name and "-" are fine.
void check_output(const std::filesystem::path& path);

/// Impulses standard output out; throws Error when it could not be written.
void finish_output();

}  // namespace brume::cli
