#include "apps/command_line/outputs.hpp"

#include <algorithm>

#include "apps/command_line/console.hpp"
#include "apps/command_line/frame_names.hpp"
#include "core/file.hpp"
#include "core/platform/files.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

bool names_a_file(const fs::path& path) {
  return !path.empty() && path != "-";
}

bool exists(const FileIdentity& identity) {
  return identity.name.empty();
}

// "-o a.png", or "a.png" for an argument.
std::string named(const std::string& option, const fs::path& file) {
  return (option.empty() ? "" : option + " ") + file.string();
}

Error is_input(const std::string& option, const fs::path& file, const fs::path& input) {
  const std::string which = file == input ? "" : " " + input.string();
  return {ErrorCode::usage, named(option, file) + ": is the input" + which + "; name another file"};
}

}  // namespace

FileIdentity identity_of(const fs::path& path) {
  const auto target = follow_links(path);
  const fs::path& place = target ? *target : path;
  if (const auto info = platform::info_of(place)) return {info->device, info->file, ""};
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (const auto info = platform::info_of(folder))
    return {info->device, info->file, place.filename().string()};
  return {0, 0, place.string()};
}

void check_writable(const fs::path& file) {
  // The destructor discards it.
  const auto opened = AtomicFile::open(file);
  if (opened) return;
  std::error_code ignored;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const bool bad_name = !platform::why_not_a_name(file).empty() || !fs::is_directory(folder, ignored) ||
                        fs::is_directory(file, ignored) ||
                        (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored));
  throw Error(bad_name ? ErrorCode::usage : opened.failure().code, opened.failure().message);
}

void Outputs::reads(const fs::path& file) {
  if (!names_a_file(file)) return;
  const FileIdentity identity = identity_of(file);
  inputs_.emplace(identity, file);
  const auto output = options_.find(identity);
  if (output == options_.end()) return;
  const auto same =
      std::find_if(outputs_.begin(), outputs_.end(), [&](const Output& o) { return o.before == identity; });
  throw is_input(output->second, same == outputs_.end() ? file : same->file, file);
}

void Outputs::reads(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) reads(file);
}

