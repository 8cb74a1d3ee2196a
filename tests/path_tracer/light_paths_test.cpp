// Light paths through glass: what they gather, that they are the same for any number of threads, and the
// caustics of a ball against rays in double.
#include "spheres/light_paths.hpp"

#include "core/tasks.hpp"
#include "tests/path_tracer/tank_caustics.hpp"

namespace brume::reference {
namespace {

using shared::Photon;
using spheres::LightPaths;

glm::vec3 unit_vector(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

TEST(PhotonCells, GatherWhatAllPhotonsTriedGive) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(0, 1);
  const spheres::Sphere ball{{9, 10, 11}, 6};
  std::vector<Photon> photons;
  for (int i = 0; i < 3000; ++i) {
    // Of two spheres at one place: those of the other do not count.
    photons.push_back({ball.center + ball.radius * unit_vector(random), 1u + (i % 3 == 0),
                       glm::vec3(share(random)), shared::packed_direction(unit_vector(random))});
  }
  for (const float radius : {0.3f, 2.0f, 20.0f}) {
    const LightPaths paths = spheres::sort_photons(photons, radius);
    ASSERT_EQ(paths.photons.size(), photons.size());
    EXPECT_EQ(paths.cells.back(), photons.size());
    for (int i = 0; i < 300; ++i) {
      const glm::vec3 at = ball.center + ball.radius * unit_vector(random);
      double expected = 0;
      for (const Photon& photon : photons) {
        if (photon.id != 1 || glm::distance(photon.position, at) > radius) continue;
        const float cosine =
            -glm::dot(glm::normalize(at - ball.center), shared::unpacked_direction(photon.direction));
        expected += double{photon.flux.g * shared::photon_per_area(radius, ball.radius, cosine)};
      }
      // Sums of 2000 floats.
      EXPECT_NEAR(double{paths.gather(at, 0, ball, 0).g}, expected, 1e-4 * expected + 1e-6);
    }
  }
}

TEST(PhotonCells, GiveTheIrradianceOfParallelLight) {
  // At all angles to it, for small and large radii, up to all of the sphere.
  std::mt19937 random(2);
  std::uniform_real_distribution<float> share(0, 1);
  const spheres::Sphere ball{{50, 50, 50}, 5};
  const glm::vec3 to_light = glm::normalize(glm::vec3(1, 2, -1)), side = glm::normalize(glm::vec3(2, -1, 0)),
                  up = glm::cross(side, to_light);
  constexpr std::uint32_t kPhotons = 2000 / kFewer;
  for (const float radius : {1.5f, 5.0f, 8.5f, 11.0f})
    for (const float angle : {0.0f, 0.8f, 1.2f, 1.45f, 1.5f}) {
      Mean mean;
      for (int set = 0; set < 200; ++set) {
        std::vector<Photon> photons;
        for (std::uint32_t i = 0; i < kPhotons; ++i) {
          const float out = std::sqrt(share(random)), turn = 6.2831853f * share(random);
          const glm::vec3 normal =
              out * (std::cos(turn) * side + std::sin(turn) * up) + std::sqrt(1 - out * out) * to_light;
          photons.push_back({ball.center + ball.radius * normal, 1, glm::vec3(1.0f / kPhotons),
                             shared::packed_direction(-to_light)});
        }
        const LightPaths paths = spheres::sort_photons(std::move(photons), radius);
        for (int i = 0; i < 8; ++i) {
          const float turn = 6.2831853f * share(random);
          const glm::vec3 normal =
              std::sin(angle) * (std::cos(turn) * side + std::sin(turn) * up) + std::cos(angle) * to_light;
          mean.add(double{paths.gather(ball.center + ball.radius * normal, 0, ball, 0).g});
        }
      }
      SCOPED_TRACE(testing::Message() << radius << " " << angle);
      // The eight points of a set have photons in common: their errors may add up.
      const double expected = std::cos(double{angle}) / (kPi * 25);
      EXPECT_NEAR(mean.value(), expected, 4 * std::sqrt(8.0) * mean.error() + 2e-4 * expected);
      EXPECT_LT(mean.error(), 0.02 * kLooser * expected);
    }
  // Of all of the sphere, exactly, but for the packing of directions.
  EXPECT_NEAR(shared::photon_per_area(11, 5, 0.5f), 0.5f / (25 * kPi), 1e-8f);
}

TEST(PhotonCells, GiveTheFluenceOfAnEvenMedium) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> share(0, 1);
  const spheres::Sphere ball{{50, 50, 50}, 5};
  constexpr std::uint32_t kPhotons = 2000 / kFewer;
  const auto point = [&] {
    return ball.center + ball.radius * std::cbrt(share(random)) * unit_vector(random);
  };
  for (const float radius : {1.0f, 4.0f, 11.0f}) {
    Mean mean;
    for (int set = 0; set < 200; ++set) {
      std::vector<Photon> photons;
      for (std::uint32_t i = 0; i < kPhotons; ++i)
        photons.push_back({point(), 1, glm::vec3(1.0f / kPhotons), 0});
      const LightPaths paths = spheres::sort_photons(std::move(photons), radius);
      for (int i = 0; i < 8; ++i) mean.add(double{paths.gather(point(), 0, ball, 0.2f).g});
    }
    const double expected = 1 / (4 * kPi / 3 * 125 * 0.2);
    EXPECT_NEAR(mean.value(), expected, 4 * std::sqrt(8.0) * mean.error() + 1e-4 * expected) << radius;
  }
}

TEST(PhotonCells, DirectionsKeepTheirPlaceInABit) {
  std::mt19937 random(5);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 v = i < 6 ? (i % 2 == 0 ? 1.0f : -1.0f) * glm::vec3(i / 2 == 0, i / 2 == 1, i / 2 == 2)
                              : unit_vector(random);
    // Half a step of 1 / 32767 along both coordinates, of which a unit of the sphere is up to three times as
    // long.
    EXPECT_LT(glm::distance(shared::unpacked_direction(shared::packed_direction(v)), v), 1e-4f);
  }
}

