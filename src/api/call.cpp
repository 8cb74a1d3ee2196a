#include "api/call.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>

namespace brume::api {
namespace {

constexpr std::size_t kMaxLine = 512;
// Plain bytes: no destructor, no allocation.
thread_local char t_last_error[kMaxLine] = "";

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::context:
      return "context";
    case Kind::level:
      return "level";
    case Kind::masks:
      return "set of masks";
    case Kind::world:
      return "world";
    case Kind::state:
      return "state";
    case Kind::sender:
      return "sender";
    case Kind::receiver:
      return "receiver";
    case Kind::field:
      return "field";
    case Kind::textures:
      return "set of textures";
    case Kind::device:
      return "device";
    case Kind::renderer:
      return "renderer";
    case Kind::volume:
      return "volume";
    case Kind::decal:
      return "decal";
    case Kind::tank:
      return "tank";
  }
  return "unknown object";  // a damaged handle
}

/// Appends text, in one line, as far as it fits; cuts no character of UTF-8 apart.
void append(std::size_t& length, const char* text) noexcept {
  while (*text != '\0' && length + 1 < kMaxLine) {
    t_last_error[length++] = *text == '\n' || *text == '\r' ? ' ' : *text;
    ++text;
  }
  if (*text != '\0')
    while (length > 0 && (static_cast<unsigned char>(t_last_error[length - 1]) & 0x80) != 0) --length;
  t_last_error[length] = '\0';
}

}  // namespace

brume_result result_of(ErrorCode code, brume_result bad_input) {
  switch (code) {
    case ErrorCode::bad_input:
      return bad_input;
    case ErrorCode::usage:
      return BRUME_ERROR_ARGUMENT;
    case ErrorCode::resource_limit:
      return BRUME_ERROR_LIMIT;
    case ErrorCode::no_device:
      return BRUME_ERROR_DEVICE;
    default:
      return BRUME_ERROR_INTERNAL;
  }
}

void Settings::write(LogLevel level, const std::string& line) {
  const brume_log_callback callback = log.load();
  if (level == LogLevel::warning && callback) callback(log_user, BRUME_OK, line.c_str());
}

bool Settings::run(void (*job)(void*), void* data, unsigned count) {
  const brume_run_jobs_callback callback = run_jobs.load();
  if (!callback) return false;
  struct Job {
    void (*call)(void*);
    void* data;
  } wrapped{job, data};
  // The host's threads may have another floating-point environment.
  const auto run_job = [](void* each) {
    const DefaultFloatingPoint floating_point;
    const Job& own = *static_cast<const Job*>(each);
    own.call(own.data);
  };
  callback(jobs_user, run_job, &wrapped, count);
  return true;
}

void CallWarnings::write(LogLevel level, const std::string& line) {
  if (level == LogLevel::warning) lines_.push_back(line);
}

void check_struct(const void* bytes, std::uint32_t struct_size, std::uint32_t known_size,
                  std::span<const std::uint32_t> earlier_sizes) {
  const auto wrong = [&](const char* why) {
    refuse("`struct_size` is " + std::to_string(struct_size) + ", expected " + std::to_string(known_size) +
           why);
  };
  const bool is_known =
      struct_size == known_size || std::ranges::find(earlier_sizes, struct_size) != earlier_sizes.end();
  if (is_known) return;
  const bool is_later =
      struct_size > known_size && struct_size <= kMostStructBytes && struct_size % alignof(void*) == 0;
  if (!is_later) wrong(": take the defaults from the *_defaults function of the same header");
  const auto* further = static_cast<const unsigned char*>(bytes);
  if (std::any_of(further + known_size, further + struct_size, [](unsigned char byte) { return byte != 0; }))
    wrong(": the caller's header is of a later version, and sets a member that this library does not know");
}

void write_bytes(const void* bytes, std::size_t count, void* buffer, std::size_t capacity,
                 std::size_t* size) {
  required(size, "size");
  require(buffer || capacity == 0, "`buffer` is null, but its capacity is not 0");
  *size = count;
  if (!buffer) return;
  if (capacity < count)
    fail(BRUME_ERROR_BUFFER, "the capacity is " + std::to_string(capacity) + " bytes, " +
                                 std::to_string(count) + " are required");
  if (count > 0) std::memcpy(buffer, bytes, count);
}

void Call::check(const void* pointer, Kind kind) {
  const auto wrong = [&](const char* what) {
    fail(BRUME_ERROR_HANDLE, std::string("expected a ") + kind_name(kind) + ", not " + what);
  };
  if (!pointer) wrong("null");
  if (reinterpret_cast<std::uintptr_t>(pointer) % alignof(Handle) != 0) wrong("an odd address");
  const auto& handle = *static_cast<const Handle*>(pointer);
  if (handle.magic != Handle::kMagic) wrong("something else, or what was destroyed");
  if (handle.kind != kind) wrong((std::string("a ") + kind_name(handle.kind)).c_str());
}

