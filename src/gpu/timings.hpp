// GPU times of named parts of a recording, by timestamp queries.
#pragma once

#include <string>
#include <vector>

#include "gpu/context.hpp"

namespace brume::gpu {

class Timings {
 public:
  static constexpr std::uint32_t kMaxScopes = 64;
  struct Scope {
    std::string name;
    double milliseconds = 0;
  };

  explicit Timings(Context& context);
  ~Timings();
  Timings(const Timings&) = delete;
  Timings& operator=(const Timings&) = delete;

  /// Clears the scopes of the last recording; must be the first command of a recording.
  void reset(VkCommandBuffer commands);
  /// Scopes do not nest. More than kMaxScopes are ignored.
  void begin(VkCommandBuffer commands, const char* name);
  void end(VkCommandBuffer commands);
  /// The scopes in order, once the device has completed the recording.
  std::vector<Scope> read() const { return read(true); }
  /// The same, and none where the recording was not submitted.
  std::vector<Scope> read_available() const { return read(false); }

 private:
  std::vector<Scope> read(bool wait) const;

  Context& context_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::vector<const char*> names_;
};

}  // namespace brume::gpu