TEST(PhotonCells, VolumesOfOverlapsAreThoseOfPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> share(-1, 1);
  for (const glm::vec3 pair : {glm::vec3(1, 3, 2.5f), glm::vec3(2, 2, 0.5f), glm::vec3(3, 1, 1),
                               glm::vec3(5, 2, 1), glm::vec3(0.5f, 4, 4), glm::vec3(2, 2, 0)}) {
    const float radius = pair.x, sphere = pair.y, apart = pair.z;
    Mean mean;
    for (int i = 0; i < 100000; ++i) {
      const glm::vec3 p = radius * glm::vec3(share(random), share(random), share(random));
      const bool in_both = glm::length(p) < radius && glm::distance(p, glm::vec3(apart, 0, 0)) < sphere;
      mean.add(in_both ? 8 * std::pow(double{radius}, 3) : 0);
    }
    EXPECT_NEAR(double{shared::photon_volume(radius, sphere, apart)}, mean.value(), 4 * mean.error() + 1e-6);
  }
}

/// A ball light behind a ball of glass before a tank.
spheres::LightPathScene bright_glass() {
  spheres::LightPathScene scene;
  scene.lights = {{{30, 30, 200}, 10, glm::vec3(3, 2, 1)}, {{60, 90, 150}, 0, glm::vec3(1, 5, 2)}};
  scene.glass = {glm::vec3(30, 30, 70), 1.5f, glm::vec3(25, 20, 25)};
  return scene;
}

TEST(LightPathsTest, AreTheSameForAnyNumberOfThreads) {
  spheres::Tank tank = tank_of({60, 60, 40});
  pack_at_random(tank, 3000, {2, 8}, 200, 60, 6);
  const spheres::BrickLists bricks = list_bricks(tank);
  std::vector<LightPaths> found;
  for (const unsigned threads : {1u, 2u, 7u}) {
    set_thread_count(threads);
    found.push_back(spheres::trace_light_paths(tank, bricks, bright_glass(), {.count = 30000, .seed = 5}));
  }
  set_thread_count(0);
  EXPECT_GT(found[0].photons.size(), 5000u);
  EXPECT_GT(found[0].grid.radius, 0);
  for (const LightPaths& paths : found) {
    ASSERT_EQ(paths.photons.size(), found[0].photons.size());
    EXPECT_EQ(paths.cells, found[0].cells);
    EXPECT_EQ(paths.grid.radius, found[0].grid.radius);
    for (std::size_t i = 0; i < paths.photons.size(); ++i) {
      EXPECT_EQ(paths.photons[i].position, found[0].photons[i].position);
      EXPECT_EQ(paths.photons[i].flux, found[0].photons[i].flux);
      EXPECT_EQ(paths.photons[i].id, found[0].photons[i].id);
    }
  }
  // On their spheres.
  for (const Photon& photon : found[0].photons) {
    const spheres::Sphere& ball = tank.spheres[photon.id - 1];
    const float out = glm::distance(photon.position, ball.center);
    EXPECT_LT(out, ball.radius + 1e-4f);
    if (tank.colors[photon.id - 1] >> 24 == 255) {
      EXPECT_GT(out, ball.radius - 1e-4f);
    }
  }
}

