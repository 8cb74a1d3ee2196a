// Tracking through media whose transmittance and emission are known, and bounds of them.
#include "reference/volume_medium.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {
namespace {

constexpr std::uint32_t kRays = (1u << 16) / kFewer;
const Box<float> kBox{{-1, -2, 0}, {3, 2, 5}};

/// Depth of a ray along z through the box, by its length.
struct Case {
  const char* name;
  BoxMedium::Matter matter;
  double depth;
  glm::ivec3 cells;
};
std::vector<Case> cases() {
  return {
      {"constant", constant(0.7f, 1), 0.7 * 5, {1, 1, 1}},
      {"constant in cells", constant(0.7f, 1), 0.7 * 5, {3, 1, 7}},
      {"thin", constant(1e-3f, 1), 5e-3, {1, 1, 1}},
      {"ramp", {[](const glm::vec3& p) { return 0.2f * p.z; }, 1}, 0.2 * 12.5, {2, 2, 2}},
      {"far below its bound", {[](const glm::vec3&) { return 0.1f; }, 20}, 0.5, {1, 1, 4}},
      {"known", {[](const glm::vec3&) { return 0.7f; }, 0.7f, glm::vec3(1), nullptr, 0.7f}, 3.5, {1, 1, 3}},
      {"known in part",
       {[](const glm::vec3& p) { return 0.2f + 0.1f * p.z; }, 1, glm::vec3(1), nullptr, 0.2f},
       2.25,
       {2, 2, 2}},
      {"dense, known in part",
       {[](const glm::vec3& p) { return 0.62f + 0.03f * p.z; }, 0.8f, glm::vec3(1), nullptr, 0.6f},
       3.475,
       {1, 1, 6}},
      {"two layers", {[](const glm::vec3& p) { return p.z < 2 ? 0.0f : 0.5f; }, 0.5f}, 1.5, {1, 1, 5}}};
}

TEST(MediaTest, TransmittanceIsExact) {
  for (const Case& one : cases()) {
    const Media media =
        media_of(std::make_unique<BoxMedium>(kBox, one.matter, shared::phase_of_hg(0), one.cells));
    Mean ratio, delta;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      Sampler sampler({i, 0}, 0);
      const Ray ray{{0.5f, 0.3f, -2}, {0, 0, 1}};
      ratio.add(double{media.transmittance(ray, sampler)});
      glm::vec3 emitted(0);
      delta.add(media.collide(ray, sampler, emitted) ? 0.0 : 1.0);
    }
    SCOPED_TRACE(one.name);
    expect_mean(ratio, std::exp(-one.depth), 0.03);
    expect_mean(delta, std::exp(-one.depth), 0.03);
  }
}

TEST(MediaTest, RaysEndWhereTheySay) {
  const Media media =
      media_of(std::make_unique<BoxMedium>(kBox, constant(0.5f, 1), shared::phase_of_hg(0), glm::ivec3(3)));
  Mean mean;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    Sampler sampler({i, 0}, 0);
    // From within, obliquely, to within.
    mean.add(double{media.transmittance({{0, 0, 1}, glm::normalize(glm::vec3(1, 0.5f, 1)), 1.25f}, sampler)});
  }
  expect_mean(mean, std::exp(-0.5 * 1.25), 0.01);
}

TEST(MediaTest, CollisionsLieWhereTheExtinctionIs) {
  // Their distances follow exp(-depth).
  const BoxMedium::Matter ramp{[](const glm::vec3& p) { return 0.1f + 0.3f * p.z; }, 1.6f, glm::vec3(1),
                               nullptr, 0.1f};
  const Media media =
      media_of(std::make_unique<BoxMedium>(kBox, ramp, shared::phase_of_hg(0), glm::ivec3(4)));
  constexpr int kCells = 20;
  std::vector<double> counts(kCells + 1), expected;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    Sampler sampler({i, 0}, 0);
    glm::vec3 emitted(0);
    const auto collision = media.collide({{0.5f, 0.3f, 0}, {0, 0, 1}}, sampler, emitted);
    ++(collision ? counts[static_cast<std::size_t>(collision->t / 5 * kCells)] : counts.back());
  }
  const auto passed = [](double z) { return std::exp(-0.1 * z - 0.15 * z * z); };
  for (int i = 0; i < kCells; ++i) expected.push_back(kRays * (passed(i * 0.25) - passed((i + 1) * 0.25)));
  expected.push_back(kRays * passed(5));
  expect_distribution(counts, expected);
}

