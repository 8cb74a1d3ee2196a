// Lights inside of media and close to them: what equiangular sampling and paths from lights find beside paths
// from the eye.
#include "reference/near_lights.hpp"

#include <limits>
#include <numbers>
#include <utility>

#include "reference/light_path.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/squares.hpp"

namespace brume::reference {
namespace {

const Box<float> kMist{{-1, -1, -1.5f}, {1, 1, 1.5f}};

shared::Light point_at(const glm::vec3& p, float intensity = 3) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position_world = p;
  light.intensity = glm::vec3(intensity);
  return light;
}
shared::Light spot_at(const glm::vec3& p, const glm::vec3& direction, float cos_inner, float cos_outer) {
  shared::Light light = point_at(p);
  light.kind = shared::kLightSpot;
  light.direction = glm::normalize(direction);
  light.cos_inner = cos_inner;
  light.cos_outer = cos_outer;
  return light;
}

/// Its near lights are found.
std::unique_ptr<Scene> lit_scene(const scene::Scene& objects, Media media,
                                 std::vector<shared::Light> lights) {
  auto scene = scene_of(objects, std::move(media), std::move(lights));
  find_near_lights(*scene);
  return scene;
}

Ray ray_towards(const glm::vec3& from, const glm::vec3& to) {
  return {from, glm::normalize(to - from)};
}

TEST(LightChordTest, PlacesFollowTheIrradiance) {
  struct Line {
    float nearest, distance, begin, end;
  };
  // Past the light, through where it is constant, as good as through the light, a part of all that, and
  // before and after the nearest place.
  for (const Line& one :
       {Line{1, 0.5f, 0.2f, 2}, Line{1, 0.03f, 0, 2}, Line{0.7f, 1e-6f, 0, 2}, Line{0.5f, 0.05f, 0.48f, 0.9f},
        Line{0.5f, 0.05f, 0.2f, 0.47f}, Line{3, 0.3f, 1, 2.5f}, Line{-1, 0.01f, 0, 1}, Line{1, 0.1f, 0, 2}}) {
    SCOPED_TRACE(one.distance);
    const LightChord chord(one.nearest, one.distance, one.begin, one.end);
    constexpr int kCells = 50, kSteps = 2000;
    constexpr std::uint32_t kPlaces = (1u << 16) / kFewer;
    std::vector<double> expected(kCells), counts(kCells);
    const double width = (double{one.end} - double{one.begin}) / (kCells * kSteps);
    double integral = 0;
    for (int i = 0; i < kCells * kSteps; ++i) {
      const double t = double{one.begin} + width * (i + 0.5), off = t - double{one.nearest};
      const double irradiance = 1 / std::max(off * off + std::pow(double{one.distance}, 2), 0.01);
      expected[static_cast<std::size_t>(i / kSteps)] += irradiance * width;
      integral += irradiance * width;
      // The least distance of a millimetre changes squares of at least 0.1 m by 1e-4.
      if (i % 997 == 500) {
        EXPECT_NEAR(double{chord.density(static_cast<float>(t))} * double{chord.integral()}, irradiance,
                    3e-4 * irradiance);
      }
    }
    EXPECT_NEAR(double{chord.integral()}, integral, 3e-4 * integral);
    EXPECT_EQ(chord.density(one.begin - 0.01f), 0);
    EXPECT_EQ(chord.density(one.end + 0.01f), 0);
    for (double& part : expected) part *= kPlaces / integral;
    for (std::uint32_t i = 0; i < kPlaces; ++i) {
      Sampler sampler({i, 1}, 0);
      const float t = chord.sample(sampler.random());
      ASSERT_GE(t, one.begin - 1e-5f);
      ASSERT_LE(t, one.end + 1e-5f);
      ++counts[static_cast<std::size_t>(
          std::clamp(static_cast<int>((t - one.begin) / (one.end - one.begin) * kCells), 0, kCells - 1))];
    }
    expect_distribution(counts, expected);
  }
}

// Wherever a light reaches media on a ray, up to 1 m from it, places are sampled, and nowhere else.
TEST(NearChordsTest, ChordsAreWhereLightIs) {
  const scene::Scene nothing;
  int lit = 0, dark = 0;
  for (const float cos_outer : {0.9f, 0.5f, 0.1f, -0.4f}) {
    const auto scene = lit_scene(
        nothing, media_of(std::make_unique<BoxMedium>(kMist, constant(1, 1), shared::phase_of_hg(0))),
        {spot_at({0.2f, 0.1f, -0.3f}, {1, 2, 0.5f}, cos_outer + 0.05f, cos_outer)});
    ASSERT_EQ(scene->near_lights.size(), 1u);
    for (std::uint32_t i = 0; i < 2000 / kFewer; ++i) {
      Sampler sampler({i, 3}, 0);
      const auto random = [&] {
        return glm::vec3(sampler.random(), sampler.random(), sampler.random()) * 2.0f - 1.0f;
      };
      Ray ray{2.0f * random(), glm::normalize(random())};
      ray.end = 4 * sampler.random();
      NearChords chords;
      chords.find(*scene, ray);
      for (int step = 0; step < 100; ++step) {
        const float t = 0.05f * (static_cast<float>(step) + 0.5f);
        const glm::vec3 p = ray.at(t);
        const Incident incident = light_at(scene->lights[0], p);
        const bool is_lit = t < ray.end && kMist.contains(p) && incident.distance < 1 &&
                            incident.irradiance.r > 1e-3f * scene->lights[0].intensity.r;
        bool is_sampled = false;
        chords.for_each_at(t, [&](std::uint32_t, float density) { is_sampled = density > 0; });
        lit += is_lit;
        if (is_lit) {
          EXPECT_TRUE(is_sampled) << cos_outer << " " << t;
        }
        // Wide cones are not bounded.
        if (t > ray.end + 1e-4f || incident.distance > 1.0001f ||
            (cos_outer > 0 && incident.irradiance.r <= 0 && t < ray.end - 1e-3f)) {
          const float edge = glm::dot(-incident.to_light, scene->lights[0].direction) - cos_outer;
          if (incident.distance < 1 && t < ray.end && std::abs(edge) < 1e-4f) continue;
          ++dark;
          EXPECT_FALSE(is_sampled) << cos_outer << " " << t;
        }
      }
    }
  }
  EXPECT_GT(lit, 3000 / static_cast<int>(kFewer));
  EXPECT_GT(dark, 10000 / static_cast<int>(kFewer));
}

/// A box whose extinction is linear, so that the middle of a segment gives its optical depth.
struct LinearBox {
  Box<float> box;
  double at_zero;
  glm::dvec3 slope;  // per metre
  double albedo, g;
  double extinction(const glm::dvec3& p) const {
    return box.contains(glm::vec3(p)) ? at_zero + glm::dot(slope, p) : 0.0;
  }
  double depth(const glm::dvec3& a, const glm::dvec3& b) const {
    double begin = 0, end = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = b[axis] - a[axis];
      const double u = (double{box.low[axis]} - a[axis]) / along,
                   v = (double{box.high[axis]} - a[axis]) / along;
      if (along == 0) {
        if (a[axis] < double{box.low[axis]} || a[axis] > double{box.high[axis]}) return 0;
        continue;
      }
      begin = std::max(begin, std::min(u, v));
      end = std::min(end, std::max(u, v));
    }
    if (begin >= end) return 0;
    return (end - begin) * glm::length(b - a) *
           (at_zero + glm::dot(slope, glm::mix(a, b, 0.5 * (begin + end))));
  }
  std::unique_ptr<Medium> medium() const {
    // Its bound at the corner where it is densest.
    double largest = 0;
    for (int corner = 0; corner < 8; ++corner)
      largest = std::max(
          largest,
          at_zero + glm::dot(slope, glm::dvec3(glm::mix(box.low, box.high,
                                                        glm::bvec3(corner & 1, corner & 2, corner & 4)))));
    BoxMedium::Matter matter;
    matter.extinction = [copy = *this](const glm::vec3& p) {
      return static_cast<float>(copy.at_zero + glm::dot(copy.slope, glm::dvec3(p)));
    };
    matter.largest = static_cast<float>(largest) * kBoundSlack;
    matter.albedo = glm::vec3(static_cast<float>(albedo));
    return std::make_unique<BoxMedium>(box, matter, shared::phase_of_hg(static_cast<float>(g)),
                                       glm::ivec3(3));
  }
};

