#include "spheres/pack_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "spheres/pack_noise.hpp"
#include "spheres/pack_random.hpp"

namespace brume::spheres {
namespace {

constexpr std::uint64_t kPlaceStream = 1, kNoiseStream = 2;

class AnyPlace : public PackPlaces {
 public:
  explicit AnyPlace(const PackOptions& options) : options_(options) {}
  std::optional<PackPlace> propose(const PackTry& what) const override {
    PackRandom random = random_of(what);
    return PackPlace{point(random, what.least)};
  }

 protected:
  PackRandom random_of(const PackTry& what) const {
    return {options_.seed, kPlaceStream, (std::uint64_t{what.slot} << 32) + what.attempt};
  }
  glm::vec3 point(PackRandom& random, float radius) const {
    const glm::dvec3 u = random.unit3();
    return {pack_position(u.x, radius, options_.size.x), pack_position(u.y, radius, options_.size.y),
            pack_position(u.z, radius, options_.size.z)};
  }
  const PackOptions& options_;
};

// Where noise is high; as room runs out there, also where it is lower, but never in its valleys: there caves
// remain.
class HighNoise final : public AnyPlace {
 public:
  explicit HighNoise(const PackOptions& options) : AnyPlace(options) {
    // How high noise is at the places of this tank, which may be smaller than a feature of it.
    constexpr std::uint32_t kSamples = 4096;
    std::vector<double> heights(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      PackRandom random(options.seed, kNoiseStream, i);
      heights[i] = height(feature_of(point(random, options.radius.x)));
    }
    std::sort(heights.begin(), heights.end());
    threshold_ = heights[static_cast<std::size_t>(kSamples * (1 - kFirst))];
    lowest_ = heights[static_cast<std::size_t>(kSamples * (1 - kMost))];
    step_ = (threshold_ - lowest_) / kSteps;
  }
  std::optional<PackPlace> propose(const PackTry& what) const override {
    constexpr int kPoints = 8;
    PackRandom random = random_of(what);
    for (int i = 0; i < kPoints; ++i) {
      const glm::vec3 at = point(random, what.least);
      if (is_high(feature_of(at))) return PackPlace{at};
    }
    return std::nullopt;
  }
  void added(std::uint32_t, const PackPlace&) override { ++added_; }
  void refused(const PackPlace&) override { ++refused_; }
  std::uint32_t most_at_once() override {
    if (refused_ > added_) threshold_ = std::max(threshold_ - step_, lowest_);
    added_ = refused_ = 0;
    return UINT32_MAX;
  }

 private:
  static constexpr double kFirst = 0.2,
                          kMost = 0.65;  // part of the tank's volume at the start and at the end
  static constexpr double kSteps = 32, kDetail = 0.35;
  glm::dvec3 feature_of(const glm::vec3& at) const { return glm::dvec3(at) / double{options_.noise_size}; }
  double coarse(const glm::dvec3& at) const { return gradient_noise(seed_, at); }
  double detail(const glm::dvec3& at) const { return kDetail * gradient_noise(~seed_, 2.0 * at); }
  double height(const glm::dvec3& at) const { return coarse(at) + detail(at); }
  bool is_high(const glm::dvec3& at) const {
    const double low = coarse(at);
    if (std::abs(low - threshold_) > kDetail) return low > threshold_;  // whatever its detail
    return low + detail(at) >= threshold_;
  }

  std::uint64_t seed_ = PackRandom::mix(options_.seed) + kNoiseStream;
  double threshold_ = 0, lowest_ = 0, step_ = 0;
  std::uint32_t added_ = 0, refused_ = 0;  ///< Since it was set.
};

// Growth of coral: tips grow a sphere each, upwards and away from the sphere before, branch at times, and end
// where there is no room. Radii fall while it grows, so that trunks are thick and twigs thin.

constexpr std::uint64_t kGrowthStream = 3;
constexpr std::uint32_t kLeastTips = 16;  // tried at a time
constexpr unsigned kMostRefusals = 12;    // after which a tip ends

/// Seeds have room for trunks between them: this many largest radii along both axes of the floor.
constexpr double kSeedSpacing = 9;

/// Part of the tries that are at tips; the others start a twig at any sphere, mostly at the large ones, which
/// come first.
constexpr double kAtTips = 0.6, kTwigPower = 3;

/// Part of the spheres that end a branch or twig.
constexpr double kEnding = 0.12;

/// Part of the spheres that two grow from.
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
  std::vector<Growth> growth_;       ///< How each sphere grew.
  std::vector<std::uint32_t> tips_;  ///< Spheres that grow.
  bool dirty_ = false;               ///< Whether some of them have ended.
};

}  // namespace

float pack_position(double fraction, float radius, std::uint32_t size) {
  const double high = static_cast<double>(size) - double{radius};
  const auto at = static_cast<float>(double{radius} + fraction * (high - double{radius}));
  // Rounding up may leave the tank. The float below is not under `radius`, which is a float.
  return double{at} > high ? std::nextafter(at, 0.0f) : at;
}

std::unique_ptr<PackPlaces> make_pack_places(const PackOptions& options, const PackLevels& spheres) {
  if (options.arrangement == Arrangement::coral) return std::make_unique<Coral>(options, spheres);
  if (options.arrangement == Arrangement::noise) return std::make_unique<HighNoise>(options);
  return std::make_unique<AnyPlace>(options);
}

}  // namespace brume::spheres
