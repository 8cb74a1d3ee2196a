#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cwchar>
#include <string_view>
#include <thread>

#include "core/platform/files.hpp"
#include "core/platform/process.hpp"
#include "core/platform/windows_error.hpp"

namespace brume::platform {
namespace {

namespace fs = std::filesystem;

/// Calls of the C runtime take an int.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::optional<FileInfo> info_of_handle(HANDLE file) {
  if (::GetFileType(file) != FILE_TYPE_DISK) return FileInfo{};
  BY_HANDLE_FILE_INFORMATION info;
  if (!::GetFileInformationByHandle(file, &info)) {
    set_errno();
    return std::nullopt;
  }
  const bool is_folder = (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
  const auto joined = [](DWORD high, DWORD low) { return std::uint64_t{high} << 32 | low; };
  return FileInfo{!is_folder, is_folder, joined(info.nFileSizeHigh, info.nFileSizeLow),
                  info.dwVolumeSerialNumber, joined(info.nFileIndexHigh, info.nFileIndexLow)};
}

// A folder, too. Others may meanwhile write, replace or remove it.
HANDLE open_shared(const fs::path& path, DWORD access) {
  const HANDLE file =
      ::CreateFileW(path.c_str(), access, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                    OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (file == INVALID_HANDLE_VALUE) set_errno();
  return file;
}

}  // namespace

std::optional<FileInfo> info_of(const fs::path& path) {
  const HANDLE file = open_shared(path, FILE_READ_ATTRIBUTES);
  if (file == INVALID_HANDLE_VALUE) return std::nullopt;
  const auto info = info_of_handle(file);
  ::CloseHandle(file);
  return info;
}

std::optional<FileInfo> info_of(int descriptor) {
  return info_of_handle(reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor)));
}

// Such names reach devices, streams of other files, or nothing, and calls say so late or never.
std::string why_not_a_name(const fs::path& path) {
  const std::wstring name = path.filename().native();
  for (const wchar_t c : name)
    if (c < L' ' || std::wcschr(L"<>:\"|?*", c))
      return c < L' ' ? "has a control character in its name"
                      : std::string("has a '") + static_cast<char>(c) + "' in its name";
  std::wstring stem = name.substr(0, name.find(L'.'));
  stem.resize(stem.find_last_not_of(L' ') + 1);
  for (wchar_t& c : stem)
    if (c >= L'a' && c <= L'z') c = static_cast<wchar_t>(c - L'a' + L'A');
  static constexpr std::array<std::wstring_view, 6> kDevices{L"CON", L"PRN",    L"AUX",
                                                             L"NUL", L"CONIN$", L"CONOUT$"};
  const bool numbered = stem.size() == 4 && (stem.starts_with(L"COM") || stem.starts_with(L"LPT")) &&
                        stem[3] >= L'1' && stem[3] <= L'9';
  if (numbered || std::ranges::find(kDevices, stem) != kDevices.end()) return "has the name of a device";
  return "";
}

bool may_write(const fs::path& path) {
  const HANDLE file = open_shared(path, GENERIC_WRITE);
  if (file == INVALID_HANDLE_VALUE) return false;
  ::CloseHandle(file);
  return true;
}

int open_to_read(const fs::path& path) {
  const HANDLE file = open_shared(path, GENERIC_READ);
  if (file == INVALID_HANDLE_VALUE) return -1;
  const int descriptor =
      ::_open_osfhandle(reinterpret_cast<std::intptr_t>(file), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
  if (descriptor < 0) ::CloseHandle(file);
  return descriptor;
}

std::ptrdiff_t read_some(int descriptor, std::span<std::byte> bytes) {
  const int got =
      ::_read(descriptor, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), kMostBytes)));
  return got < 0 && errno == EPIPE ? 0 : got;  // The writer's end is closed.
}

std::ptrdiff_t write_some(int descriptor, std::span<const std::byte> bytes) {
  return ::_write(descriptor, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), kMostBytes)));
}

bool sync(int descriptor) {
  return ::_commit(descriptor) == 0;
}

void close(int descriptor) {
  ::_close(descriptor);
}

std::span<const int> full_errors() {
  static constexpr std::array kFull{ENOSPC, EFBIG};
  return kFull;
}

bool is_full(int error) {
  return std::ranges::find(full_errors(), error) != full_errors().end();
}

int open_nameless(const fs::path&) {
  errno = ENOSYS;
  return -1;
}

// Others may read and write it, but not remove it: that is its lock.
int create_part(const fs::path& part, const fs::path&) {
  return ::_wopen(part.c_str(), _O_RDWR | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT,
                  _S_IREAD | _S_IWRITE);
}

// Its writer closes it before it gives it its name. That is why its number counts, which ends the name:
// ".NAME.brume-part-PID-N".
void remove_if_stale(const fs::path& part) {
  const std::wstring name = part.filename().native();
  const std::size_t number = name.rfind(L'-');
  const std::size_t process = name.rfind(L'-', number - 1);
  if (number == name.npos || process == name.npos) return;
  if (!is_running(static_cast<int>(std::wcstol(&name[process + 1], nullptr, 10))))
    ::DeleteFileW(part.c_str());
}

void remove(const fs::path& part) {
  ::DeleteFileW(part.c_str());
}

void copy_permissions(int, const fs::path&) {}

int link_nameless(int, const fs::path&) {
  return ENOSYS;
}

int replace(int descriptor, const fs::path& part, const fs::path& target) {
  ::_close(descriptor);
  // Virus scanners and indexers open a file for a moment when it appears or changes.
  constexpr int kTries = 40;
  constexpr std::chrono::milliseconds kBetween(50);
  int error = 0;
  for (int i = 0; i < kTries; ++i) {
    if (::MoveFileExW(part.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
      return 0;
    const DWORD reason = ::GetLastError();
    error = to_errno(reason);
    if (reason != ERROR_ACCESS_DENIED && reason != ERROR_SHARING_VIOLATION) break;
    std::this_thread::sleep_for(kBetween);
  }
  ::DeleteFileW(part.c_str());
  return error;
}

std::string path_for_child(int, const fs::path& part) {
  return part.string();
}

}  // namespace brume::platform