/// What media scatter once along a ray of 6 m, by the midpoint rule.
double scattered_once(const std::vector<LinearBox>& boxes, const std::vector<shared::Light>& lights,
                      const Ray& ray) {
  constexpr int kSteps = 24000;
  const double length = std::min(6.0, double{ray.end}), width = length / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 eye(ray.origin), p = eye + width * (i + 0.5) * glm::dvec3(ray.direction);
    for (const shared::Light& light : lights) {
      const Incident incident = light_at(light, glm::vec3(p));
      const glm::dvec3 source(light.position_world);
      double depth = 0, scattered = 0;
      for (const LinearBox& box : boxes) {
        depth += box.depth(eye, p) + box.depth(p, source);
        scattered += box.extinction(p) * box.albedo *
                     double{shared::henyey_greenstein(static_cast<float>(box.g),
                                                      glm::dot(ray.direction, incident.to_light))};
      }
      sum += scattered * double{incident.irradiance.r} * std::exp(-depth) * width;
    }
  }
  return sum;
}

TEST(NearLightsTest, SingleScatteringIsThatOfIntegration) {
  const scene::Scene nothing;
  const LinearBox even{kMist, 0.8, glm::dvec3(0), 0.9, 0.4}, dense{kMist, 2.5, glm::dvec3(0), 0.9, 0},
      ramp{kMist, 1, {0.3, -0.2, 0.3}, 0.7, -0.3},
      second{{{-0.5f, -2, -0.5f}, {2, 2, 0.8f}}, 1.5, {0, 0.4, 0}, 0.4, 0.8};
  const std::vector<std::vector<LinearBox>> media{{even}, {dense}, {ramp}, {ramp, second}};
  const std::vector<std::vector<shared::Light>> lights{
      {point_at({0.1f, 0.2f, 0.3f})},                             // inside
      {point_at({0.02f, 0.01f, 0.2f})},                           // almost on the ray
      {point_at({0.1f, 1.2f, 0})},                                // before the media
      {spot_at({0.3f, 0, 0.5f}, {-1, 0.2f, -0.4f}, 0.9f, 0.7f)},  // in a cone
      {spot_at({0.2f, 0.1f, 0}, {0, -1, 0}, 0.2f, -0.5f)},        // in a wide one
      {point_at({0.1f, 0.2f, 0.3f}), point_at({-0.4f, 0, -0.8f}, 1), point_at({3, 2, 0}, 9)}};
  for (const auto& boxes : media)
    for (const auto& some : lights) {
      std::vector<std::unique_ptr<Medium>> all;
      for (const LinearBox& box : boxes) all.push_back(box.medium());
      const auto scene = lit_scene(nothing, Media(std::move(all)), some);
      ASSERT_GE(scene->near_lights.size(), 1u);
      // Through all, and from within.
      for (const Ray& ray :
           {ray_towards({0, 0, 3}, {0, 0, -3}), ray_towards({0.5f, -0.3f, 0.7f}, {0, 0.1f, 0})}) {
        const double expected = scattered_once(boxes, some, ray);
        const Mean found = radiance(*scene, ray, 1u << 16, {.max_bounces = 1});
        // Steps of 0.25 mm miss as much at the edges of boxes: less than a thousandth of what a metre gives.
        EXPECT_NEAR(found.value(), expected, 4 * found.error() + 1e-3 * expected)
            << boxes.size() << " " << some[0].position_world.x;
        EXPECT_LT(found.error(), kLooser * 0.05 * expected);
      }
    }
}

