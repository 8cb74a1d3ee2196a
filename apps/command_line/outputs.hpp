// The files that a command reads and writes. The one place that decides what may be written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/command_line/file_kind.hpp"
#include "core/error.hpp"

namespace brume::cli {

/// One file, whatever path leads to it: its device and its number there or, where nothing exists yet, its
/// folder's and its name. Symbolic links are followed.
struct FileIdentity {
  std::uint64_t device = 0, file = 0;
  std::string name;  ///< Empty for a file that exists.
  auto operator<=>(const FileIdentity&) const = default;
};
FileIdentity identity_of(const std::filesystem::path& path);

/// The inputs and outputs of one command. A command declares every output before its work starts, and its
/// inputs as soon as it knows them. Each declaration checks the whole:
///
/// - no output is an input or another output, by file identity;
/// - an output that exists has the kind of the new file (see is_of_kind) unless `force` is given;
/// - it can be created: the folder exists and is writable, the old file too.
///
/// "-" (standard output) and empty paths are ignored.
class Outputs {
 public:
  /// Allows replacing files of another kind.
  void set_force(bool force) { force_ = force; }

  /// The files that are declared so far, sorted.
  std::vector<std::filesystem::path> files_read() const;
  std::vector<std::filesystem::path> files_written() const;

  /// Declares files that the command reads. Throws Error (usage) if one is an output.
  void reads(const std::filesystem::path& file);
  void reads(const std::vector<std::filesystem::path>& files);

  /// Declares a file that the command writes for `option`, such as "-o" (the argument itself: ""). Throws
  /// Error (usage) by the rules above, and as check_writable does.
  void writes(const std::string& option, const std::filesystem::path& file, FileKind kind);

  /// Declares the frames first to last, inclusive, of a numbered sequence.
  void writes_frames(const std::string& option, const std::filesystem::path& pattern, FileKind kind,
                     std::uint32_t first, std::uint32_t last);

  /// Checks a file that is declared later, before any work.
  void will_write(const std::string& option, const std::filesystem::path& file, FileKind kind);

  /// States that a declared output needs no writing: it is up to date.
  void up_to_date(const std::filesystem::path& file);
  /// States that a frame of the sequence is complete: written, or already there.
  void frame_done(std::uint32_t frame);
  /// States that a frame of the sequence is not made: it does not count.
  void frame_skipped(std::uint32_t frame);
  /// The files of the frame that is being made, if it has several: until frame_done, explanations name those
  /// that are written.
  void begin_unit(std::shared_ptr<const Outputs> unit);
  /// Whether frames depend on those before: only --resume then continues the sequence.
  void set_frames_depend(bool depend) { frames_depend_ = depend; }
  /// Whether the command has --resume to continue the sequence; yes unless it says otherwise.
  void set_resumable(bool resumable) { resumable_ = resumable; }

  /// States how many frames of a film are drawn. It is written only when all are.
  void film_progress(const std::filesystem::path& film, std::uint32_t drawn, std::uint32_t frames);

  /// The failure of a command that stopped: if some of its outputs were written and some were not, it has the
  /// code `partial` and says which, and how to continue.
  Failure explain(const Failure& failure) const;
  /// The exit code and message of a command that a signal stopped: 128 + signal, or `partial`. From any
  /// thread.
  struct End {
    int code = 0;
    std::string message;
  };
  End explain_interruption(int signal) const;

  /// What has been written so far, for the terminal: "a.png, a.json"; empty: nothing.
  std::string written() const;
  /// Whether an error may be written to this file: it is declared as one output, nothing that is read, and
  /// new, empty or JSON that no scene reads. A scene that failed to load may refer to more files than are
  /// known: no --force here.
  bool may_hold_error(const std::filesystem::path& file) const;

 private:
  struct Output {
    std::string option;
    std::filesystem::path file;
    FileIdentity before;  ///< Identity at its declaration: a written file is another one.
    bool up_to_date = false;
  };
  struct Frames {
    std::filesystem::path pattern;
    std::uint32_t first = 0, last = 0;
    std::vector<bool> done;  ///< Skipped ones, too.
    std::ptrdiff_t skipped = 0;
    std::ptrdiff_t written() const;
  };
  void check_place(const std::string& option, const std::filesystem::path& file, const FileIdentity& identity,
                   FileKind kind);
  bool is_written(const Output& output) const;
  std::string frame_state(const std::string& unit) const;
  std::string unit_state() const;
  std::string state() const;

  std::string written_unlocked() const;

  mutable std::mutex mutex_;  ///< Guards all below: explain_interruption runs in another thread.
  std::map<FileIdentity, std::filesystem::path> inputs_;
  std::map<FileIdentity, std::string> options_;  ///< Option of each output.
  std::set<FileIdentity> named_twice_;
  std::vector<Output> outputs_;
  std::optional<Frames> frames_;
  std::shared_ptr<const Outputs> unit_;
  std::string film_state_;  ///< " after 3 of 48 frames; ..."; empty: no film.
  bool force_ = false, frames_depend_ = false, resumable_ = true;
};

/// Throws Error unless this file can be created: the folder exists and is writable, the file is no folder.
/// The code is usage where another name would do, else the code of AtomicFile::open.
void check_writable(const std::filesystem::path& file);

}  // namespace brume::cli
