// Light cells of the levels of a scene, without a wait where a change of the level is known before.
#pragma once

#include <memory>

#include "surfaces/light_cells.hpp"

namespace brume::surfaces {

class LightCellsMaker {
 public:
  /// `scene` must outlive it.
  explicit LightCellsMaker(const scene::Scene& scene);
  /// Waits for what `expect` began.
  ~LightCellsMaker();
  LightCellsMaker(const LightCellsMaker&) = delete;
  LightCellsMaker& operator=(const LightCellsMaker&) = delete;

  /// The cells of a level with a grid, without objects that move and grenades: the same whether they were
  /// expected or not. Throws what Surfaces throws.
  LightCells make(const planning::LevelState& level);
  /// Begins to make the cells of a level in a thread of its own, unless it is making others. null: none.
  void expect(const std::shared_ptr<const planning::NextLevel>& level);
  /// The scene changes: waits for what `expect` began, and drops it.
  void invalidate();
  /// Whether the cells of the last `make` had been expected.
  bool was_expected() const { return was_expected_; }

 private:
  struct Expected;
  const scene::Scene& scene_;
  std::unique_ptr<Expected> expected_;
  bool was_expected_ = false;
};

}  // namespace brume::surfaces