/// What an even box scatters exactly twice of a point light inside of it, along a ray through it: over the
/// first place, directions from there, and the second place, by `steps` midpoints each, and as many squared
/// directions. All segments are inside.
double scattered_twice(const LinearBox& box, const shared::Light& light, const Ray& ray, int steps) {
  const auto exit = [&](const glm::dvec3& p, const glm::dvec3& direction) {
    double end = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double face = double{direction[axis] > 0 ? box.box.high[axis] : box.box.low[axis]};
      if (direction[axis] != 0) end = std::min(end, (face - p[axis]) / direction[axis]);
    }
    return end;
  };
  const glm::dvec3 eye(ray.origin), along(ray.direction), source(light.position_world);
  const double end = exit(eye, along), first_step = end / steps;
  const auto phase = [&](double cosine) {
    const double d = 1 + box.g * box.g - 2 * box.g * cosine;
    return (1 - box.g * box.g) / (4 * std::numbers::pi * d * std::sqrt(d));
  };
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = first_step * (i + 0.5);
    const glm::dvec3 first = eye + t * along;
    for (int k = 0; k < steps * steps; ++k) {
      const double z = 2 * (k / steps + 0.5) / steps - 1,
                   turn = 2 * std::numbers::pi * (k % steps + 0.5) / steps, r = std::sqrt(1 - z * z);
      const glm::dvec3 direction(r * std::cos(turn), r * std::sin(turn), z);
      const double length = exit(first, direction), step = length / steps;
      double inner = 0;
      for (int m = 0; m < steps; ++m) {
        const double s = step * (m + 0.5);
        const glm::dvec3 apart = source - (first + s * direction);
        const double d2 = glm::dot(apart, apart), d = std::sqrt(d2);
        inner +=
            phase(glm::dot(direction, apart) / d) / std::max(d2, 0.01) * std::exp(-box.at_zero * (s + d));
      }
      sum += std::exp(-box.at_zero * t) * phase(glm::dot(along, direction)) * inner * step;
    }
  }
  return sum * first_step * 4 * std::numbers::pi / (steps * steps) * std::pow(box.at_zero * box.albedo, 2) *
         double{light.intensity.r};
}

