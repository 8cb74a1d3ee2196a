// What all calls into the library have in common: the interpreter lock, Ctrl-C, warnings and errors.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>

#include "core/error.hpp"

namespace brume::python {

namespace py = pybind11;

/// Installs the translation of errors to Python exceptions, and the collection of warnings.
void init_calls();

/// Raises the library's warnings so far as Python's UserWarning. With the interpreter lock.
void raise_warnings();

/// Runs the handlers of pending signals; throws what they raise, such as KeyboardInterrupt. With or without
/// the interpreter lock, but never with a lock of this module.
void stop_if_interrupted();

/// Calls `work` without the interpreter lock, then raises its warnings. Locks of this module are only taken
/// without the interpreter lock: two threads could wait for each other otherwise.
template <typename Work>
auto released(const Work& work) {
  if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
    {
      const py::gil_scoped_release release;
      work();
    }
    raise_warnings();
  } else {
    auto result = [&] {
      const py::gil_scoped_release release;
      return work();
    }();
    raise_warnings();
    return result;
  }
}

/// A failure of the file system, raised as an OSError.
class FileError : public std::exception {
 public:
  FileError(int number, std::string message) : number_(number), message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }
  int number() const { return number_; }  ///< errno

 private:
  int number_;
  std::string message_;
};

enum class FileUse { read, write };

/// Throws the failure of a function that read or wrote a file: FileError where the file itself is at fault,
/// else Error.
[[noreturn]] void throw_of_file(const Failure& failure, const std::filesystem::path& path, FileUse use);

/// The value of a result, or throw_of_file.
template <typename T>
T of_file(Result<T> result, const std::filesystem::path& path, FileUse use = FileUse::read) {
  if (!result) throw_of_file(result.failure(), path, use);
  if constexpr (!std::is_void_v<T>) return std::move(*std::move(result));
}

/// A failure of an argument: ValueError.
[[noreturn]] void refuse(const char* argument, const std::string& what);

}  // namespace brume::python
