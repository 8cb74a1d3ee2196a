#include <filesystem>

#include "bench/bench.hpp"
#include "stage/live_stage.hpp"
#include "stage/walker.hpp"

namespace brume::bench {
namespace {

using stage::LiveStage;

/// The demo at a moment at which its smoke is grown.
constexpr double kStart = 4;
Result<std::unique_ptr<LiveStage>> demo() {
  auto stage = stage::load_stage(std::filesystem::path(BRUME_SCENES_DIR) / "demo.toml", {});
  if (!stage) return stage.failure();
  auto live = LiveStage::create(std::move(*stage));
  if (live) (*live)->advance_to(kStart);
  return live;
}

/// Processor time of deeds [ms], each at a tick of its own.
template <typename Make>
Result<Measurement> time_deeds(const Bench& bench, const std::string& name, unsigned repetitions, Make make) {
  auto live = demo();
  if (!live) return live.failure();
  std::vector<double> times;
  for (unsigned i = 0; i < bench.repetitions(repetitions); ++i) {
    const double now = kStart + i / 64.0;
    (*live)->advance_to(now);
    scene::Timeline deeds;
    make(deeds, now, i);
    const double before = thread_cpu_ms();
    if (auto done = (*live)->add(deeds); !done) return done.failure();
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

Result<std::vector<Measurement>> deeds(Bench& bench) {
  std::vector<Result<Measurement>> measured;
  measured.push_back(time_deeds(bench, "live/shot", 200,
                                [](auto& deeds, double now, unsigned) { deeds.shots = {shot_at(now)}; }));
  measured.push_back(time_deeds(bench, "live/past_shot", 20,
                                [](auto& deeds, double now, unsigned) { deeds.shots = {shot_at(now - 1)}; }));
  measured.push_back(time_deeds(bench, "live/door", 40, [](auto& deeds, double now, unsigned i) {
    deeds.doors = {{now, "door_leaf", i % 2 == 0, ""}};
  }));
  measured.push_back(time_deeds(bench, "live/new_word", 10, [](auto& deeds, double now, unsigned i) {
    deeds.texts.resize(1);
    deeds.texts[0].time = now;
    deeds.texts[0].text = std::string("WORD ") + static_cast<char>('a' + i % 26);
  }));
  std::vector<Measurement> all;
  for (Result<Measurement>& one : measured) {
    if (!one) return one.failure();
    all.push_back(std::move(*one));
  }
  return all;
}

/// A sixtieth of a second on foot, against a wall: every part of the frame tries to climb it.
Result<std::vector<Measurement>> walk(Bench& bench) {
  auto live = demo();
  if (!live) return live.failure();
  const voxel::BitGrid& grid = (*live)->simulation().world().grid();
  stage::Walker walker;
  walker.put(grid, {-6.0f, 1.7f, 11.4f});
  std::vector<Measurement> all;
  all.push_back(bench.time_calls("live/walk", 1000, [&] {
    walker.move(grid, {{0, 0, -1}, false, false}, 1.0 / 60);
  }));
  return all;
}

}  // namespace

std::vector<Case> live_cases() {
  return {{"live/deeds",
           "shots, doors and words into the running demo: processor time until the world has them", deeds},
          {"live/walk", "a sixtieth of a second of a body on foot in the demo", walk}};
}

}  // namespace brume::bench
