// What all functions of the C interface have in common: handles are checked, exceptions become results, the
// last error of each thread is stored and logged.
#pragma once

#include <brume/brume.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/floating_point.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/tasks.hpp"

namespace brume::api {

/// Settings of a context; objects created from it hold them.
struct Settings : std::enable_shared_from_this<Settings>, LogSink, TaskRunner {
  unsigned thread_count = 0;
  std::atomic<brume_log_callback> log = nullptr;
  void* log_user = nullptr;
  std::atomic<brume_run_jobs_callback> run_jobs = nullptr;
  void* jobs_user = nullptr;

  /// Warnings of threads that calls have started.
  void write(LogLevel level, const std::string& line) override;
  std::shared_ptr<LogSink> of_threads() override { return shared_from_this(); }

  /// Runs jobs of calls, and of the threads that they have started.
  bool run(void (*job)(void*), void* data, unsigned count) override;
  std::shared_ptr<TaskRunner> share() override { return shared_from_this(); }
};

/// The warnings of a call, which are logged at its end: the callback may call functions.
class CallWarnings : public LogSink {
 public:
  explicit CallWarnings(std::shared_ptr<Settings> settings) : settings_(std::move(settings)), scope_(this) {}
  void write(LogLevel level, const std::string& line) override;
  std::shared_ptr<LogSink> of_threads() override { return settings_; }
  std::vector<std::string> take() { return std::exchange(lines_, {}); }

 private:
  std::shared_ptr<Settings> settings_;
  std::vector<std::string> lines_;
  LogScope scope_;
};

enum class Kind : std::uint32_t {
  context = 1,
  level,
  masks,
  world,
  state,
  sender,
  receiver,
  field,
  textures,
  device,
  renderer,
  volume,
  decal,
  tank
};

/// The start of what every handle points to.
struct Handle {
  static constexpr std::uint64_t kMagic = 0x656d757242a9c37bu;

  Handle(Kind handle_kind, std::shared_ptr<Settings> context_settings)
      : kind(handle_kind), settings(std::move(context_settings)) {}
  Handle(const Handle&) = delete;
  ~Handle() { magic = 0; }