TEST(NearLightsTest, DoubleScatteringIsThatOfIntegration) {
  const scene::Scene nothing;
  for (const auto& box :
       {LinearBox{kMist, 0.7, glm::dvec3(0), 0.9, 0.3}, LinearBox{kMist, 2.5, glm::dvec3(0), 0.9, 0}}) {
    std::vector<std::unique_ptr<Medium>> all;
    all.push_back(box.medium());
    const auto scene = lit_scene(nothing, Media(std::move(all)), {point_at({0.1f, 0.25f, 0.3f})});
    const Ray ray = ray_towards({0.1f, -0.2f, 1.4f}, {0, 0, 0});
    // The error of midpoints falls with the square of their number: what a third less changes is more.
    const double expected = scattered_twice(box, scene->lights[0], ray, 60),
                 uncertain = std::abs(expected - scattered_twice(box, scene->lights[0], ray, 40));
    Mean found;
    for (std::uint32_t i = 0; i < (1u << 19) / kFewer; ++i) {
      Sampler sampler({i & 511u, i >> 9u}, 0);
      found.add(double{trace_path(*scene, ray, {.max_bounces = 2}, sampler).multiple.r});
    }
    EXPECT_NEAR(found.value(), expected, 4 * found.error() + uncertain);
    EXPECT_LT(found.error() + uncertain, kLooser * 0.02 * expected);
  }
}

/// That paths which do not look for near lights find the same; paths of at most so many bounces.
void expect_as_without(Scene& scene, const Ray& ray, std::uint32_t bounces, std::uint32_t samples) {
  ASSERT_FALSE(scene.near_lights.empty());
  const PathLimits limits{.max_bounces = bounces};
  const Mean with = radiance(scene, ray, samples, limits);
  const auto near = std::exchange(scene.near_lights, {});
  const Mean without = radiance(scene, ray, 4 * samples, limits);
  scene.near_lights = near;
  const double error = std::hypot(with.error(), without.error());
  EXPECT_NEAR(with.value(), without.value(), 4 * error) << bounces << " bounces";
  // Of the few samples under a sanitizer, those without may or may not come close to a light.
  if (!kSanitized) {
    EXPECT_LT(error, 0.05 * without.value()) << bounces << " bounces";
  }
}

