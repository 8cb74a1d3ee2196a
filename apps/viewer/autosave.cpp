#include "apps/viewer/autosave.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "apps/viewer/screenshot.hpp"
#include "core/platform/process.hpp"
#include "scene/files/timeline_writer.hpp"

namespace brume::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "autosave_", kEnd = ".toml";
constexpr std::chrono::seconds kPathEvery{10};

// The process that writes a file of this name.
std::optional<int> owner_of(std::string_view name) {
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) return std::nullopt;
  name.remove_prefix(kBegin.size());
  name.remove_suffix(kEnd.size());
  int process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  if (error != std::errc() || end != name.data() + name.size() || process <= 0) return std::nullopt;
  return process;
}

// Our own number belongs to an earlier process: this one has saved nothing yet.
bool is_gone(int process) {
  return process == platform::process_id() || !platform::is_running(process);
}

/// How much there is to save: nothing of a session in which the player only walked.
std::size_t work_of(const Session& session) {
  return session.actions() + session.key_changes();
}

}  // namespace

Autosave::Autosave(const fs::path& folder)
    : file_(folder / (std::string(kBegin) + std::to_string(platform::process_id()) + std::string(kEnd))),
      copies_(folder / (file_.stem().string() + "_files")),
      last_(std::chrono::steady_clock::now()) {
  std::error_code error;
  copies_are_ours_ = !fs::exists(copies_, error);
}

void Autosave::wait() {
  if (saving_.valid()) failed_ = !saving_.get();
}

Result<void> Autosave::update(const Session& session) {
  // The result of the last save.
  if (saving_.valid()) {
    if (saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    auto saved = saving_.get();
    failed_ = !saved;
    if (failed_) return saved;
  }

  // The next one.
  const auto now = std::chrono::steady_clock::now();
  const std::size_t actions = work_of(session);
  if (actions == 0) saved_actions_ = 0;
  const bool path_is_due = !session.paused() && now - last_ > kPathEvery;
  if (failed_ || actions == 0 || (actions == saved_actions_ && !path_is_due)) return {};
  saved_actions_ = actions;
  last_ = now;
  saving_ = std::async(std::launch::async, [file = file_, timeline = session.recording()] {
    return scene::save_timeline(file, timeline);
  });
  return {};
}

Result<bool> Autosave::finish(const Session& session) {
  wait();
  if (work_of(session) > 0)
    if (auto saved = scene::save_timeline(file_, session.recording()); !saved) return saved.failure();
  std::error_code error;
  return fs::exists(file_, error);
}

void Autosave::discard() {
  wait();
  std::error_code error;
  fs::remove(file_, error);
  if (copies_are_ours_) fs::remove_all(copies_, error);
}

std::vector<fs::path> recover_sessions(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const auto owner = owner_of(entry->path().filename().string());
    if (owner && is_gone(*owner)) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> recovered;
  for (const fs::path& file : found) {
    const fs::path name = free_name(folder, "recovered", ".toml");
    fs::rename(file, name, error);
    if (!error) recovered.push_back(name);
  }
  return recovered;
}

}  // namespace brume::viewer
