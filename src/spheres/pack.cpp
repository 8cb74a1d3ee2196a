// Packing goes in rounds. Each sphere of a round proposes a place, a function of the seed, its number and its
// attempt, and is tested against all that is packed; those that fit are then tested against each other, and
// in the order of their numbers the earlier stay. Both tests use all threads and neither depends on how many.
#include "spheres/pack.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "spheres/pack_colors.hpp"
#include "spheres/pack_levels.hpp"
#include "spheres/pack_places.hpp"
#include "spheres/pack_random.hpp"

namespace brume::spheres {
namespace {

constexpr std::uint64_t kRadiusStream = 16;
constexpr std::size_t kTask = 128;  // spheres of a task

// Attempts for a sphere: with its whole radius, then with less and less, then with the least of all, which
// goes on until the end.
constexpr std::uint32_t kWhole = 24, kShrinking = 24, kLeast = 8;

// Spheres of a round: a part of all that are packed, since spheres of one round do not make room for each
// other.
constexpr std::uint32_t kLeastRound = 64, kMostRound = 16384;

// The end: while this many spheres found room or used up all attempts above, less than one in kWorthwhile
// found room.
constexpr std::uint32_t kJudged = 4096, kWorthwhile = 16;

struct Candidate {
  std::uint32_t slot = 0, attempt = 0;
  PackPlace place;
  float radius = 0;  ///< 0: there is no room.
  bool proposed = false;
};

/// The quantile of the power law: a fraction `u` of all spheres has radii up to this.
float radius_at(const PackOptions& options, double u) {
  const double low = double{options.radius.x}, ratio = double{options.radius.y} / low;
  const double power = 1 - double{options.distribution};
  const double factor =
      std::abs(power) < 1e-6 ? std::pow(ratio, u) : std::pow(1 + u * (std::pow(ratio, power) - 1), 1 / power);
  return std::clamp(static_cast<float>(low * factor), options.radius.x, options.radius.y);
}

float radius_of_slot(const PackOptions& options, std::uint32_t slot) {
  const double u = PackRandom(options.seed, kRadiusStream, slot).unit();
  if (options.arrangement == Arrangement::random) return radius_at(options, u);
  // One in each equal part of all fractions: in order without sorting.
  return radius_at(options, (options.count - 1.0 - slot + u) / options.count);
}

/// The least radius that an attempt accepts: the whole, then falling geometrically to the least of all.
float least_of_attempt(const PackOptions& options, float radius, std::uint32_t attempt) {
  if (attempt < kWhole) return radius;
  if (attempt >= kWhole + kShrinking) return options.radius.x;
  const double part = (attempt - kWhole + 1.0) / kShrinking;
  const double least = radius * std::pow(double{options.radius.x} / radius, part);
  return std::clamp(static_cast<float>(least), options.radius.x, radius);
}

/// The radius that the tank's sides leave a sphere.
double room_of_sides(const glm::dvec3& at, const glm::uvec3& size) {
  const glm::dvec3 sides = glm::min(at, glm::dvec3(size) - at);
  return std::min({sides.x, sides.y, sides.z});
}

float rounded_down(double radius) {
  const auto rounded = static_cast<float>(radius);
  return double{rounded} > radius ? std::nextafter(rounded, 0.0f) : rounded;
}

class Packing {
 public:
  Packing(const PackOptions& options, const std::function<bool()>& stopped)
      : options_(options),
        stopped_(stopped),
        spheres_(options.size, options.radius.y, options.count),
        places_(make_pack_places(options, spheres_)),
        progress_("pack spheres", options.count) {}

  Tank run() {
    while (!is_stopped_ && fill_round()) {
      find_room();
      if (is_stopped_) break;
      commit();
      if (is_full_) break;
    }
    return tank();
  }

 private:
  /// Fills the round up with spheres that were not tried yet. False if it stays empty.
  bool fill_round() {
    const std::uint32_t most = places_->most_at_once();
    const std::uint32_t size = std::min(std::clamp(spheres_.count() / 4, kLeastRound, kMostRound), most);
    while (round_.size() < size && next_slot_ < options_.count)
      round_.push_back({next_slot_++, 0, {}, 0, false});
    active_ = std::min<std::size_t>(round_.size(), size);
    return !round_.empty();
  }

