// GPU time of named parts of a recording, by timestamp queries.
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

  /// Forgets the scopes of the last recording; first command of a recording.
  void reset(VkCommandBuffer commands);
  /// Scopes do not nest. More than kMaxScopes are ignored.
  void begin(VkCommandBuffer commands, const char* name);
  void end(VkCommandBuffer commands);
  /// After the device is done with the recording: its scopes in order.
  std::vector<Scope> read() const;

 private:
  Context& context_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::vector<const char*> names_;
};

}  // namespace brume::gpu
