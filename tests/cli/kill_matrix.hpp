// Ends the program in every way at many places, and checks that its files are whole and that the next run
// completes them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/run_program.hpp"

namespace brume::cli {

/// A command that writes files into the folder `out`.
struct WritingCommand {
  std::vector<std::string> arguments;
  bool resumes = false;  ///< Takes --resume, which continues an ended run.
  bool exact = true;     ///< Writes the same bytes each time, but for JSON.
  std::vector<std::pair<std::string, std::string>> environment = {};
};

/// Ends runs of one command in a folder of its own. After each the files in `out` are those from before or
/// complete; then a run that nothing ends completes them, and no other file is there.
class KillMatrix {
 public:
  /// Fills the folder with the inputs, and runs the command once to learn what it writes.
  explicit KillMatrix(WritingCommand command);

  /// Each returns the number of runs that ended early. By a signal, before evenly spaced calls that change
  /// files:
  int end_by_signal(int signal, std::uint64_t runs);
  /// By a limit of the file size (RLIMIT_FSIZE):
  int end_by_file_size(std::uint64_t runs);
  /// By a full disk: `out` is a tmpfs of 1, 2, 3... pages. 0 where none can be mounted, which takes root.
  int end_by_full_disk(std::uint64_t runs);

 private:
  using Files = std::map<std::string, std::string>;
  Outcome run(RunOptions options = {}, bool resume = false) const;
  Files files() const;
  void empty_out() const;
  void begin(bool with_old_files);
  void check_whole(bool parts_allowed) const;
  void check_completion() const;
  bool is_whole(const std::string& name, const std::string& bytes) const;
  int check_run(const Outcome& outcome, const std::vector<int>& codes, bool killed) const;

  WritingCommand command_;
  WorkFolder folder_;
  Files expected_, old_;
  std::uint64_t calls_ = 0;  ///< Calls that change files in a whole run.
};

/// All commands that write files, but `demo` and `view`.
std::vector<WritingCommand> writing_commands();

}  // namespace brume::cli