TEST(LightPathsTest, AreNoneWithoutGlassLightsOrPathsAndWhenStopped) {
  spheres::Tank tank = tank_of({60, 60, 40});
  put(tank, {30, 30, 20}, 15, kWhite);
  const spheres::BrickLists bricks = list_bricks(tank);
  const spheres::LightPathScene scene = bright_glass();
  EXPECT_FALSE(spheres::trace_light_paths(tank, bricks, scene, {.count = 5000}).photons.empty());
  EXPECT_TRUE(spheres::trace_light_paths(tank, bricks, scene, {.count = 0}).photons.empty());
  EXPECT_TRUE(spheres::trace_light_paths(tank, bricks, scene, {}, [] { return true; }).photons.empty());
  spheres::LightPathScene dark = scene;
  dark.lights = {{{30, 30, 200}, 10, glm::vec3(0)}};
  EXPECT_TRUE(spheres::trace_light_paths(tank, bricks, dark, {}).photons.empty());
  dark = scene;
  dark.glass.index = 0;
  EXPECT_TRUE(spheres::trace_light_paths(tank, bricks, dark, {}).photons.empty());
  const LightPaths none = spheres::trace_light_paths(tank, bricks, dark, {});
  EXPECT_EQ(none.gather({30, 30, 35}, 0, tank.spheres[0], 0), glm::vec3(0));
}

// ---- a caustic against rays in double
// ----------------------------------------------------------------------------

/// What a point light of intensity 1 sends through a ball of glass to a sphere behind it, both on the axis -z
/// of the light: by rays in a plane, which split at each crossing of the glass.
struct Caustic {
  double flux = 0;      // that arrives
  double off_axis = 0;  // times the distance from the axis where it does
};

struct AxialScene {
  double light, glass, wall;  // places on z
  double glass_radius, wall_radius, index;
};

/// Where a ray first meets a circle around (0, place) from outside; infinite: nowhere.
double circle_at(const glm::dvec2& o, const glm::dvec2& d, double place, double radius) {
  const glm::dvec2 apart = o - glm::dvec2(0, place);
  const double b = glm::dot(apart, d), rest = b * b - glm::dot(apart, apart) + radius * radius;
  if (rest < 0) return std::numeric_limits<double>::infinity();
  const double t = -b - std::sqrt(rest);
  return t > 1e-9 ? t : std::numeric_limits<double>::infinity();
}

void add_arrived(const AxialScene& scene, const glm::dvec2& o, const glm::dvec2& d, double flux,
                 Caustic& sum) {
  const double t = circle_at(o, d, scene.wall, scene.wall_radius);
  if (!std::isfinite(t)) return;
  sum.flux += flux;
  sum.off_axis += flux * std::abs((o + t * d).x);
}

void add_ray(const AxialScene& scene, double angle, double flux, Caustic& sum) {
  glm::dvec2 at(0, scene.light), d(std::sin(angle), -std::cos(angle));
  at += circle_at(at, d, scene.glass, scene.glass_radius) * d;
  glm::dvec2 normal = (at - glm::dvec2(0, scene.glass)) / scene.glass_radius;
  // The angles to the normal are the same at all crossings of a ball.
  const double outside = std::acos(-glm::dot(d, normal)), inside = std::asin(std::sin(outside) / scene.index);
  const double across = std::sin(outside - inside) / std::sin(outside + inside);
  const double along = std::tan(outside - inside) / std::tan(outside + inside);
  const double reflected = 0.5 * (across * across + along * along);
  add_arrived(scene, at, d - 2 * glm::dot(d, normal) * normal, flux * reflected, sum);
  // Refracted: what is along the surface, over the index.
  const glm::dvec2 beside = (d - glm::dot(d, normal) * normal) / scene.index;
  d = beside - std::sqrt(1 - glm::dot(beside, beside)) * normal;
  double rest = flux * (1 - reflected);
  for (int i = 0; i < 60; ++i) {
    at += 2 * scene.glass_radius * std::cos(inside) * d;
    normal = (at - glm::dvec2(0, scene.glass)) / scene.glass_radius;
    const glm::dvec2 out_beside = (d - glm::dot(d, normal) * normal) * scene.index;
    const glm::dvec2 out =
        out_beside + std::sqrt(std::max(0.0, 1 - glm::dot(out_beside, out_beside))) * normal;
    add_arrived(scene, at, out, rest * (1 - reflected), sum);
    rest *= reflected;
    d -= 2 * glm::dot(d, normal) * normal;
  }
}

Caustic caustic_of(const AxialScene& scene) {
  // Over the solid angle of the glass, by the midpoint rule.
  constexpr int kSteps = 100000;
  const double widest = std::asin(scene.glass_radius / (scene.light - scene.glass));
  Caustic sum;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = widest * (i + 0.5) / kSteps;
    add_ray(scene, angle, 2 * kPi * std::sin(angle) * widest / kSteps, sum);
  }
  return sum;
}

