#include "spheres/pack_colors.hpp"

#include <algorithm>
#include <cmath>

#include "core/tasks.hpp"
#include "spheres/pack_noise.hpp"
#include "spheres/pack_random.hpp"

namespace brume::spheres {
namespace {

constexpr std::uint64_t kColorStream = 17, kColorNoiseStream = 18;
/// Part of the palette to both sides: neighbours of the same radius or height differ a little.
constexpr double kSpread = 0.08;
/// Most gradient noise lies within +- this.
constexpr double kNoiseRange = 0.55;

/// Place on the palette, 0 to 1, before the spread.
double palette_place(const PackOptions& options, const Sphere& sphere, std::uint64_t noise_seed) {
  switch (options.coloring) {
    case Coloring::radius: {
      const double range = std::log(double{options.radius.y} / double{options.radius.x});
      return range > 0 ? std::log(double{sphere.radius} / double{options.radius.x}) / range : 0.5;
    }
    case Coloring::height:
      return double{sphere.center.y} / options.size.y;
    case Coloring::noise: {
      const glm::dvec3 at = glm::dvec3(sphere.center) / double{options.noise_size};
      return 0.5 + 0.5 * gradient_noise(noise_seed, at) / kNoiseRange;
    }
    case Coloring::random:
      break;
  }
  return 0.5;
}

}  // namespace

void color_spheres(Tank& tank, const PackOptions& options) {
  const auto opacity = static_cast<Color>(std::lround(options.opacity * 255)) << 24;
  const auto count = static_cast<std::uint32_t>(options.palette.size());
  const std::uint64_t noise_seed = PackRandom(options.seed, kColorNoiseStream, 0).bits();
  tank.colors.assign(tank.spheres.size(), 0xffffff | opacity);
  if (count == 0) return;
  parallel_for(tank.spheres.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      PackRandom random(options.seed, kColorStream, i);
      std::uint32_t index;
      if (options.coloring == Coloring::random) {
        index = random.below(count);
      } else {
        const double place = palette_place(options, tank.spheres[i], noise_seed);
        const double spread = kSpread * (2 * random.unit() - 1);
        index = static_cast<std::uint32_t>(std::clamp(place + spread, 0.0, 1.0) * (count - 1) + 0.5);
      }
      tank.colors[i] = (options.palette[index] & 0xffffff) | opacity;
    }
  });
}

}  // namespace brume::spheres
