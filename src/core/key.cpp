#include "core/key.hpp"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <new>
#include <vector>

#include "core/file.hpp"

// As in hash.cpp.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace brume {

struct KeyHasher::State {
  XXH3_state_t* hash = XXH3_createState();
  State() {
    if (hash == nullptr || XXH3_128bits_reset(hash) != XXH_OK) throw std::bad_alloc();
  }
  State(const State&) = delete;
  ~State() { XXH3_freeState(hash); }

  void update(const void* bytes, std::size_t count) {
    BRUME_ASSERT(XXH3_128bits_update(hash, bytes, count) == XXH_OK, "");
  }
  void begin(std::uint64_t length) {
    std::array<unsigned char, 8> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(length >> (8 * i));
    update(bytes.data(), bytes.size());
  }
};

KeyHasher::KeyHasher() : state_(std::make_unique<State>()) {}
KeyHasher::~KeyHasher() = default;

void KeyHasher::add(std::span<const std::byte> bytes) {
  state_->begin(bytes.size());
  if (!bytes.empty()) state_->update(bytes.data(), bytes.size());
}

void KeyHasher::add(std::string_view text) {
  add(std::as_bytes(std::span(text.data(), text.size())));
}

Result<void> KeyHasher::add_file(const std::filesystem::path& file, const std::function<void()>& between) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  std::error_code error;
  const std::uint64_t length = std::filesystem::file_size(file, error);
  if (error) return system_failure(file, "read", error.value());
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return system_failure(file, "read", errno);
  state_->begin(length);
  std::vector<char> part(kPart);
  std::uint64_t done = 0;
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    if (count > 0) state_->update(part.data(), count);
    done += count;
    if (between) between();
  }
  if (stream.bad()) return system_failure(file, "read", errno);
  if (done != length)
    return Failure{ErrorCode::bad_input, file.string() + ": changes while it is read; run the command again"};
  return {};
}

std::string KeyHasher::digest() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->hash));
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(byte));
    text += digits;
  }
  return text;
}

}  // namespace brume