void Call::check_whole(const Handle& object) {
  if (object.broken)
    fail(BRUME_ERROR_BROKEN,
         std::string("the ") + kind_name(object.kind) + " broke in an earlier call: see BRUME_ERROR_BROKEN");
}

void Call::adopt(const std::shared_ptr<Settings>& settings) {
  if (settings_) return;
  settings_ = settings;
  tasks_.emplace(settings->thread_count, settings.get());
  warnings_.emplace(settings);
}

/// In the caller's floating-point environment, as report.
void Call::log_warnings() noexcept {
  if (!warnings_) return;
  const std::vector<std::string> lines = warnings_->take();
  const brume_log_callback log = settings_->log.load();
  warnings_.reset();
  if (lines.empty() || !log) return;
  tasks_.reset();
  floating_point_.reset();
  char error[kMaxLine];
  std::memcpy(error, t_last_error, kMaxLine);
  for (const std::string& line : lines) log(settings_->log_user, BRUME_OK, line.c_str());
  std::memcpy(t_last_error, error, kMaxLine);
}

brume_result Call::failed() noexcept {
  try {
    throw;
  } catch (const CallFailure& failure) {
    return report(failure.result, failure.message.c_str());
  } catch (const Error& error) {
    return report(result_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return report(BRUME_ERROR_MEMORY, "out of memory");
  } catch (const std::length_error&) {
    return report(BRUME_ERROR_MEMORY, "out of memory: a list would be too long");
  } catch (const std::system_error& error) {
    return report(BRUME_ERROR_MEMORY, error.what());
  } catch (const std::exception& error) {
    return report(BRUME_ERROR_INTERNAL, error.what());
  } catch (...) {
    return report(BRUME_ERROR_INTERNAL, "unknown exception");
  }
}

brume_result Call::report(brume_result result, const char* message) noexcept {
  std::size_t length = 0;
  append(length, function_);
  append(length, ": ");
  append(length, message);
  log_warnings();
  tasks_.reset();
  const brume_log_callback log = settings_ ? settings_->log.load() : nullptr;
  if (!log) return result;

  // The callback runs as the caller does, and may call functions that fail.
  floating_point_.reset();
  char line[kMaxLine];
  std::memcpy(line, t_last_error, kMaxLine);
  log(settings_->log_user, result, line);
  std::memcpy(t_last_error, line, kMaxLine);
  return result;
}

}  // namespace brume::api

extern "C" {

brume_result brume_version(uint32_t* major, uint32_t* minor, uint32_t* patch) BRUME_NOEXCEPT {
  if (major) *major = BRUME_VERSION_MAJOR;
  if (minor) *minor = BRUME_VERSION_MINOR;
  if (patch) *patch = BRUME_VERSION_PATCH;
  return BRUME_OK;
}

const char* brume_last_error(void) BRUME_NOEXCEPT {
  return brume::api::t_last_error;
}

const char* brume_result_name(brume_result result) BRUME_NOEXCEPT {
  // As a number: any may come from C.
  switch (static_cast<int>(result)) {
    case BRUME_OK:
      return "BRUME_OK";
    case BRUME_ERROR_ARGUMENT:
      return "BRUME_ERROR_ARGUMENT";
    case BRUME_ERROR_HANDLE:
      return "BRUME_ERROR_HANDLE";
    case BRUME_ERROR_DATA:
      return "BRUME_ERROR_DATA";
    case BRUME_ERROR_HISTORY:
      return "BRUME_ERROR_HISTORY";
    case BRUME_ERROR_MISMATCH:
      return "BRUME_ERROR_MISMATCH";
    case BRUME_ERROR_ORDER:
      return "BRUME_ERROR_ORDER";
    case BRUME_ERROR_BUFFER:
      return "BRUME_ERROR_BUFFER";
    case BRUME_ERROR_LIMIT:
      return "BRUME_ERROR_LIMIT";
    case BRUME_ERROR_MEMORY:
      return "BRUME_ERROR_MEMORY";
    case BRUME_ERROR_BROKEN:
      return "BRUME_ERROR_BROKEN";
    case BRUME_ERROR_INTERNAL:
      return "BRUME_ERROR_INTERNAL";
    case BRUME_ERROR_DEVICE:
      return "BRUME_ERROR_DEVICE";
    default:
      return "unknown";
  }
}

}  // extern "C"
