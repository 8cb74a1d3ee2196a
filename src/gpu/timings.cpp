#include "gpu/timings.hpp"

#include <algorithm>
#include <array>

namespace brume::gpu {

Timings::Timings(Context& context, bool enabled) : context_(context) {
  if (!enabled || context.timestamp_mask() == 0) return;
  context.expect_retirement();
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kMaxScopes;
  check(context.vk().CreateQueryPool(context.device(), &info, context.vk().allocator, &pool_),
        "vkCreateQueryPool");
}

Timings::~Timings() {
  if (pool_) context_.retire({.queries = pool_});
}

void Timings::reset(CommandList& list) {
  names_.clear();
  is_recorded_ = false;
  if (!pool_) return;
  list.add([pool = pool_](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdResetQueryPool(commands, pool, 0, 2 * kMaxScopes);
  });
}

void Timings::write(CommandList& list, std::size_t query) const {
  if (names_.size() > kMaxScopes) return;
  list.add([pool = pool_, query = static_cast<std::uint32_t>(query)](const Functions& vk,
                                                                     VkCommandBuffer commands) {
    vk.CmdWriteTimestamp(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, pool, query);
  });
}

void Timings::begin(CommandList& list, const char* name) {
  if (!pool_) return;
  names_.push_back(name);
  write(list, 2 * names_.size() - 2);
}

void Timings::end(CommandList& list) {
  if (pool_) write(list, 2 * names_.size() - 1);
}

std::vector<Timings::Scope> Timings::read() const {
  std::vector<Scope> scopes;
  read(scopes, true);
  return scopes;
}

void Timings::read(std::vector<Scope>& scopes, bool wait) const {
  scopes.clear();
  const auto count = std::min<std::size_t>(names_.size(), kMaxScopes);
  if (count == 0 || !is_recorded_) return;
  std::array<std::uint64_t, 2 * kMaxScopes> ticks;
  VkQueryResultFlags flags = VK_QUERY_RESULT_64_BIT;
  if (wait) flags |= VK_QUERY_RESULT_WAIT_BIT;
  const VkResult result =
      context_.vk().GetQueryPoolResults(context_.device(), pool_, 0, static_cast<std::uint32_t>(2 * count),
                                        2 * count * 8, ticks.data(), 8, flags);
  if (result == VK_NOT_READY) return;
  check(result, "vkGetQueryPoolResults");
  for (std::size_t i = 0; i < count; ++i) {
    const auto duration = static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & context_.timestamp_mask());
    scopes.push_back({names_[i], duration * context_.timestamp_period() * 1e-6});
  }
}

}  // namespace brume::gpu
