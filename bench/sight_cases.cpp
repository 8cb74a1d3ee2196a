#include <algorithm>
#include <random>

#include "bench/bench.hpp"
#include "core/tasks.hpp"
#include "image/font.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "voxel/voxelize.hpp"

namespace brume::bench {
namespace {

constexpr std::size_t kHoles = 32, kSegments = 20000, kBatch = 2000;
constexpr float kMetres = 10;
constexpr std::uint32_t kLetterRadius = sim::kUnitsPerMetre / 2;  // half the edge of a letter

/// A level with a smoke of 1,800 voxels.
struct SmokyLevel {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  smoke::MaskAtlas masks;
  sim::World world;
  smoke::SmokeVolume volume;
  std::vector<glm::vec3> places;  // centres of its voxels

  SmokyLevel(const std::vector<voxel::Triangle>& triangles, const voxel::GridLayout& frame, glm::dvec3 source,
             std::span<const smoke::Mask> pictures = {})
      : grid(voxel::voxelize(triangles, frame).value_or_throw()),
        planes(voxel::SurfacePlanes::build(triangles, grid)),
        masks(smoke::MaskAtlas::pack(pictures).value_or_throw()),
        world(grid, {.masks = masks.key()}),
        volume(grid, planes) {
    sim::ThrowSmoke thrown;
    thrown.from = thrown.at = sim::position_from_metres(source);
    world.append(thrown).value_or_throw();
    world.advance_to(100);
    for (const sim::LiveCloud& live : world.state().clouds)
      live.cloud->voxels().for_each([&](glm::ivec3 v, std::uint32_t) {
        places.push_back(voxel::world_from_voxel(frame, glm::vec3(v) + 0.5f));
      });
  }

  /// Fires shots between random points of the smoke until `holes` of them are fully open; cycles through the
  /// masks, if there are any.
  void shoot(std::size_t holes, std::mt19937& random) {
    for (int tries = 0; tries < 1000 && world.state().holes.size() < holes; ++tries) {
      sim::Shot shot;
      shot.tick = world.tick();
      shot.origin = sim::position_from_metres(glm::dvec3(places[random() % places.size()]));
      shot.toward = sim::position_from_metres(glm::dvec3(places[random() % places.size()]));
      if (masks.count() > 0) {
        shot.shape = sim::HoleShape::mask;
        shot.mask = static_cast<std::uint32_t>(tries) % masks.count();
        shot.radius = kLetterRadius;
      }
      if (shot.origin != shot.toward) world.append(shot).value_or_throw();
    }
    world.advance_to(world.tick() + 25);
    volume.update(world);
  }
};

std::vector<smoke::Segment> segments_through(const std::vector<glm::vec3>& places, std::mt19937& random) {
  std::normal_distribution<float> normal;
  std::vector<smoke::Segment> segments(kSegments);
  for (smoke::Segment& s : segments) {
    const glm::vec3 middle = places[random() % places.size()];
    const float x = normal(random), y = normal(random), z = normal(random);
    const glm::vec3 half = 0.5f * kMetres * glm::normalize(glm::vec3(x, y, z));
    s = {middle - half, middle + half};
  }
  return segments;
}

/// Queries per second of CPU time on one thread.
Measurement measure(const Bench& bench, const std::string& name, SmokyLevel& level, std::size_t holes) {
  std::mt19937 random(7);
  level.shoot(holes, random);
  const std::vector<shared::Hole> open = smoke::make_holes(level.world.state(), &level.masks);
  const smoke::Sight sight(level.volume, level.grid, open, level.world.state().seconds(level.world.tick()),
                           {.masks = &level.masks});
  const std::vector<smoke::Segment> segments = segments_through(level.places, random);
  std::vector<float> depths(kBatch);
  const unsigned threads = thread_count(), count = bench.repetitions(200);
  set_thread_count(1);
  std::vector<double> rates;
  double sum = 0;
  for (std::size_t i = 0; i < count + count / 8; ++i) {
    const double start = thread_cpu_ms();
    sight.optical_depths(std::span(segments).subspan(i * kBatch % kSegments, kBatch), depths)
        .value_or_throw();
    const double milliseconds = thread_cpu_ms() - start;
    if (i >= count / 8) rates.push_back(kBatch / milliseconds * 1e-3);
    for (const float depth : depths) sum += depth;
  }
  set_thread_count(threads);
  Measurement m = summarize(name, "M/s", "cpu", std::move(rates));
  m.details = {{"holes", static_cast<double>(open.size())},
               {"mean_depth", sum / static_cast<double>((count + count / 8) * kBatch)},
               {"boundary_cells", static_cast<double>(level.volume.boundary_cells().size())}};
  return m;
}

/// The letters of a word, as text events shoot them.
Result<std::vector<smoke::Mask>> letters(const std::string& word) {
  auto font = image::Font::load(image::default_font());
  if (!font) return font.failure();
  std::vector<smoke::Mask> masks;
  for (const char letter : word) {
    auto glyph = font->glyph(static_cast<unsigned char>(letter));
    if (!glyph) return glyph.failure();
    masks.push_back({glyph->side, glyph->side, std::move(glyph->coverage)});
  }
  return masks;
}

Result<std::vector<Measurement>> sight_1800(Bench& bench) {
  std::vector<Measurement> all;
  const auto both = [&](const std::string& name, SmokyLevel& level) {
    all.push_back(measure(bench, name + "/no_holes", level, 0));
    all.push_back(measure(bench, name, level, kHoles));
  };
  SmokyLevel open({}, {{64, 64, 64}, 0.5f, {0, 0, 0}}, {16, 16, 16});
  both("sight/1800/open", open);
  const auto word = letters("BRUME");
  if (!word) return word.failure();
  SmokyLevel written({}, {{64, 64, 64}, 0.5f, {0, 0, 0}}, {16, 16, 16}, *word);
  all.push_back(measure(bench, "sight/1800/letters", written, kHoles));

  const auto demo = scene::load_scene(scene_file("demo.glb"));
  if (!demo) return demo.failure();
  SmokyLevel rooms(scenario::world_triangles(*demo), {{57, 19, 57}, 0.5f, {-14.1f, -0.35f, -12.1f}},
                   {-2.6, 1, -3});
  both("sight/1800/demo", rooms);

  if (const auto path = motel_scene()) {
    const auto scene = scene::load_scene(*path);
    if (!scene) return scene.failure();
    SmokyLevel motel(scenario::world_triangles(*scene), {{120, 20, 120}, 0.5f, {-30, 0, -30}},
                     {10.25, 1.75, 10.25});
    both("sight/1800/motel", motel);
  }
  return all;
}

}  // namespace

std::vector<Case> sight_cases() {
  return {{"sight/1800", "lines of sight of 10 m through 1,800 voxels of smoke with 32 holes, one thread",
           sight_1800}};
}

}  // namespace brume::bench