TEST(NearLightsTest, ManyBouncesGiveTheSame) {
  const scene::Scene nothing;
  for (const float extinction : {0.5f, 4.0f})
    for (const auto& light :
         {point_at({0.1f, 0.2f, 0.9f}), spot_at({0.1f, 0.2f, 0.9f}, {0.2f, -1, 0.3f}, 0.9f, 0.7f)}) {
      std::vector<std::unique_ptr<Medium>> media;
      media.push_back(
          std::make_unique<BoxMedium>(kMist, constant(extinction, 0.8f), shared::phase_of_hg(0.5f)));
      media.push_back(std::make_unique<BoxMedium>(Box<float>{{-0.5f, -0.5f, 0.5f}, {2, 2, 2}},
                                                  constant(1.5f, 0.95f), shared::phase_of_hg(-0.3f)));
      const auto scene = lit_scene(nothing, Media(std::move(media)), {light, point_at({-2, 3, 4}, 2)});
      for (const std::uint32_t bounces : {3u, 1000u})
        expect_as_without(*scene, ray_towards({0.5f, 0.2f, 4}, {0.3f, 0, 0.5f}), bounces, 1u << 16);
    }
}

// A white wall through the media, close to the light: paths are scattered by both.
TEST(NearLightsTest, SurfacesInMediaGiveTheSame) {
  scene::Scene wall = square_at(-0.5f, 3);
  wall.materials[0].base_color = glm::vec3(0.8f);
  for (const float roughness : {1.0f, 0.4f}) {
    wall.materials[0].roughness = roughness;
    const auto scene = lit_scene(
        wall, media_of(std::make_unique<BoxMedium>(kMist, constant(1, 0.9f), shared::phase_of_hg(0.2f))),
        {point_at({0.1f, 0.2f, -0.2f})});
    for (const std::uint32_t bounces : {2u, 1000u})
      expect_as_without(*scene, ray_towards({0.5f, 0.2f, 4}, {0.6f, 0, -0.5f}), bounces, 1u << 16);
    // From outside of the media.
    expect_as_without(*scene, ray_towards({3, 0.2f, 4}, {2, 0, -0.5f}), 1000, 1u << 15);
  }
}

// What is nearer than 5 cm to a light does not hide it.
TEST(NearLightsTest, HousingsGiveTheSame) {
  const scene::Scene bulb = square_at(0.27f, 0.04f);
  const auto scene =
      lit_scene(bulb, media_of(std::make_unique<BoxMedium>(kMist, constant(1, 0.9f), shared::phase_of_hg(0))),
                {point_at({0, 0, 0.3f})});
  expect_as_without(*scene, ray_towards({0.5f, 0.2f, 4}, {0, 0, 0}), 1000, 1u << 15);
  // By integration: behind it, too, there is light; the ray passes beside it.
  const Ray below = ray_towards({0.3f, 0.2f, -4}, {0.1f, 0, 0});
  const LinearBox same{kMist, 1, glm::dvec3(0), 0.9, 0};
  const double expected = scattered_once({same}, scene->lights, below);
  const Mean found = radiance(*scene, below, 1u << 16, {.max_bounces = 1});
  EXPECT_NEAR(found.value(), expected, 4 * found.error() + 1e-3 * expected);
}

TEST(NearLightsTest, MovingMediaGiveTheSame) {
  const scene::Scene nothing;
  auto medium = std::make_unique<BoxMedium>(Box<float>{glm::vec3(-0.6f), glm::vec3(0.6f)}, constant(2, 0.9f),
                                            shared::phase_of_hg(0.3f));
  // Over the light and on.
  medium->set_motion({glm::mat4(1), glm::translate(glm::mat4(1), {0.8f, 0, 0}),
                      glm::translate(glm::mat4(1), {1.6f, 0.2f, 0})});
  const auto scene = lit_scene(nothing, media_of(std::move(medium)), {point_at({0.8f, 0.1f, 0})});
  for (const float time : {0.0f, 0.3f, 0.5f, 1.0f}) {
    Ray ray = ray_towards({0.5f, 0.3f, 4}, {1.6f * time, 0.1f, 0});
    ray.time = time;
    expect_as_without(*scene, ray, 1000, 1u << 15);
  }
}

