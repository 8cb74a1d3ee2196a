#include <filesystem>

#include "bench/bench.hpp"
#include "scenario/editable_scenario.hpp"
#include "scenario/walker.hpp"

namespace brume::bench {
namespace {

using scenario::EditableScenario;

/// The demo at a time when its smoke has grown [s].
constexpr double kStart = 4;
Result<std::unique_ptr<EditableScenario>> demo() {
  auto scenario = scenario::load_scenario(scene_file("demo.toml"), {});
  if (!scenario) return scenario.failure();
  auto live = EditableScenario::create(std::move(*scenario));
  if (live) (*live)->advance_to(kStart);
  return live;
}

/// CPU time of actions [ms], each at its own tick.
template <typename Make>
Result<Measurement> time_actions(const Bench& bench, const std::string& name, unsigned repetitions,
                                 Make make) {
  auto live = demo();
  if (!live) return live.failure();
  std::vector<double> times;
  for (unsigned i = 0; i < bench.repetitions(repetitions); ++i) {
    const double now = kStart + i / 64.0;
    (*live)->advance_to(now);
    scene::Timeline actions;
    make(actions, now, i);
    const double before = thread_cpu_ms();
    if (auto done = (*live)->add(actions); !done) return done.failure();
    times.push_back(thread_cpu_ms() - before);
  }
  return summarize(name, "ms", "cpu", std::move(times));
}

scene::ShotEvent shot_at(double time) {
  scene::ShotEvent shot;
  shot.time = time;
  shot.from_world = {-5.2f, 1.35f, 10.8f};
  shot.toward_world = {-2.75f, 1.55f, 0.0f};
  return shot;
}

Result<std::vector<Measurement>> actions(Bench& bench) {
  std::vector<Result<Measurement>> measured;
  measured.push_back(time_actions(
      bench, "live/shot", 200, [](auto& actions, double now, unsigned) { actions.shots = {shot_at(now)}; }));
  measured.push_back(time_actions(bench, "live/past_shot", 20, [](auto& actions, double now, unsigned) {
    actions.shots = {shot_at(now - 1)};
  }));
  measured.push_back(time_actions(bench, "live/door", 40, [](auto& actions, double now, unsigned i) {
    actions.doors = {{now, "door_leaf", i % 2 == 0, ""}};
  }));
  measured.push_back(time_actions(bench, "live/new_word", 10, [](auto& actions, double now, unsigned i) {
    actions.texts.resize(1);
    actions.texts[0].time = now;
    actions.texts[0].text = std::string("WORD ") + static_cast<char>('a' + i % 26);
  }));
  std::vector<Measurement> all;
  for (Result<Measurement>& one : measured) {
    if (!one) return one.failure();
    all.push_back(std::move(*one));
  }
  return all;
}

/// A sixtieth of a second on foot, against a wall: every substep tries to climb it.
Result<std::vector<Measurement>> walk(Bench& bench) {
  auto live = demo();
  if (!live) return live.failure();
  const voxel::BitGrid& grid = (*live)->simulation().world().grid();
  scenario::Walker walker;
  walker.put(grid, {-6.0f, 1.7f, 11.4f});
  std::vector<Measurement> all;
  all.push_back(bench.time_calls("live/walk", 1000, [&] {
    walker.move(grid, {{0, 0, -1}, false, false}, 1.0 / 60);
  }));
  return all;
}

}  // namespace

std::vector<Case> live_cases() {
  return {{"live/actions",
           "adding shots, doors and words to the running demo: CPU time until the world has applied them",
           actions},
          {"live/walk", "1/60 s of a walking player in the demo", walk}};
}

}  // namespace brume::bench
