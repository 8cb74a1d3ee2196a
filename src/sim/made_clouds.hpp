// Clouds that a world has made, to be found when it plays the same ticks again: a late event changes few of
// them, and to flood the level for one takes longer than all else in a tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "sim/cloud.hpp"
#include "sim/level_edit.hpp"

namespace brume::sim {

/// What a cloud is made of, in one level: clouds of equal recipes are equal.
struct CloudRecipe {
  CloudOrigin origin;
  /// The cloud that flows at `tick`; null: a new one detonates then.
  std::shared_ptr<const Cloud> before;
  std::uint32_t tick = 0;
  std::shared_ptr<const EditBlocks> edits;  ///< Edits of the level up to and with `tick`; null: none.
};

class MadeClouds {
 public:
  /// The cloud of an equal recipe, as long as anybody else has it; else null.
  std::shared_ptr<const Cloud> find(const CloudRecipe& recipe) const;
  /// No effect if it has the cloud.
  void add(const CloudRecipe& recipe, const std::shared_ptr<const Cloud>& cloud);
  /// Forgets those made up to a tick.
  void forget_until(std::uint32_t tick) { made_.erase(made_.begin(), made_.upper_bound(tick)); }
  void clear() { made_.clear(); }

 private:
  struct Made {
    CloudRecipe recipe;
    std::weak_ptr<const Cloud> cloud;
  };

  std::multimap<std::uint32_t, Made> made_;  // by CloudRecipe::tick
  std::size_t clean_at_ = 64;                // how many there are when those whose cloud is gone are removed
};

}  // namespace brume::sim