TEST(MediaTest, OverlappingMediaAddUp) {
  std::vector<std::unique_ptr<Medium>> two;
  two.push_back(std::make_unique<BoxMedium>(kBox, constant(0.4f, 1), shared::phase_of_hg(0)));
  two.push_back(std::make_unique<BoxMedium>(Box<float>{{-1, -1, 1}, {1, 1, 3}}, constant(0.8f, 1),
                                            shared::phase_of_hg(0)));
  const Media media(std::move(two));
  Mean ratio, delta, second;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    Sampler sampler({i, 0}, 0);
    const Ray ray{{0.5f, 0.3f, -2}, {0, 0, 1}};
    ratio.add(double{media.transmittance(ray, sampler)});
    glm::vec3 emitted(0);
    const auto collision = media.collide(ray, sampler, emitted);
    delta.add(collision ? 0.0 : 1.0);
    second.add(collision && collision->medium == media.all()[1].get() ? 1.0 : 0.0);
  }
  expect_mean(ratio, std::exp(-0.4 * 5 - 0.8 * 2), 0.03);
  expect_mean(delta, std::exp(-0.4 * 5 - 0.8 * 2), 0.04);
  // Of what reaches the overlap, that which does not leave it, in proportion to the extinctions.
  expect_mean(second, std::exp(-0.4) * (1 - std::exp(-1.2 * 2)) * 0.8 / 1.2, 0.01);
}

TEST(MediaTest, EmissionIsDimmedByAllThatLiesBefore) {
  const auto glowing = [](float extinction, float largest) {
    return BoxMedium::Matter{[=](const glm::vec3&) { return extinction; }, largest, glm::vec3(0),
                             [](const glm::vec3&) { return glm::vec3(2); }};
  };
  const auto mean_of = [&](std::vector<std::unique_ptr<Medium>> all) {
    const Media media(std::move(all));
    Mean mean;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      Sampler sampler({i, 0}, 0);
      glm::vec3 emitted(0);
      media.collide({{0.5f, 0.3f, -2}, {0, 0, 1}}, sampler, emitted);
      mean.add(double{emitted.r});
    }
    return mean;
  };
  // A glow alone is a plain sum; with an extinction it saturates.
  std::vector<std::unique_ptr<Medium>> alone, dense, behind;
  alone.push_back(std::make_unique<BoxMedium>(kBox, glowing(0, 1), shared::phase_of_hg(0)));
  expect_mean(mean_of(std::move(alone)), 2 * 5, 0.01);
  dense.push_back(std::make_unique<BoxMedium>(kBox, glowing(0.6f, 2), shared::phase_of_hg(0)));
  expect_mean(mean_of(std::move(dense)), 2 / 0.6 * (1 - std::exp(-3.0)), 0.01);
  // What absorbs before it and within it.
  behind.push_back(std::make_unique<BoxMedium>(kBox, glowing(0, 1), shared::phase_of_hg(0)));
  behind.push_back(std::make_unique<BoxMedium>(Box<float>{{-1, -1, -1}, {1, 1, 2}}, constant(0.9f, 0),
                                               shared::phase_of_hg(0)));
  const double before = std::exp(-0.9), within = 2 * before * (1 - std::exp(-1.8)) / 0.9,
               after = 2 * 3 * std::exp(-2.7);
  expect_mean(mean_of(std::move(behind)), within + after, 0.01);
}

TEST(MajorantsTest, WhereNothingIsSaidTheLeastIsZero) {
  Majorants cells(glm::mat4(1), {glm::ivec3(0), glm::ivec3(2, 1, 1)}, 1);
  for (int x = 0; x < 2; ++x) cells.at({x, 0, 0}) = 3;
  EXPECT_EQ(cells.least(1), 0);
  cells.lower_least({0, 0, 0}, 2);
  cells.lower_least({0, 0, 0}, 1);
  EXPECT_EQ(cells.least(0), 1);
  EXPECT_EQ(cells.least(1), 0);
}

