#include "core/tasks.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace brume {
namespace {

std::atomic<unsigned> g_thread_count{0};
// Set by TaskScope.
thread_local unsigned t_thread_count = 0;
thread_local TaskRunner* t_runner = nullptr;

}  // namespace

void set_thread_count(unsigned count) {
  g_thread_count = count;
}

TaskScope::TaskScope(unsigned thread_count, TaskRunner* runner)
    : count_before_(t_thread_count), runner_before_(std::exchange(t_runner, runner)) {
  if (thread_count > 0) t_thread_count = thread_count;
}

TaskScope::~TaskScope() {
  t_thread_count = count_before_;
  t_runner = runner_before_;
}

unsigned thread_count() {
  if (t_thread_count > 0) return t_thread_count;
  const unsigned chosen = g_thread_count;
  return chosen > 0 ? chosen : std::max(1u, std::thread::hardware_concurrency());
}

TaskSettings task_settings() {
  return {t_thread_count, t_runner ? t_runner->share() : nullptr};
}

namespace {

/// Calls `work` in up to `count` threads that end before it returns.
void run_in_threads(std::size_t count, const std::function<void()>& work) {
  const auto help = [&, count_here = t_thread_count] {
    const TaskScope scope(count_here, nullptr);
    work();
  };
  std::vector<std::jthread> threads;
  threads.reserve(count);
  try {
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(help);
  } catch (const std::system_error&) {
    // No more threads: those that have started do the work.
  }
  work();
}

/// The same in the threads of this thread's runner; false: there is none.
bool run_in_runner(std::size_t count, const std::function<void()>& work) {
  if (!t_runner || count == 0) return false;
  const auto job = [](void* data) {
    const TaskScope alone(1, nullptr);
    (*static_cast<const std::function<void()>*>(data))();
  };
  if (!t_runner->run(job, const_cast<std::function<void()>*>(&work), static_cast<unsigned>(count) + 1))
    return false;
  work();  // What it left.
  return true;
}

}  // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;

  // Each thread takes ranges until none remain.
  const std::function<void()> work = [&] {
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

  // Run it in other threads and in this one.
  const std::size_t ranges = (count + grain - 1) / grain;
  const std::size_t helpers = std::min<std::size_t>(thread_count(), ranges) - 1;
  if (!run_in_runner(helpers, work)) run_in_threads(helpers, work);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace brume
