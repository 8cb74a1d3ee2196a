// Growth of coral: tips grow a sphere each, upwards and away from the sphere before, branch at times, and end
// where there is no room. Radii fall while it grows, so that trunks are thick and twigs thin.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "spheres/pack_places.hpp"
#include "spheres/pack_random.hpp"

namespace brume::spheres {
namespace {

constexpr std::uint64_t kGrowthStream = 3;
constexpr std::uint32_t kLeastTips = 16;  // tried at a time
constexpr unsigned kMostRefusals = 12;    // after which a tip ends

/// Seeds have room for trunks between them: this many largest radii along both axes of the floor.
constexpr double kSeedSpacing = 9;

/// Of the tries at tips; the others start a twig at any sphere, mostly at the large ones, which come first.
constexpr double kAtTips = 0.6, kTwigPower = 3;

/// Of the spheres, those that end a branch or twig.
constexpr double kEnding = 0.12;

/// Of the spheres, those that two grow from.
constexpr double kBranching = 0.22;

glm::dvec3 random_direction(PackRandom& random) {
  const double z = 2 * random.unit() - 1, angle = 2 * std::numbers::pi * random.unit();
  const double r = std::sqrt(std::max(1 - z * z, 0.0));
  return {r * std::cos(angle), z, r * std::sin(angle)};
}

class Coral final : public PackPlaces {
 public:
  Coral(const PackOptions& options, const PackLevels& spheres) : options_(options), spheres_(spheres) {
    const double spacing = kSeedSpacing * double{options.radius.y};
    const double seeds = options.size.x / spacing * (options.size.z / spacing);
    seeds_ = static_cast<std::uint32_t>(std::clamp(seeds, 1.0, 65536.0));
  }
  bool keeps_radius() const override { return true; }

  std::optional<PackPlace> propose(const PackTry& what) const override {
    PackRandom random(options_.seed, kGrowthStream, (std::uint64_t{what.slot} << 32) + what.attempt);
    if (what.slot < seeds_ || spheres_.count() == 0) return on_floor(random, what.radius);
    return beside(parent(random), random, what.radius);
  }

  void added(std::uint32_t index, const PackPlace& place) override {
    growth_.push_back({place.parent});
    tips_.push_back(index);
    if (place.parent == PackPlace::kNoParent) return;
    Growth& grown = growth_[place.parent];
    const double fate = PackRandom(options_.seed, kGrowthStream + 1, place.parent).unit();
    if (++grown.children >= (fate < kBranching ? 2 : 1)) grown.ended = dirty_ = true;
    if (fate > 1 - kEnding && index > seeds_ * 20) {
      growth_[index].ended = dirty_ = true;
    }
  }

  void refused(const PackPlace& place) override {
    if (place.parent == PackPlace::kNoParent) return;
    Growth& grown = growth_[place.parent];
    if (!grown.ended && ++grown.refusals >= kMostRefusals) grown.ended = dirty_ = true;
  }

  std::uint32_t most_at_once() override {
    if (dirty_) std::erase_if(tips_, [&](std::uint32_t tip) { return growth_[tip].ended; });
    dirty_ = false;
    if (spheres_.count() == 0) return seeds_;
    return std::max(kLeastTips, static_cast<std::uint32_t>(tips_.size()));
  }

 private:
  struct Growth {
    std::uint32_t parent;
    std::uint8_t children = 0, refusals = 0;
    bool ended = false;
  };

  PackPlace on_floor(PackRandom& random, float radius) const {
    const double x = random.unit(), z = random.unit();
    return {{pack_position(x, radius, options_.size.x), radius, pack_position(z, radius, options_.size.z)}};
  }

  std::uint32_t parent(PackRandom& random) const {
    if (!tips_.empty() && random.unit() < kAtTips)
      return tips_[random.below(static_cast<std::uint32_t>(tips_.size()))];
    return static_cast<std::uint32_t>(std::pow(random.unit(), kTwigPower) * spheres_.count());
  }

  glm::dvec3 direction(std::uint32_t parent, PackRandom& random) const {
    const glm::dvec3 up(0, 1, 0), any = random_direction(random);
    const Growth& grown = growth_[parent];
    glm::dvec3 along = up;
    if (grown.parent != PackPlace::kNoParent)
      along = glm::normalize(glm::dvec3(spheres_[parent].center) - glm::dvec3(spheres_[grown.parent].center));
    // A branch leaves sideways, what continues bends a little.
    const glm::dvec3 sum = grown.children > 0 ? any + 0.45 * up + 0.3 * along : along + 0.7 * any + 0.3 * up;
    return glm::length(sum) > 1e-3 ? glm::normalize(sum) : up;
  }

  std::optional<PackPlace> beside(std::uint32_t parent, PackRandom& random, float radius) const {
    const Sphere& from = spheres_[parent];
    // As near as the rounding of centres allows: each coordinate by up to half of the distance of floats
    // there.
    const float most = static_cast<float>(std::max({options_.size.x, options_.size.y, options_.size.z}));
    const double rounding = std::nextafter(most, 2 * most) - most;
    const double distance = double{from.radius} + double{radius} + rounding;
    const glm::vec3 center(glm::dvec3(from.center) + distance * direction(parent, random));
    for (int axis = 0; axis < 3; ++axis)
      if (double{center[axis]} < double{radius} ||
          double{center[axis]} > options_.size[axis] - double{radius})
        return std::nullopt;
    return PackPlace{center, parent};
  }

  const PackOptions& options_;
  const PackLevels& spheres_;
  std::uint32_t seeds_ = 1;
  std::vector<Growth> growth_;       ///< Of each sphere.
  std::vector<std::uint32_t> tips_;  ///< Spheres that grow.
  bool dirty_ = false;               ///< Whether some of them have ended.
};

}  // namespace

std::unique_ptr<PackPlaces> make_pack_coral(const PackOptions& options, const PackLevels& spheres) {
  return std::make_unique<Coral>(options, spheres);
}

}  // namespace brume::spheres