std::vector<fs::path> Outputs::files_read() const {
  std::vector<fs::path> files;
  for (const auto& [identity, file] : inputs_) files.push_back(file);
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> Outputs::files_written() const {
  std::vector<fs::path> files;
  for (const Output& output : outputs_) files.push_back(output.file);
  std::sort(files.begin(), files.end());
  return files;
}

void Outputs::check_place(const std::string& option, const fs::path& file, const FileIdentity& identity,
                          FileKind kind) {
  if (const auto input = inputs_.find(identity); input != inputs_.end())
    throw is_input(option, file, input->second);
  if (const auto other = options_.find(identity); other != options_.end()) {
    named_twice_.insert(identity);
    const std::string which = other->second.empty() ? "" : " of " + other->second;
    throw Error(ErrorCode::usage,
                named(option, file) + ": is also the output" + which + "; name another file");
  }
  if (!exists(identity)) return;
  check_writable(file);
  if (force_ || is_of_kind(file, kind).value_or_throw()) return;
  throw Error(ErrorCode::usage, named(option, file) + ": exists and is no " + name_of(kind) +
                                    "; name another file, or give --force");
}

void Outputs::writes(const std::string& option, const fs::path& file, FileKind kind) {
  if (!names_a_file(file)) return;
  const FileIdentity identity = identity_of(file);
  check_place(option, file, identity, kind);
  check_writable(file);
  const std::lock_guard lock(mutex_);
  options_.emplace(identity, option);
  outputs_.push_back({option, file, identity, false});
}

void Outputs::writes_frames(const std::string& option, const fs::path& pattern, FileKind kind,
                            std::uint32_t first, std::uint32_t last) {
  check_writable(sequence_name(pattern, first));
  for (std::uint32_t frame = first; frame <= last; ++frame) {
    const fs::path file = sequence_name(pattern, frame);
    const FileIdentity identity = identity_of(file);
    check_place(option, file, identity, kind);
    // Two names of the sequence can only be the same file if it exists.
    if (exists(identity)) options_.emplace(identity, option);
    stop_if_interrupted();
  }
  const std::lock_guard lock(mutex_);
  frames_ = Frames{pattern, first, last, std::vector<bool>(std::size_t{last} - first + 1), 0};
}

void Outputs::will_write(const std::string& option, const fs::path& file, FileKind kind) {
  const FileIdentity identity = identity_of(file);
  check_place(option, file, identity, kind);
  if (exists(identity)) options_.emplace(identity, option);
}

void Outputs::film_progress(const fs::path& film, std::uint32_t drawn, std::uint32_t frames) {
  const std::lock_guard lock(mutex_);
  film_state_ = " after " + std::to_string(drawn) + " of " + std::to_string(frames) + " frames; " +
                film.string() +
                " is not written (only numbered frames, such as -o f_%04d.png, can be continued)";
}

bool Outputs::may_hold_error(const fs::path& file) const {
  const std::lock_guard lock(mutex_);
  const bool declared =
      std::any_of(outputs_.begin(), outputs_.end(), [&](const Output& o) { return o.file == file; });
  const FileIdentity identity = identity_of(file);
  if (!declared || inputs_.contains(identity) || named_twice_.contains(identity)) return false;
  if (!exists(identity)) return true;
  const auto is_json = is_of_kind(file, FileKind::json);
  const auto is_input = may_be_json_input(file);
  return is_json && *is_json && is_input && !*is_input;
}

void Outputs::up_to_date(const fs::path& file) {
  const std::lock_guard lock(mutex_);
  for (Output& output : outputs_)
    if (output.file == file) output.up_to_date = true;
}

void Outputs::frame_done(std::uint32_t frame) {
  const std::lock_guard lock(mutex_);
  BRUME_ASSERT(frames_ && frame >= frames_->first && frame <= frames_->last, std::to_string(frame));
  frames_->done[frame - frames_->first] = true;
  unit_.reset();
}

void Outputs::frame_skipped(std::uint32_t frame) {
  frame_done(frame);
  const std::lock_guard lock(mutex_);
  ++frames_->skipped;
}

std::ptrdiff_t Outputs::Frames::written() const {
  return std::count(done.begin(), done.end(), true) - skipped;
}

void Outputs::begin_unit(std::shared_ptr<const Outputs> unit) {
  const std::lock_guard lock(mutex_);
  unit_ = std::move(unit);
}

bool Outputs::is_written(const Output& output) const {
  const FileIdentity now = identity_of(output.file);
  return exists(now) && now != output.before;
}

// "6 of 144 frames written; continue with --resume or --frames 6-143"
std::string Outputs::frame_state(const std::string& unit) const {
  const auto& done = frames_->done;
  const std::ptrdiff_t count = frames_->written(), all = std::ssize(done) - frames_->skipped;
  std::string text = std::to_string(count) + " of " + std::to_string(all) + " frames written";
  if (!unit.empty()) text += "; of the next, " + unit;
  if (count == all) return text;
  const auto begin = std::find(done.begin(), done.end(), false) - done.begin();
  const auto next = static_cast<std::uint64_t>(begin) + frames_->first;
  const std::string rest = "--frames " + std::to_string(next) + "-" + std::to_string(frames_->last);
  if (!resumable_) return text + "; continue with " + rest;
  text += "; continue with --resume";
  return frames_depend_ || begin != count ? text : text + " or " + rest;
}

// Which files of the frame that is being made are written; empty if none are.
std::string Outputs::unit_state() const {
  if (!unit_) return "";
  const std::lock_guard lock(unit_->mutex_);
  if (std::string text = unit_->state(); !text.empty()) return text;
  const std::string files = unit_->written_unlocked();
  return files.empty() ? "" : "written: " + files;
}

// Which of several outputs are written; empty if all or none are.
std::string Outputs::state() const {
  std::string missing;
  std::size_t done = 0, open = 0;
  for (const Output& output : outputs_) {
    if (output.up_to_date) continue;
    if (is_written(output)) {
      ++done;
      continue;
    }
    ++open;
    missing += (missing.empty() ? "" : ", ") + output.file.string();
  }
  std::string frames;
  if (frames_) {
    const bool all = std::find(frames_->done.begin(), frames_->done.end(), false) == frames_->done.end();
    const bool any = frames_->written() > 0;
    const std::string unit = unit_state();
    ++(all ? done : open);
    if (!all && (any || !unit.empty())) return frame_state(unit);
  }
  if (done == 0 || open == 0) return "";
  return "written: " + written_unlocked() + (missing.empty() ? "" : "; not written: " + missing);
}

Failure Outputs::explain(const Failure& failure) const {
  const std::lock_guard lock(mutex_);
  const std::string text = state();
  if (text.empty()) return failure;
  return {ErrorCode::partial, failure.message + "; " + text};
}

Outputs::End Outputs::explain_interruption(int signal) const {
  const std::lock_guard lock(mutex_);
  if (const std::string text = state(); !text.empty())
    return {static_cast<int>(ErrorCode::partial), "interrupted; " + text};
  if (const std::string files = written_unlocked(); !files.empty())
    return {static_cast<int>(ErrorCode::partial), "interrupted; written: " + files};
  return {128 + signal, "interrupted" + film_state_};
}

std::string Outputs::written() const {
  const std::lock_guard lock(mutex_);
  return written_unlocked();
}

std::string Outputs::written_unlocked() const {
  std::string text;
  const auto add = [&](const std::string& file) { text += (text.empty() ? "" : ", ") + file; };
  if (frames_ && frames_->written() > 0)
    add(frames_->pattern.string() + " (" + std::to_string(frames_->written()) + " frames)");
  for (const Output& output : outputs_)
    if (is_written(output)) add(output.file.string());
  return text;
}

}  // namespace brume::cli
