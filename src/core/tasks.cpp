#include "core/tasks.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace brume {
namespace {

std::atomic<unsigned> g_thread_count{0};
thread_local unsigned t_thread_count = 0;  // set by ThreadCountScope

}  // namespace

void set_thread_count(unsigned count) {
  g_thread_count = count;
}

ThreadCountScope::ThreadCountScope(unsigned count) : before_(t_thread_count) {
  if (count > 0) t_thread_count = count;
}

ThreadCountScope::~ThreadCountScope() {
  t_thread_count = before_;
}

unsigned thread_count() {
  if (t_thread_count > 0) return t_thread_count;
  const unsigned chosen = g_thread_count;
  return chosen > 0 ? chosen : std::max(1u, std::thread::hardware_concurrency());
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;

  // Each thread takes ranges until none remain.
  const auto work = [&] {
    try {
      for (;;) {
        const std::size_t begin = next.fetch_add(grain);
        if (begin >= count) return;
        body(begin, std::min(begin + grain, count));
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;  // The other threads stop at their next range.
    }
  };

  // Run it on the helpers and on this thread.
  const std::size_t ranges = (count + grain - 1) / grain;
  const std::size_t helpers = std::min<std::size_t>(thread_count(), ranges) - 1;
  {
    const auto help = [&, count_here = t_thread_count] {
      const ThreadCountScope scope(count_here);
      work();
    };
    std::vector<std::jthread> threads;
    threads.reserve(helpers);
    try {
      for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(help);
    } catch (const std::system_error&) {
      // No more threads: those that have started do the work.
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace brume