  void try_candidate(Candidate& candidate) const {
    const float radius = radius_of_slot(options_, candidate.slot);
    PackTry what{candidate.slot, candidate.attempt, radius,
                 least_of_attempt(options_, radius, candidate.attempt)};
    if (places_->keeps_radius()) what.radius = what.least;
    candidate.radius = 0;
    const auto place = places_->propose(what);
    candidate.proposed = place.has_value();
    if (!place) return;
    candidate.place = *place;
    const glm::dvec3 center(place->center);
    const double most = std::min(double{what.radius}, room_of_sides(center, options_.size));
    if (most < double{what.least}) return;
    const float room = rounded_down(spheres_.room(center, most, double{what.least}));
    if (room >= options_.radius.x) candidate.radius = room;
  }

  void find_room() {
    parallel_for(active_, kTask, [&](std::size_t begin, std::size_t end) {
      if (is_stopped_ || (stopped_ && stopped_())) {
        is_stopped_ = true;
        return;
      }
      for (std::size_t i = begin; i < end; ++i) try_candidate(round_[i]);
    });
  }

  /// Which of the spheres that found room overlap an earlier sphere of this round, by their numbers in it.
  std::vector<bool> refused_by_round(std::uint32_t first) const {
    // All pairs that overlap.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // later, earlier
    std::mutex mutex;
    parallel_for(spheres_.count() - first, kTask, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> found;
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t later = first + static_cast<std::uint32_t>(i);
        found.clear();
        spheres_.overlaps(later, first, found);
        if (found.empty()) continue;
        const std::lock_guard lock(mutex);
        for (const std::uint32_t earlier : found) pairs.emplace_back(later - first, earlier - first);
      }
    });

    // Refuse them in order: a refused sphere is in nobody's way.
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> refused(spheres_.count() - first);
    for (const auto& [later, earlier] : pairs)
      if (!refused[earlier]) refused[later] = true;
    return refused;
  }

  void commit() {
    // Insert what fits, as if there were no others.
    const std::uint32_t first = spheres_.count();
    for (std::size_t i = 0; i < active_; ++i)
      if (round_[i].radius > 0) spheres_.push({round_[i].place.center, round_[i].radius});
    const std::vector<bool> refused = refused_by_round(first);
    while (spheres_.count() > first) spheres_.pop();

    // Keep what stays, and what is to be tried again.
    std::size_t number = 0, kept = 0;
    for (std::size_t i = 0; i < round_.size(); ++i) {
      Candidate& candidate = round_[i];
      if (i >= active_) {
        round_[kept++] = candidate;
        continue;
      }
      if (candidate.radius > 0 && !refused[number++]) {
        spheres_.push({candidate.place.center, candidate.radius});
        places_->added(spheres_.count() - 1, candidate.place);
        continue;
      }
      if (candidate.proposed) places_->refused(candidate.place);
      if (++candidate.attempt % (kWhole + kShrinking + kLeast) == 0) ++vain_;
      round_[kept++] = candidate;
    }
    round_.resize(kept);
    progress_.advance(spheres_.count() - first);
    judge(spheres_.count() - first);
  }

  void judge(std::uint32_t added) {
    added_ += added;
    if (added_ + vain_ < kJudged) return;
    is_full_ = added_ * kWorthwhile < vain_;
    added_ = vain_ = 0;
  }

  Tank tank() const {
    Tank tank{options_.size, options_.voxel, {}, {}};
    tank.spheres.resize(spheres_.count());
    for (std::size_t i = 0; i < tank.spheres.size(); ++i)
      tank.spheres[i] = spheres_[static_cast<std::uint32_t>(i)];
    color_spheres(tank, options_);
    return tank;
  }

  const PackOptions& options_;
  const std::function<bool()>& stopped_;
  PackLevels spheres_;
  std::unique_ptr<PackPlaces> places_;
  Progress progress_;
  std::vector<Candidate> round_;  ///< What is tried, in the order of slots.
  std::size_t active_ = 0;        ///< How many of `round_` this round tries.
  std::uint32_t next_slot_ = 0, added_ = 0, vain_ = 0;
  std::atomic<bool> is_stopped_{false};
  bool is_full_ = false;
};

}  // namespace

Result<Tank> pack(const PackOptions& options, const std::function<bool()>& stopped) {
  if (const auto checked = check_options(options); !checked) return checked.failure();
  return Packing(options, stopped).run();
}

}  // namespace brume::spheres
