#include "gpu/timings.hpp"

namespace brume::gpu {

Timings::Timings(Context& context) : context_(context) {
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kMaxScopes;
  check(context.vk().CreateQueryPool(context.device(), &info, nullptr, &pool_), "vkCreateQueryPool");
}

Timings::~Timings() {
  context_.retire({.queries = pool_});
}

void Timings::reset(VkCommandBuffer commands) {
  names_.clear();
  context_.vk().CmdResetQueryPool(commands, pool_, 0, 2 * kMaxScopes);
}

void Timings::begin(VkCommandBuffer commands, const char* name) {
  names_.push_back(name);
  if (names_.size() > kMaxScopes) return;
  const auto query = static_cast<std::uint32_t>(2 * names_.size() - 2);
  context_.vk().CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
}

void Timings::end(VkCommandBuffer commands) {
  if (names_.size() > kMaxScopes) return;
  const auto query = static_cast<std::uint32_t>(2 * names_.size() - 1);
  context_.vk().CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
}

std::vector<Timings::Scope> Timings::read(bool wait) const {
  const auto count = std::min<std::size_t>(names_.size(), kMaxScopes);
  if (count == 0) return {};
  std::vector<std::uint64_t> ticks(2 * count);
  VkQueryResultFlags flags = VK_QUERY_RESULT_64_BIT;
  if (wait) flags |= VK_QUERY_RESULT_WAIT_BIT;
  const VkResult result =
      context_.vk().GetQueryPoolResults(context_.device(), pool_, 0, static_cast<std::uint32_t>(2 * count),
                                        ticks.size() * 8, ticks.data(), 8, flags);
  if (result == VK_NOT_READY) return {};
  check(result, "vkGetQueryPoolResults");
  std::vector<Scope> scopes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto duration = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
    scopes.push_back({names_[i], duration * context_.timestamp_period() * 1e-6});
  }
  return scopes;
}

}  // namespace brume::gpu