TEST(NearLightsTest, BouncesAndClampCountAsDocumented) {
  const scene::Scene nothing;
  const auto scene = lit_scene(
      nothing, media_of(std::make_unique<BoxMedium>(kMist, constant(2, 0.9f), shared::phase_of_hg(0))),
      {point_at({0.1f, 0.2f, 0.3f})});
  const Ray ray = ray_towards({0, 0, 4}, {0, 0, 0});
  Mean once, clamped;
  for (std::uint32_t i = 0; i < (1u << 14) / kFewer; ++i) {
    const auto traced = [&](const PathLimits& limits) {
      Sampler sampler({i & 255u, i >> 8u}, 0);
      return trace_path(*scene, ray, limits, sampler);
    };
    const PathSample none = traced({.max_bounces = 0}), one = traced({.max_bounces = 1}),
                     all = traced({.clamp = 1e-6f});
    EXPECT_EQ(none.single + none.multiple, glm::vec3(0));
    EXPECT_EQ(one.multiple, glm::vec3(0));
    // Two things at each of less than 500 bounces.
    EXPECT_LE(all.multiple.r, 1e-3f);
    once.add(double{one.single.r});
    clamped.add(double{all.single.r});
  }
  EXPECT_NEAR(once.value(), clamped.value(), 4 * std::hypot(once.error(), clamped.error()));
  EXPECT_GT(once.value(), 0.1);
}

// Of a path that several techniques make, the weights sum to one.
TEST(LightPathTest, WeightsOfAllTechniquesSumToOne) {
  const shared::Phase phase = shared::phase_of_hg(0.6f);
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    Sampler sampler({trial, 5}, 0);
    // From the eye through the vertices to the light; one may be of a surface.
    const std::size_t count = 1 + trial % 7, surface = trial % 11;
    std::vector<glm::vec3> p(count + 2);
    for (glm::vec3& at : p) at = glm::vec3(sampler.random(), sampler.random(), sampler.random());
    const auto inverse = [&](std::size_t i, std::size_t k) {
      const glm::vec3 apart = p[i] - p[k];
      return 1 / glm::dot(apart, apart);
    };
    // The same from both ends.
    const auto turn = [&](std::size_t i) {
      return shared::phase_value(phase,
                                 glm::dot(glm::normalize(p[i] - p[i - 1]), glm::normalize(p[i + 1] - p[i])));
    };
    const double first = 0.3;
    double sum = 0;
    for (std::size_t from_light = 0; from_light < count; ++from_light) {
      const std::size_t last = count - from_light;
      if (surface > last && surface <= count) continue;
      std::vector<Link> eye, light;
      for (std::size_t i = 1; i <= last; ++i) eye.push_back({i != surface, inverse(i, i - 1), turn(i)});
      for (std::size_t i = count; i > last; --i) light.push_back({true, inverse(i, i + 1), turn(i)});
      // Where both ends meet, each makes the vertex of the other.
      const double to_eye =
          (from_light == 0 ? first : double{turn(last + 1)}) * double{inverse(last, last + 1)};
      double others = other_techniques(eye, std::numeric_limits<double>::infinity(), to_eye,
                                       double{turn(last)}, LightPath::kMostVertices);
      if (from_light > 0)
        others += other_techniques(light, first, double{turn(last)} * double{inverse(last, last + 1)},
                                   double{turn(last + 1)}, LightPath::kMostVertices);
      sum += 1 / (1 + others);
    }
    EXPECT_NEAR(sum, 1, 1e-5) << count << " " << surface;
  }
}

}  // namespace
}  // namespace brume::reference
