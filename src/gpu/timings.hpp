// GPU times of named parts of a recording, by timestamp queries.
#pragma once

#include <string_view>
#include <vector>

#include "gpu/command_list.hpp"
#include "gpu/context.hpp"

namespace brume::gpu {

class Timings {
 public:
  static constexpr std::uint32_t kMaxScopes = 64;
  struct Scope {
    std::string_view name;
    double milliseconds = 0;
  };

  /// Takes times unless the queue family has no timestamps; where not `enabled`, it does nothing at all.
  Timings(Context& context, bool enabled);
  ~Timings();
  Timings(const Timings&) = delete;
  Timings& operator=(const Timings&) = delete;

  /// Clears the scopes of the last recording; must be the first command of a recording.
  void reset(CommandList& list);
  /// Scopes do not nest. More than kMaxScopes are ignored.
  void begin(CommandList& list, const char* name);
  void end(CommandList& list);
  /// The commands of the list were recorded; before that, there is nothing to be read.
  void set_recorded() { is_recorded_ = true; }
  /// The scopes in order, once the device has completed the recording.
  std::vector<Scope> read() const;
  /// The same in place of what `scopes` has; none where the recording was not submitted.
  void read_available(std::vector<Scope>& scopes) const { read(scopes, false); }

 private:
  void read(std::vector<Scope>& scopes, bool wait) const;

  Context& context_;
  VkQueryPool pool_ = VK_NULL_HANDLE;  // null: no times
  void write(CommandList& list, std::size_t query) const;

  std::vector<const char*> names_;
  bool is_recorded_ = false;
};

}  // namespace brume::gpu