  volatile std::uint64_t magic = kMagic;
  Kind kind;
  /// A call that changes the object ended by an exception.
  bool broken = false;
  std::shared_ptr<Settings> settings;
  mutable std::shared_mutex mutex;
};

/// A failure with its result, thrown within a call.
struct CallFailure {
  brume_result result;
  std::string message;
};

[[noreturn]] inline void fail(brume_result result, std::string message) {
  throw CallFailure{result, std::move(message)};
}
[[noreturn]] inline void refuse(std::string message) {
  fail(BRUME_ERROR_ARGUMENT, std::move(message));
}
inline void require(bool condition, const char* expected) {
  if (!condition) refuse(expected);
}
/// A pointer that must not be null.
template <typename T>
T& required(T* pointer, const char* name) {
  if (!pointer) refuse(std::string("`") + name + "` is null");
  return *pointer;
}

/// The result for a failure of the code below; for bad_input it depends on the function.
brume_result result_of(ErrorCode code, brume_result bad_input = BRUME_ERROR_ARGUMENT);

/// The value of a Result; throws its failure.
template <typename T>
T unwrap(Result<T> result, brume_result bad_input = BRUME_ERROR_ARGUMENT) {
  if (!result) fail(result_of(result.failure().code, bad_input), result.failure().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Sizes of a parameter struct in earlier versions of the headers, where it had fewer members.
template <typename Params>
inline constexpr std::array<std::uint32_t, 0> kEarlierSizes{};

/// Refuses a struct that neither this version of the header knows, nor an earlier one, nor a later one whose
/// further members are 0. `bytes` are as many as its struct_size says, at most kMostStructBytes are read.
void check_struct(const void* bytes, std::uint32_t struct_size, std::uint32_t known_size,
                  std::span<const std::uint32_t> earlier_sizes);
inline constexpr std::uint32_t kMostStructBytes = 4096;

/// The defaults of a parameter struct (defaults.cpp, here and in host).
template <typename Params>
Params defaults();

/// A parameter struct of any version, or the defaults for null. Members that its version lacks have their
/// defaults.
template <typename Params>
Params params_or_defaults(const Params* given) {
  Params params = defaults<Params>();
  if (!given) return params;
  check_struct(given, given->struct_size, sizeof(Params), kEarlierSizes<Params>);
  require(given->next == nullptr, "`next` must be null");
  std::memcpy(&params, given, std::min<std::size_t>(given->struct_size, sizeof(Params)));
  params.struct_size = sizeof(Params);
  return params;
}
/// The same where there must be one.
template <typename Params>
Params required_params(const Params* given, const char* name = "params") {
  return params_or_defaults(&required(given, name));
}

/// Copies bytes to the caller, or only their number.
void write_bytes(const void* bytes, std::size_t count, void* buffer, std::size_t capacity, std::size_t* size);

/// Copies a list to the caller, or only its length.
template <typename T>
void write_list(std::span<const T> list, T* out, std::size_t capacity, std::size_t* count) {
  required(count, "count");
  require(out || capacity == 0, "the list is null, but its capacity is not 0");
  *count = list.size();
  if (!out) return;
  if (capacity < list.size())
    fail(BRUME_ERROR_BUFFER, "the capacity is " + std::to_string(capacity) + ", " +
                                 std::to_string(list.size()) + " are required");
  std::copy(list.begin(), list.end(), out);
}

/// One call of the interface.
class Call {
 public:
  explicit Call(const char* function) : function_(function) { floating_point_.emplace(); }

  /// The object of a handle. Its context's number of threads holds for the rest of the call.
  template <typename T>
  T& handle(T* pointer) {
    check(pointer, std::remove_const_t<T>::kKind);
    adopt(pointer->settings);
    return *pointer;
  }
  /// Runs what only reads an object, or what changes it: if that ends by an exception other than a
  /// CallFailure, the object is broken.
  template <typename T, typename Read>
  void read(const T& object, Read body) {
    const std::shared_lock lock(object.mutex);
    check_whole(object);
    body();
  }
  template <typename T, typename Change>
  void change(T& object, Change body, bool repairs = false) {
    const std::unique_lock lock(object.mutex);
    if (!repairs) check_whole(object);
    try {
      body();
      object.broken = false;
    } catch (const CallFailure&) {
      throw;
    } catch (...) {
      object.broken = true;
      throw;
    }
  }

  /// Runs the function: body(*this).
  template <typename Body>
  brume_result run(Body body) noexcept {
    try {
      body(*this);
    } catch (...) {
      return failed();
    }
    log_warnings();
    return BRUME_OK;
  }

 private:
  static void check(const void* pointer, Kind kind);
  static void check_whole(const Handle& object);
  void adopt(const std::shared_ptr<Settings>& settings);
  brume_result failed() noexcept;
  brume_result report(brume_result result, const char* message) noexcept;
  void log_warnings() noexcept;

  const char* function_;
  std::optional<DefaultFloatingPoint> floating_point_;
  std::shared_ptr<Settings> settings_;
  std::optional<TaskScope> tasks_;
  std::optional<CallWarnings> warnings_;
};

/// Creates an object and gives it to the caller.
template <typename T, typename... Arguments>
void create(T** out, Arguments&&... arguments) {
  required(out, "the output");
  *out = new T(std::forward<Arguments>(arguments)...);
}

/// Destroys the object of a handle, if any.
template <typename T>
brume_result destroy(const char* function, T* pointer) noexcept {
  if (!pointer) return BRUME_OK;
  return Call(function).run([&](Call& call) { delete &call.handle(pointer); });
}

}  // namespace brume::api
