// Error handling: `Result<T>` for expected failures (a file, an argument), `Error` thrown by constructors for
// a broken environment, BRUME_ASSERT for programming errors.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <variant>

namespace brume {

/// The kind of a failure. Its value is the exit code of the command line.
enum class ErrorCode : int {
  internal = 1,
  usage = 2,
  bad_input = 3,
  resource_limit = 4,
  no_device = 5,  ///< Also: a program that is not installed.
  partial = 6,
  comparison_failed = 7,
};

/// A failure with a message: one line that names the place, the expectation and the fix.
struct Failure {
  ErrorCode code = ErrorCode::internal;
  std::string message;
};

/// A broken environment: no device, device lost, out of memory. Thrown by constructors and by submit and
/// wait; never between the begin and the end of a recording, never across the C API.
class Error : public std::exception {
 public:
  explicit Error(Failure failure) : failure_(std::move(failure)) {}
  Error(ErrorCode code, std::string message) : failure_{code, std::move(message)} {}
  const char* what() const noexcept override { return failure_.message.c_str(); }
  ErrorCode code() const noexcept { return failure_.code; }
  const Failure& failure() const noexcept { return failure_; }

 private:
  Failure failure_;
};

[[noreturn]] void assertion_failed(const char* expression, const char* file, int line,
                                   const std::string& values);

/// A value, or the failure that explains its absence.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit by design
  Result(Failure failure) : state_(std::in_place_index<1>, std::move(failure)) {}  // NOLINT
  explicit operator bool() const { return state_.index() == 0; }
  T& operator*() & { return value(); }
  const T& operator*() const& { return const_cast<Result*>(this)->value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &const_cast<Result*>(this)->value(); }
  /// The failure. Must only be called when there is no value.
  const Failure& failure() const {
    if (state_.index() != 1)
      assertion_failed("failure() of a Result with a value", __FILE_NAME__, __LINE__, "");
    return *std::get_if<1>(&state_);
  }
  /// The value; throws the failure as `Error` if there is none.
  T value_or_throw() && {
    if (state_.index() == 1) throw Error(failure());
    return std::move(value());
  }

 private:
  T& value() {
    if (state_.index() != 0)
      assertion_failed("value of a failed Result", __FILE_NAME__, __LINE__, failure().message);
    return *std::get_if<0>(&state_);
  }
  std::variant<T, Failure> state_;
};

/// Success, or a failure.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Failure failure) : failure_(std::move(failure)), ok_(false) {}  // NOLINT: implicit by design
  explicit operator bool() const { return ok_; }
  const Failure& failure() const { return failure_; }
  void value_or_throw() const {
    if (!ok_) throw Error(failure_);
  }

 private:
  Failure failure_;
  bool ok_ = true;
};

}  // namespace brume

/// Aborts the program, printing the expression and the values (a std::string), when an invariant does not
/// hold. Checked in every build.
#define BRUME_ASSERT(condition, values)                                                       \
  do {                                                                                        \
    if (!(condition)) ::brume::assertion_failed(#condition, __FILE_NAME__, __LINE__, values); \
  } while (false)
