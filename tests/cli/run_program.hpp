// Runs the program, as a shell does or by a call of its function, and captures its output.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/work_folder.hpp"

namespace brume::cli {

struct Outcome {
  int exit_code = -1;  ///< 128 + signal if a signal ended it.
  std::string out, error;
  double cpu_seconds = 0;        ///< Of all threads of its process; 0: a call.
  std::uint64_t file_calls = 0;  ///< With `signal_at`: the number of such calls that were begun.
};

struct RunOptions {
  bool own_process = false;  ///< Starts the program, although a call of its function would do.
  std::string program;       ///< Instead of build/.../brume.
  std::vector<std::pair<std::string, std::string>> environment;  ///< Added to the test's own.
  std::uint64_t file_bytes = 0;                                  ///< No file may grow past this; 0: any size.
  std::string out_file;                                          ///< Receives standard output instead.
  std::string error_file;                                        ///< Receives standard error instead.
  bool close_standard_descriptors = false;                       ///< The program starts without them.
  int signal = 0;                                                ///< Sent once `signal_when` holds.
  std::function<bool()> signal_when;
  /// Tests `signal_when` before each call of the main thread that changes files, which waits meanwhile: the
  /// program cannot run ahead of the signal, however fast it is.
  bool signal_before_call = false;
  /// Where the signal is sent instead: before the main thread's call number `signal_at` that changes files
  /// (opens for writing, writes, sends, syncs, links, renames, removes), from 1. 0: nowhere.
  std::uint64_t signal_at = 0;

  bool need_process() const {
    return own_process || !program.empty() || !environment.empty() || file_bytes > 0 || !out_file.empty() ||
           !error_file.empty() || close_standard_descriptors || signal != 0;
  }
};

/// Runs brume with these arguments in `folder`: by a call in test programs with call_program.cpp, where the
/// options need no process of its own; else it starts build/.../brume.
Outcome run_brume(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                  const RunOptions& options = {});

/// Whether a file of progress reports (--progress json) has one of the job of this name.
bool reports_job(const std::filesystem::path& file, const std::string& name);

/// A call of the program's function with these arguments in `folder`.
using ProgramCall = Outcome (*)(const std::filesystem::path& folder,
                                const std::vector<std::string>& arguments);
/// What run_brume calls; null, as at first: it always starts the program.
void set_program_call(ProgramCall call);

/// Fails unless the program ends with the exit code, prints nothing to standard output and one line to
/// standard error that contains all parts, and leaves the folder unchanged, but for the same line as JSON in
/// the file of --json.
void expect_failure(const WorkFolder& folder, const std::vector<std::string>& arguments, int exit_code,
                    const std::vector<std::string>& parts, const RunOptions& options = {});

/// An OBJ file: a closed room of 4 x 3 x 4 m around the origin, with a block in it.
std::string room_obj();

}  // namespace brume::cli
