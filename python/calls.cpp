#include "python/calls.hpp"

#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <vector>

#include "core/log.hpp"

namespace brume::python {
namespace {

struct Warnings {
  std::mutex mutex;
  std::vector<std::string> lines;
};

Warnings& warnings() {
  static auto* const instance = new Warnings;  // Never destroyed: threads may log until the process ends.
  return *instance;
}

/// Messages may name files whose names are not UTF-8.
py::object text_of(const std::string& message) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "backslashreplace"));
}

void set_error(PyObject* type, const std::string& message) {
  PyErr_SetObject(type, text_of(message).ptr());
}

PyObject* exception_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
    case ErrorCode::bad_input:
      return PyExc_ValueError;
    case ErrorCode::resource_limit:
      return PyExc_MemoryError;
    default:
      return PyExc_RuntimeError;
  }
}

PyObject* exception_of_file(int number) {
  switch (number) {
    case ENOENT:
      return PyExc_FileNotFoundError;
    case EISDIR:
      return PyExc_IsADirectoryError;
    case EACCES:
    case EPERM:
      return PyExc_PermissionError;
    default:
      return PyExc_OSError;
  }
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const FileError& error) {
    set_error(exception_of_file(error.number()), error.what());
  } catch (const Error& error) {
    set_error(exception_of(error.code()), error.what());
  }
}

int fault_of(const std::filesystem::path& path, FileUse use) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return EISDIR;
  if (use == FileUse::read) {
    if (!std::filesystem::exists(status)) return ENOENT;
    return ::access(path.c_str(), R_OK) == 0 ? 0 : errno;
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return ::access(folder.c_str(), W_OK) == 0 ? 0 : errno;
}

}  // namespace

void init_calls() {
  set_log_callback([](LogLevel level, const std::string& line) {
    if (level != LogLevel::warning) return;
    const std::lock_guard lock(warnings().mutex);
    warnings().lines.push_back(line);
  });
  py::register_exception_translator(translate);
}

void raise_warnings() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(warnings().mutex);
    lines.swap(warnings().lines);
  }
  for (const std::string& line : lines)
    if (PyErr_WarnEx(PyExc_UserWarning, py::str(text_of(line)).cast<std::string>().c_str(), 1) != 0)
      throw py::error_already_set();
}

void stop_if_interrupted() {
  const py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void throw_of_file(const Failure& failure, const std::filesystem::path& path, FileUse use) {
  if (const int number = fault_of(path, use)) throw FileError(number, failure.message);
  if (use == FileUse::write && failure.code == ErrorCode::resource_limit)
    throw FileError(ENOSPC, failure.message);
  if (use == FileUse::write && failure.message.starts_with(path.string() + ": cannot "))
    throw FileError(EIO, failure.message);
  throw Error(failure);
}

void refuse(const char* argument, const std::string& what) {
  throw Error(ErrorCode::usage, std::string(argument) + ": " + what);
}

}  // namespace brume::python
