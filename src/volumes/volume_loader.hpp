// Loads frames of volumes in a thread of its own, so that what shows them does not wait.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/log.hpp"
#include "core/tasks.hpp"
#include "volumes/volume_frame.hpp"

namespace brume::volumes {

/// A frame of a volume with its previews, if any were made.
struct LoadedVolume {
  std::shared_ptr<const VolumeFrame> frame;
  std::shared_ptr<const VolumePreview> preview;
};

/// The members may be called by one thread at a time.
class VolumeLoader {
 public:
  /// A frame of one of several volumes.
  struct Key {
    std::size_t volume = 0;
    std::int64_t number = 0;
    auto operator<=>(const Key&) const = default;
  };
  /// `stopped` becomes true when the result is no longer wanted: the load may then fail.
  using Load = std::function<Result<LoadedVolume>(const Key&, const std::atomic<bool>& stopped)>;

  /// `load` runs in the thread, for one key after another. What it throws becomes a failure. The thread logs
  /// and starts threads as the one that first calls `want`.
  explicit VolumeLoader(Load load) : load_(std::move(load)) {}
  /// Stops the frame that is being loaded, and waits for it; none is begun after it.
  ~VolumeLoader();
  VolumeLoader(const VolumeLoader&) = delete;
  VolumeLoader& operator=(const VolumeLoader&) = delete;

  using Results = std::map<Key, Result<LoadedVolume>>;
  /// Loads these keys in order; keys that earlier calls wanted and that have not begun are dropped. Returns
  /// what was loaded for other keys: a frame that took longer than it was wanted is still newer than the
  /// frame that is shown.
  Results want(std::vector<Key> keys);
  /// The result of a key, once: it is loaded again if it is wanted again. Empty until it is there.
  std::optional<Result<LoadedVolume>> take(const Key& key);
  /// As take, but waits for the result. The last `want` must hold the key.
  Result<LoadedVolume> wait(const Key& key);

 private:
  void run(std::shared_ptr<LogSink> log, const TaskSettings& tasks);
  std::optional<Key> next() const;

  Load load_;
  std::mutex mutex_;  ///< Guards all below but the thread.
  std::condition_variable changed_;
  std::vector<Key> wanted_;
  std::optional<Key> loading_;
  Results done_;
  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< From the first wanted key on.
};

}  // namespace brume::volumes
