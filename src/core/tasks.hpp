// Parallel loops over all cores. Results never depend on the number of threads: tasks write disjoint data.
#pragma once

#include <cstddef>
#include <functional>

namespace brume {

/// Number of threads that parallel_for uses, the caller's included. 0: one per core (the default).
void set_thread_count(unsigned count);
/// The same for the calling thread, where it has a ThreadCountScope.
unsigned thread_count();

/// While it lives, thread_count() of this thread, and of the threads that its parallel_for starts, is
/// `count`; 0: as without it.
class ThreadCountScope {
 public:
  explicit ThreadCountScope(unsigned count);
  ThreadCountScope(const ThreadCountScope&) = delete;
  ~ThreadCountScope();

 private:
  unsigned before_;
};

/// Calls body(begin, end) for disjoint ranges that cover [0, count), at most `grain` long each, over all
/// threads, and returns when all are done. Rethrows the first exception that a body throws. Uses plain
/// std::thread because sanitizers cannot see into a prebuilt scheduler.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace brume
