#include "sim/made_clouds.hpp"

#include <algorithm>

namespace brume::sim {
namespace {

bool same_edits(const std::shared_ptr<const EditBlocks>& a, const std::shared_ptr<const EditBlocks>& b) {
  if (a == b) return true;
  return a && b ? *a == *b : (a ? a->empty() : b->empty());
}

}  // namespace

std::shared_ptr<const Cloud> MadeClouds::find(const CloudRecipe& recipe) const {
  const auto [begin, end] = made_.equal_range(recipe.tick);
  for (auto made = begin; made != end; ++made) {
    const CloudRecipe& other = made->second.recipe;
    if (other.before != recipe.before || other.origin != recipe.origin) continue;
    auto cloud = made->second.cloud.lock();
    if (cloud && same_edits(other.edits, recipe.edits)) return cloud;
  }
  return nullptr;
}

void MadeClouds::add(const CloudRecipe& recipe, const std::shared_ptr<const Cloud>& cloud) {
  const auto [begin, end] = made_.equal_range(recipe.tick);
  if (std::any_of(begin, end, [&](const auto& made) { return made.second.cloud.lock() == cloud; })) return;
  made_.emplace_hint(end, recipe.tick, Made{recipe, cloud});
  if (made_.size() < clean_at_) return;
  std::erase_if(made_, [](const auto& made) { return made.second.cloud.expired(); });
  clean_at_ = std::max<std::size_t>(64, 2 * made_.size());
}

}  // namespace brume::sim
