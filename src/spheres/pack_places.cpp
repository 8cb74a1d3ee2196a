#include "spheres/pack_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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
  static constexpr double kFirst = 0.2, kMost = 0.65;  // of the tank's volume: at the start and at the end
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

}  // namespace

float pack_position(double fraction, float radius, std::uint32_t size) {
  const double high = static_cast<double>(size) - double{radius};
  const auto at = static_cast<float>(double{radius} + fraction * (high - double{radius}));
  // Rounding up may leave the tank. The float below is not under `radius`, which is a float.
  return double{at} > high ? std::nextafter(at, 0.0f) : at;
}

std::unique_ptr<PackPlaces> make_pack_places(const PackOptions& options, const PackLevels& spheres) {
  if (options.arrangement == Arrangement::coral) return make_pack_coral(options, spheres);
  if (options.arrangement == Arrangement::noise) return std::make_unique<HighNoise>(options);
  return std::make_unique<AnyPlace>(options);
}

}  // namespace brume::spheres
