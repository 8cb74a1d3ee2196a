#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

#include "core/error.hpp"
#include "core/platform/child_process.hpp"
#include "core/platform/utf16.hpp"
#include "core/platform/windows_error.hpp"

namespace brume::platform {
namespace {

constexpr unsigned kPipeBytes = 1 << 16;
constexpr UINT kKilled = 0xb2e;  ///< Exit code of a child that kill() ended.
/// Exit codes from here on are exceptions, such as 0xc0000005: access violation.
constexpr DWORD kLeastException = 0xc0000000;

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

// The rules by which programs split their command lines: backslashes are doubled before a quote only.
std::wstring quoted(const std::wstring& word) {
  if (!word.empty() && word.find_first_of(L" \t\"") == std::wstring::npos) return word;
  std::wstring text = L"\"";
  std::size_t backslashes = 0;
  for (const wchar_t c : word) {
    if (c == L'"') text.append(backslashes + 1, L'\\');
    backslashes = c == L'\\' ? backslashes + 1 : 0;
    text += c;
  }
  return text.append(backslashes, L'\\') + L'"';
}

// The file of a program; the folder that the process happens to be in is not searched.
std::wstring find_program(const std::string& name) {
  const std::wstring wide = to_utf16(name);
  if (wide.find_first_of(L"/\\") != std::wstring::npos) return wide;
  std::wstring folders(32768, 0), found(32768, 0);
  folders.resize(::GetEnvironmentVariableW(L"PATH", folders.data(), static_cast<DWORD>(folders.size())));
  found.resize(::SearchPathW(folders.c_str(), wide.c_str(), L".exe", static_cast<DWORD>(found.size()),
                             found.data(), nullptr));
  return found;
}

// Ends its processes when this process ends. Never closed before.
HANDLE job() {
  static const HANDLE made = [] {
    const HANDLE created = ::CreateJobObjectW(nullptr, nullptr);
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
    if (created)
      ::SetInformationJobObject(created, JobObjectExtendedLimitInformation, &limits, sizeof limits);
    return created;
  }();
  return made;
}

// A file that disappears with its last handle.
int open_temporary() {
  std::array<wchar_t, MAX_PATH + 1> folder{}, file{};
  if (::GetTempPathW(static_cast<DWORD>(folder.size()), folder.data()) == 0 ||
      ::GetTempFileNameW(folder.data(), L"brm", 0, file.data()) == 0)
    return -1;
  return ::_wopen(file.data(), _O_RDWR | _O_BINARY | _O_NOINHERIT | _O_TEMPORARY);
}

// A copy of a descriptor's handle, or of NUL, that a child inherits.
HANDLE inheritable(int descriptor, DWORD access) {
  HANDLE copy = nullptr;
  if (descriptor >= 0) {
    const HANDLE self = ::GetCurrentProcess();
    return ::DuplicateHandle(self, handle_of(descriptor), self, &copy, 0, TRUE, DUPLICATE_SAME_ACCESS)
               ? copy
               : nullptr;
  }
  SECURITY_ATTRIBUTES inherits{sizeof inherits, nullptr, TRUE};
  copy =
      ::CreateFileW(L"NUL", access, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherits, OPEN_EXISTING, 0, nullptr);
  return copy == INVALID_HANDLE_VALUE ? nullptr : copy;
}

std::optional<ChildStream> make_pipe(bool we_write) {
  std::array<int, 2> ends{};
  if (::_pipe(ends.data(), kPipeBytes, _O_BINARY | _O_NOINHERIT) != 0) return std::nullopt;
  Descriptor reads(ends[0]), writes(ends[1]);
  if (we_write) return ChildStream{std::move(writes), std::move(reads)};
  return ChildStream{std::move(reads), std::move(writes)};
}

}  // namespace

std::optional<ChildStream> make_child_input() {
  return make_pipe(true);
}

std::optional<ChildStream> make_child_output() {
  return make_pipe(false);
}

std::ptrdiff_t send_some(int descriptor, std::span<const std::byte> bytes) {
  return write_some(descriptor, bytes);
}

// Anonymous pipes cannot be waited for.
bool wait_readable(int descriptor, int milliseconds) {
  constexpr DWORD kLongest = 10;
  const ULONGLONG end = ::GetTickCount64() + static_cast<ULONGLONG>(milliseconds);
  for (DWORD pause = 1;; pause = std::min(2 * pause, kLongest)) {
    DWORD bytes = 0;
    if (!::PeekNamedPipe(handle_of(descriptor), nullptr, 0, nullptr, &bytes, nullptr) || bytes > 0)
      return true;
    if (::GetTickCount64() >= end) return false;
    ::Sleep(pause);
  }
}

ChildProcess::~ChildProcess() {
  if (!running()) return;
  kill();
  wait();
}

int ChildProcess::start(const std::vector<std::string>& arguments, const Streams& streams) {
  BRUME_ASSERT(!running() && !arguments.empty(), "");
  const std::wstring program = find_program(arguments[0]);
  if (program.empty()) return ENOENT;
  std::wstring line;
  for (const std::string& argument : arguments)
    line += (line.empty() ? L"" : L" ") + quoted(to_utf16(argument));
  messages_ = Descriptor(open_temporary());

  // It inherits these handles alone.
  std::array<HANDLE, 3> handles{inheritable(streams.input, GENERIC_READ),
                                inheritable(streams.output, GENERIC_WRITE),
                                inheritable(messages_.get(), GENERIC_WRITE)};
  SIZE_T size = 0;
  ::InitializeProcThreadAttributeList(nullptr, 1, 0, &size);
  std::vector<std::byte> list(size);
  STARTUPINFOEXW startup{};
  startup.StartupInfo.cb = sizeof startup;
  startup.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
  startup.StartupInfo.hStdInput = handles[0];
  startup.StartupInfo.hStdOutput = handles[1];
  startup.StartupInfo.hStdError = handles[2];
  startup.lpAttributeList = reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(list.data());
  bool ready = std::ranges::find(handles, nullptr) == handles.end() &&
               ::InitializeProcThreadAttributeList(startup.lpAttributeList, 1, 0, &size);
  ready = ready && ::UpdateProcThreadAttribute(startup.lpAttributeList, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST,
                                               handles.data(), sizeof handles, nullptr, nullptr);

  // It begins to run once it belongs to the job. Ctrl-C reaches only us, and we stop it.
  PROCESS_INFORMATION child{};
  constexpr DWORD kFlags =
      CREATE_SUSPENDED | CREATE_NO_WINDOW | CREATE_NEW_PROCESS_GROUP | EXTENDED_STARTUPINFO_PRESENT;
  const bool started = ready && ::CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE, kFlags,
                                                 nullptr, nullptr, &startup.StartupInfo, &child);
  const int error = started ? 0 : to_errno(::GetLastError());
  for (const HANDLE handle : handles)
    if (handle) ::CloseHandle(handle);
  if (!started) return error;
  ::AssignProcessToJobObject(job(), child.hProcess);
  ::ResumeThread(child.hThread);
  ::CloseHandle(child.hThread);
  process_ = reinterpret_cast<std::intptr_t>(child.hProcess);
  return 0;
}

void ChildProcess::kill() {
  if (running()) ::TerminateProcess(reinterpret_cast<HANDLE>(static_cast<std::intptr_t>(process_)), kKilled);
}

ChildEnd ChildProcess::wait() {
  BRUME_ASSERT(running(), "");
  const auto process = reinterpret_cast<HANDLE>(static_cast<std::intptr_t>(std::exchange(process_, -1)));
  ::WaitForSingleObject(process, INFINITE);
  DWORD code = 0;
  ::GetExitCodeProcess(process, &code);
  ::CloseHandle(process);
  return {code == kKilled           ? ChildEnd::Cause::killed
          : code >= kLeastException ? ChildEnd::Cause::crashed
                                    : ChildEnd::Cause::exited,
          static_cast<int>(code)};
}

std::string ChildProcess::messages() const {
  std::string text(4096, '\0');
  const std::int64_t length = ::_lseeki64(messages_.get(), 0, SEEK_END);
  ::_lseeki64(messages_.get(), std::max<std::int64_t>(0, length - static_cast<std::int64_t>(text.size())),
              SEEK_SET);
  const int got = ::_read(messages_.get(), text.data(), static_cast<unsigned>(text.size()));
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

}  // namespace brume::platform
