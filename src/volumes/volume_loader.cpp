#include "volumes/volume_loader.hpp"

#include <algorithm>
#include <new>

#include "core/progress.hpp"
#include "core/tasks.hpp"

namespace brume::volumes {
namespace {

Result<LoadedVolume> guarded(const VolumeLoader::Load& load, const VolumeLoader::Key& key,
                             const std::atomic<bool>& stopped) {
  const Progress job("volume");
  try {
    return load(key, stopped);
  } catch (const Error& error) {
    return Failure{error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return Failure{ErrorCode::resource_limit, "a frame of a volume is larger than the memory that is free"};
  } catch (const std::exception& error) {
    return Failure{ErrorCode::internal, error.what()};
  }
}

}  // namespace

VolumeLoader::~VolumeLoader() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  ends_.notify_all();
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

VolumeLoader::Results VolumeLoader::want(std::vector<Key> keys) {
  Results others;
  {
    const std::lock_guard lock(mutex_);
    wanted_ = std::move(keys);
    for (auto done = done_.begin(); done != done_.end();) {
      const auto next = std::next(done);
      if (std::ranges::find(wanted_, done->first) == wanted_.end()) others.insert(done_.extract(done));
      done = next;
    }
    if (wanted_.empty()) return others;
  }
  changed_.notify_all();
  if (!thread_.joinable())
    thread_ = std::thread([this, log = log_of_threads(), tasks = task_settings()] { run(log, tasks); });
  return others;
}

std::optional<Result<LoadedVolume>> VolumeLoader::take(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = done_.find(key);
  if (found == done_.end()) return std::nullopt;
  Result<LoadedVolume> result = std::move(found->second);
  done_.erase(found);
  std::erase(wanted_, key);
  return result;
}

Result<LoadedVolume> VolumeLoader::wait(const Key& key) {
  {
    std::unique_lock lock(mutex_);
    BRUME_ASSERT(std::ranges::find(wanted_, key) != wanted_.end(), std::to_string(key.number));
    changed_.wait(lock, [&] { return done_.contains(key); });
  }
  return std::move(*take(key));
}

/// The first key that is neither loaded nor being loaded.
std::optional<VolumeLoader::Key> VolumeLoader::next() const {
  for (const Key& key : wanted_)
    if (!done_.contains(key) && loading_ != key) return key;
  return std::nullopt;
}

void VolumeLoader::run(std::shared_ptr<LogSink> log, const TaskSettings& tasks) {
  const LogScope logged(log.get());
  const TaskScope task_scope(tasks);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ends_ || next(); });
    if (ends_) return;
    const Key key = *next();
    loading_ = key;
    lock.unlock();
    Result<LoadedVolume> result = guarded(load_, key, ends_);
    lock.lock();
    loading_.reset();
    done_.insert_or_assign(key, std::move(result));
    changed_.notify_all();
  }
}

}  // namespace brume::volumes
