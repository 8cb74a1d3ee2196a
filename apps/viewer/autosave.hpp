// Saves the session while the viewer runs, so that a crash loses none of its actions.
#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <vector>

#include "apps/viewer/session.hpp"
#include "core/error.hpp"

namespace brume::viewer {

/// The timeline of the running session in "autosave_PID.toml". It exists from the first action until
/// `discard`.
class Autosave {
 public:
  explicit Autosave(const std::filesystem::path& folder);
  Autosave(const Autosave&) = delete;

  const std::filesystem::path& file() const { return file_; }

  /// To be called every frame: saves, in another thread, after every action, and now and then while the clock
  /// runs, for the path of the camera. Returns the failure to save once, and then gives up.
  Result<void> update(const Session& session);

  /// For a program that ends early: saves the session as it is now. Returns whether there is anything to
  /// recover; fails if this session could not be saved.
  Result<bool> finish(const Session& session);

  /// For a program that ends as the user wants: removes what it saved.
  void discard();

 private:
  void wait();
  std::filesystem::path file_, copies_;
  bool copies_are_ours_ = false;
  std::future<Result<void>> saving_;
  std::size_t saved_actions_ = 0;
  std::chrono::steady_clock::time_point last_;
  bool failed_ = false;
};

/// The sessions in this folder whose viewers ended early. Each becomes "recovered_0001.toml" or the first
/// higher number that is not in use. Returns the new paths.
std::vector<std::filesystem::path> recover_sessions(const std::filesystem::path& folder);

}  // namespace brume::viewer
