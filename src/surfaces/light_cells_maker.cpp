#include "surfaces/light_cells_maker.hpp"

#include <atomic>
#include <optional>
#include <thread>
#include <utility>

#include "core/log.hpp"
#include "core/tasks.hpp"

namespace brume::surfaces {
namespace {

/// What moves or flies is left out: cells that it entered would be made again in every frame.
LightCells make_cells(const scene::Scene& scene, const std::vector<std::uint32_t>& hidden_objects,
                      const voxel::BitGrid& grid) {
  planning::LevelState level;
  level.hidden_objects = hidden_objects;
  const Surfaces surfaces(scene, {&level, 1});
  return make_light_cells(grid, surfaces);
}

}  // namespace

struct LightCellsMaker::Expected {
  Expected(const scene::Scene& scene, std::shared_ptr<const planning::NextLevel> expected_level)
      : level(std::move(expected_level)),
        thread([this, &scene, log = log_of_threads(), tasks = task_settings()] {
          run(scene, log.get(), tasks);
        }) {}
  ~Expected() { thread.join(); }

  void run(const scene::Scene& scene, LogSink* log, const TaskSettings& tasks) noexcept {
    const LogScope log_scope(log);
    const TaskScope task_scope(tasks);
    try {
      cells = make_cells(scene, level->hidden_objects, level->opaque);
    } catch (...) {
      // Whoever needs the cells meets the same failure.
    }
    is_done = true;
    is_done.notify_all();
  }
  bool is(const planning::LevelState& state) const {
    return state.hidden_objects == level->hidden_objects &&
           voxel::same_voxels(*state.voxels.light_grid(), level->opaque);
  }

  std::shared_ptr<const planning::NextLevel> level;
  std::optional<LightCells> cells;
  std::atomic<bool> is_done{false};
  std::thread thread;
};

LightCellsMaker::LightCellsMaker(const scene::Scene& scene) : scene_(scene) {}

LightCellsMaker::~LightCellsMaker() = default;

LightCells LightCellsMaker::make(const planning::LevelState& level) {
  was_expected_ = false;
  if (expected_ && expected_->is(level)) {
    // It began before, and has as many threads: to wait takes no longer than to begin now.
    expected_->is_done.wait(false);
    const std::unique_ptr<Expected> expected = std::move(expected_);
    was_expected_ = expected->cells.has_value();
    if (was_expected_) return std::move(*expected->cells);
  }
  return make_cells(scene_, level.hidden_objects, *level.voxels.light_grid());
}

void LightCellsMaker::invalidate() {
  expected_.reset();
}

void LightCellsMaker::expect(const std::shared_ptr<const planning::NextLevel>& level) {
  if (!level || (expected_ && (expected_->level == level || !expected_->is_done))) return;
  expected_ = std::make_unique<Expected>(scene_, level);
}

}  // namespace brume::surfaces
