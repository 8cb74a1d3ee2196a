// Work over all cores. Results never depend on the number of threads: a task writes only what is its own.
#pragma once

#include <cstddef>
#include <functional>

namespace brume {

/// Threads that parallel_for uses, the caller's included. 0 = one a core (the default).
void set_thread_count(unsigned count);
unsigned thread_count();

/// Calls body(begin, end) for disjoint ranges that cover [0, count), at most `grain` long each, over all
/// threads, and returns when all are done. The first exception that a body throws is thrown again here.
/// Plain std::thread: the sanitizers see all of it, which they do not of a prebuilt scheduler.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace brume
