#include "volumes/volume_loader.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <new>
#include <semaphore>
#include <vector>

#include "core/error.hpp"

namespace brume::volumes {
namespace {

using Key = VolumeLoader::Key;

LoadedVolume volume_of(const Key& key) {
  auto frame = std::make_shared<VolumeFrame>();
  frame->mean_density = static_cast<double>(key.number);
  return {std::move(frame), nullptr};
}

/// Loads nothing until it is let, and notes what it loads.
class Gate {
 public:
  VolumeLoader::Load load() {
    return [this](const Key& key, const std::atomic<bool>&) -> Result<LoadedVolume> {
      begun_.release();
      may_load_.acquire();
      const std::lock_guard lock(mutex_);
      loaded_.push_back(key);
      return volume_of(key);
    };
  }
  void wait_until_begun() { begun_.acquire(); }
  void let(int count) { may_load_.release(count); }
  std::vector<Key> loaded() {
    const std::lock_guard lock(mutex_);
    return loaded_;
  }

 private:
  std::counting_semaphore<1000> begun_{0}, may_load_{0};
  std::mutex mutex_;
  std::vector<Key> loaded_;
};

TEST(VolumeLoader, LoadsWhatIsWantedInOrder) {
  Gate gate;
  VolumeLoader loader(gate.load());
  EXPECT_TRUE(loader.want({{0, 5}, {1, 7}, {0, 6}}).empty());
  EXPECT_FALSE(loader.take({0, 5}));
  gate.let(3);
  EXPECT_EQ(loader.wait({0, 6})->frame->mean_density, 6) << "after the two before it";
  EXPECT_EQ(gate.loaded(), (std::vector<Key>{{0, 5}, {1, 7}, {0, 6}}));
  EXPECT_EQ((*loader.take({0, 5}))->frame->mean_density, 5);
  EXPECT_FALSE(loader.take({0, 5})) << "once";
}

// Time jumps while a frame is being read: what was not begun is never read, what was is returned.
TEST(VolumeLoader, AnotherTimeReplacesWhatHasNotBegun) {
  Gate gate;
  VolumeLoader loader(gate.load());
  loader.want({{0, 1}, {0, 2}, {0, 3}});
  gate.wait_until_begun();
  EXPECT_TRUE(loader.want({{0, 8}, {0, 9}}).empty());
  gate.let(3);
  loader.wait({0, 8}).value_or_throw();
  loader.wait({0, 9}).value_or_throw();
  EXPECT_EQ(gate.loaded(), (std::vector<Key>{{0, 1}, {0, 8}, {0, 9}}));
  const VolumeLoader::Results late = loader.want({{0, 10}});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late.begin()->first, (Key{0, 1}));
  gate.let(1);
}

TEST(VolumeLoader, WhatTheLoaderThrowsIsAFailure) {
  VolumeLoader loader([](const Key& key, const std::atomic<bool>&) -> Result<LoadedVolume> {
    if (key.number == 1) throw Error(ErrorCode::bad_input, "no such grid");
    if (key.number == 2) throw std::bad_alloc();
    return volume_of(key);
  });
  loader.want({{0, 1}, {0, 2}, {0, 3}});
  EXPECT_EQ(loader.wait({0, 1}).failure().message, "no such grid");
  EXPECT_EQ(loader.wait({0, 2}).failure().code, ErrorCode::resource_limit);
  EXPECT_TRUE(loader.wait({0, 3}));
}

// The load lasts until it is told to stop, so the end always comes during it.
TEST(VolumeLoader, StopsTheLoadThatItEndsInAndBeginsNoOther) {
  Gate gate;
  std::counting_semaphore<3> begun{0};
  std::atomic<int> loads{0};
  {
    VolumeLoader loader([&](const Key&, const std::atomic<bool>& stopped) -> Result<LoadedVolume> {
      ++loads;
      begun.release();
      stopped.wait(false);
      return Failure{ErrorCode::internal, "stopped"};
    });
    loader.want({{0, 1}, {0, 2}, {0, 3}});
    begun.acquire();
  }
  EXPECT_EQ(loads, 1);
  { const VolumeLoader idle(gate.load()); }
  VolumeLoader(gate.load()).want({});
}

// As a viewer does: every frame wants a time and the one after it, and takes what is there.
TEST(VolumeLoader, AMovingTimeShowsEveryFrameOrALaterOne) {
  VolumeLoader loader(
      [](const Key& key, const std::atomic<bool>&) -> Result<LoadedVolume> { return volume_of(key); });
  std::int64_t shown = 0;
  for (std::int64_t now = 1; shown < 100; ++now) {
    const std::int64_t before = shown;
    for (auto& [key, late] : loader.want({{0, now}, {0, now + 1}})) {
      EXPECT_EQ(late->frame->mean_density, static_cast<double>(key.number));
      shown = std::max(shown, key.number);
    }
    if (const auto loaded = loader.take({0, now})) shown = now;
    EXPECT_GE(shown, before);
    EXPECT_LE(shown, now);
  }
}

}  // namespace
}  // namespace brume::volumes
