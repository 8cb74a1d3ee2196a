// Parallel loops over all cores. Results never depend on the number of threads: tasks write disjoint data.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace brume {

/// Number of threads that parallel_for uses, the caller's included. 0: one per core (the default).
void set_thread_count(unsigned count);
/// The same for the calling thread, where it has a TaskScope.
unsigned thread_count();

/// Threads of the program's own, for the loops of a TaskScope.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  /// Calls job(data) `count` times or fewer, in any threads, and returns when all calls have returned. False:
  /// it called none.
  virtual bool run(void (*job)(void*), void* data, unsigned count) = 0;
  /// Keeps it for threads that outlive a scope.
  virtual std::shared_ptr<TaskRunner> share() = 0;
};

/// How loops run.
struct TaskSettings {
  unsigned thread_count = 0;           ///< As thread_count(); 0: as without the scope.
  std::shared_ptr<TaskRunner> runner;  ///< Null: parallel_for starts threads, which end with it.
};

/// While it lives, loops of this thread, and of the threads that its parallel_for starts, have the settings.
/// Within jobs of a runner, loops run in the thread of the job alone, so that no job waits for others.
class TaskScope {
 public:
  explicit TaskScope(const TaskSettings& settings)
      : TaskScope(settings.thread_count, settings.runner.get()) {}
  /// `runner`, which may be null, must outlive the scope.
  TaskScope(unsigned thread_count, TaskRunner* runner);
  TaskScope(const TaskScope&) = delete;
  ~TaskScope();

 private:
  unsigned count_before_;
  TaskRunner* runner_before_;
};

/// For the scope of a thread that this one starts.
TaskSettings task_settings();

/// Calls body(begin, end) for disjoint ranges that cover [0, count), at most `grain` long each, over all
/// threads, and returns when all are done. Rethrows the first exception that a body throws. Starts plain
/// std::thread because sanitizers cannot see into a prebuilt scheduler.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace brume