TEST(Caustics, HaveTheEnergyAndThePlaceOfRaysInDouble) {
  // A wall: one large sphere, at and behind the focus. The light is on the axis, or the whole scene is
  // turned.
  for (const bool is_turned : {false, true}) {
    const double wall = is_turned ? -500.0 : -260.0;
    const AxialScene axial{300, 100, wall, 40, 220, 1.5};
    const glm::dvec3 axis = is_turned ? glm::normalize(glm::dvec3(0.3, -0.5, 1)) : glm::dvec3(0, 0, 1);
    const glm::dvec3 middle(400, 400, 600);
    const auto place = [&](double z) { return glm::vec3(middle + z * axis); };
    spheres::Tank tank = tank_of({800, 800, 800});
    put(tank, place(axial.wall), static_cast<float>(axial.wall_radius), kWhite);
    spheres::LightPathScene scene;
    scene.lights = {{place(axial.light), 0, glm::vec3(1, 2, 0)}};
    scene.glass = {place(axial.glass), 1.5f, glm::vec3(40)};
    const LightPaths paths =
        spheres::trace_light_paths(tank, list_bricks(tank), scene, {.count = 400000 / kFewer, .seed = 3});
    const Caustic expected = caustic_of(axial);

    // Each photon has the same flux; of the paths that are aimed, the fraction p arrives: the relative
    // error of the flux is below 1 / sqrt(photons).
    const double photons = static_cast<double>(paths.photons.size()), error = 4 / std::sqrt(photons);
    EXPECT_GT(photons, 100000 / kFewer);
    EXPECT_NEAR(paths.flux().r, expected.flux, error * expected.flux);
    EXPECT_NEAR(paths.flux().g, 2 * expected.flux, 2 * error * expected.flux);
    EXPECT_EQ(paths.flux().b, 0);

    // Place.
    Mean off_axis;
    glm::dvec3 centroid(0);
    double spread = 0;
    for (const Photon& photon : paths.photons) {
      const glm::dvec3 apart = glm::dvec3(photon.position) - middle;
      const glm::dvec3 off = apart - glm::dot(apart, axis) * axis;
      off_axis.add(glm::length(off));
      centroid += off / photons;
      spread += glm::dot(off, off) / photons;
    }
    EXPECT_NEAR(off_axis.value(), expected.off_axis / expected.flux, 4 * off_axis.error() + 1e-3);
    EXPECT_LT(glm::length(centroid), 4 * std::sqrt(spread / photons));
    std::printf("flux %.5f of %.5f, off the axis %.3f of %.3f\n", paths.flux().r, expected.flux,
                off_axis.value(), expected.off_axis / expected.flux);
  }
}

TEST(Caustics, OfABallAreNearItsParaxialFocus) {
  // A ball of index n and radius r has the focal length n r / (2 (n - 1)) from its middle (e.g. Hecht,
  // "Optics"): 60 voxels, so that a light 300 away has its image 75 behind the middle. A narrow beam: through
  // a small part of the ball. There the caustic is smallest, but for spherical aberration.
  spheres::Tank tank = tank_of({200, 200, 200});
  put(tank, {100, 100, 20}, 15, kWhite);
  for (float x = 20; x < 200; x += 40)
    for (float y = 20; y < 200; y += 40)
      if (x != 100 || y != 100) put(tank, {x, y, 15}, 14, kWhite);
  spheres::LightPathScene scene;
  // The image on the front of the ball in the middle, z = 35.
  scene.glass = {glm::vec3(100, 100, 110), 1.5f, glm::vec3(40)};
  scene.lights = {{glm::vec3(100, 100, 410), 0, glm::vec3(1)}};
  const LightPaths paths =
      spheres::trace_light_paths(tank, list_bricks(tank), scene, {.count = 200000 / kFewer, .radius = 1});
  const glm::dvec3 near = glm::dvec3(paths.gather({100, 100, 35}, 0, tank.spheres[0], 0));
  // Without glass, it would be I / d^2; the lens gathers rays up to 12 voxels off the axis into less than
  // one: more than 100 times as much.
  EXPECT_GT(near.g, 100 / (375.0 * 375.0));
  // Off the axis by 10 voxels there is far less.
  const glm::vec3 off = glm::vec3(100, 100, 20) + 15.0f * glm::normalize(glm::vec3(10, 0, 11));
  EXPECT_LT(double{paths.gather(off, 0, tank.spheres[0], 0).g}, 0.05 * near.g);
}

TEST(CausticsOfTanks, AreThoseOfTheReference) {
  // As tank_caustics_test.cpp, with fewer samples: what 2 % and four standard errors allow.
  for (const CausticTank kind : {CausticTank::large_balls, CausticTank::media, CausticTank::packed})
    expect_caustic(kind, 8, 40000 / kFewer / 1000 * 1000 + 1000, 50000 / kFewer, 0.04,
                   0.02 + 4 * 0.04 * kLooser);
}

}  // namespace
}  // namespace brume::reference