TEST(MajorantsTest, DividedCellsHaveVoxelsOfTheirOwn) {
  Majorants cells(glm::scale(glm::translate(glm::mat4(1), {1, 2, 3}), glm::vec3(0.5f)),
                  {glm::ivec3(-4), glm::ivec3(8)}, 4);
  for_each_in(Box<int>{glm::ivec3(0), cells.size()}, [&](glm::ivec3 at) { cells.at(at) = 7; });
  std::vector<float> bounds(64);
  for (std::size_t i = 0; i < 64; ++i) bounds[i] = static_cast<float>(i);
  cells.divide({0, 1, 2}, std::vector<float>(64, 1));
  cells.divide({1, 0, 1}, bounds);
  for (std::uint32_t i = 0; i < 500 / kFewer; ++i) {
    Sampler sampler({i, 9}, 0);
    const auto random = [&] {
      return glm::vec3(sampler.random(), sampler.random(), sampler.random()) * 2.0f - 1.0f;
    };
    const Ray ray{glm::vec3(2, 3, 4) + 3.0f * random(), glm::normalize(random())};
    float last = 0;
    cells.traverse(ray, [&](float begin, float end, float bound) {
      EXPECT_GE(begin, last - 1e-4f);
      last = end;
      if (end - begin < 1e-3f) return false;
      const glm::ivec3 voxel(glm::floor(cells.voxel_from_world(ray.at(0.5f * (begin + end))) + 4.0f));
      const glm::ivec3 cell = voxel / 4, at = voxel % 4;
      const float expected = cell == glm::ivec3(0, 1, 2)   ? 1
                             : cell == glm::ivec3(1, 0, 1) ? static_cast<float>(at.x + 4 * (at.y + 4 * at.z))
                                                           : 7;
      EXPECT_EQ(bound, expected);
      return false;
    });
  }
}

TEST(MajorantsTest, RaysVisitTheCellsThatTheyCross) {
  Majorants cells(glm::scale(glm::translate(glm::mat4(1), {1, 2, 3}), glm::vec3(0.5f, 1, 2)),
                  {glm::ivec3(-4, 0, 2), glm::ivec3(9, 7, 6)}, 2);
  EXPECT_EQ(cells.size(), glm::ivec3(7, 4, 2));
  for_each_in(Box<int>{glm::ivec3(0), cells.size()},
              [&](glm::ivec3 at) { cells.at(at) = static_cast<float>(1 + at.x + 10 * at.y + 100 * at.z); });
  for (std::uint32_t i = 0; i < 500 / kFewer; ++i) {
    Sampler sampler({i, 7}, 0);
    const auto random = [&] {
      return glm::vec3(sampler.random(), sampler.random(), sampler.random()) * 2.0f - 1.0f;
    };
    const Ray ray{glm::vec3(1, 5, 11) + 8.0f * random(), glm::normalize(random()), 30 * sampler.random()};
    float last = 0;
    double inside = 0;
    cells.traverse(ray, [&](float begin, float end, float bound) {
      EXPECT_GE(begin, last - 1e-4f);
      last = end;
      inside += double{end} - double{begin};
      const glm::vec3 p = (cells.voxel_from_world(ray.at(0.5f * (begin + end))) - glm::vec3(-4, 0, 2)) / 2.0f;
      if (end - begin > 1e-3f) {
        const glm::ivec3 at(glm::floor(p));
        EXPECT_EQ(bound, static_cast<float>(1 + at.x + 10 * at.y + 100 * at.z));
      }
      return false;
    });
    // By small steps.
    double stepped = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const glm::vec3 p = (cells.voxel_from_world(ray.at(ray.end * (static_cast<float>(k) + 0.5f) / kSteps)) -
                           glm::vec3(-4, 0, 2)) /
                          2.0f;
      if (glm::all(glm::greaterThanEqual(p, glm::vec3(0))) &&
          glm::all(glm::lessThan(p, glm::vec3(cells.size()))))
        stepped += double{ray.end} / kSteps;
    }
    EXPECT_NEAR(inside, stepped, 2.5 * double{ray.end} / kSteps + 1e-4);
  }
}

// Null collisions stand on it: no value of an interval is more opaque than the interval's bound.
TEST(TransferCurveTest, TheBoundOfAnIntervalHoldsForAllOfItsValues) {
  planning::TransferInput transfer;
  transfer.range = {-1, 3};
  transfer.opacity = {{0, 0.2f}, {0.1f, 0}, {0.5f, 1}, {0.501f, 0.1f}, {1, 0.7f}};
  const TransferCurve curve(transfer, glm::vec3(0.9f));
  ASSERT_TRUE(curve.has_opacity());
  constexpr int kValues = 67;
  const auto value = [](int i) { return -1.5f + 5.0f * static_cast<float>(i) / kValues; };
  for (int low = 0; low < kValues; ++low)
    for (int high = low; high < kValues; ++high) {
      const float bound = curve.largest_opacity(value(low), value(high));
      EXPECT_LE(bound, 1 + 1e-4f);
      for (int i = low; i <= high; ++i)
        EXPECT_GE(bound, curve.at(value(i)).a - 1e-4f) << low << ' ' << high << ' ' << i;
    }
  // The bound says something: between the valley and the peak it follows the curve.
  EXPECT_LT(curve.largest_opacity(-0.7f, -0.5f), 0.1f);
}

}  // namespace
}  // namespace brume::reference
