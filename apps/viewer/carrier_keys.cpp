#include "apps/viewer/carrier_keys.hpp"

#include <algorithm>
#include <cmath>

#include "apps/viewer/session.hpp"

namespace brume::viewer {

std::optional<std::size_t> key_of_time(const scene::Carrier& carrier, double seconds) {
  const auto apart = [&](const scene::CarrierKey& key) { return std::abs(key.time - seconds); };
  const auto nearest = std::ranges::min_element(carrier.keys, {}, apart);
  // The session begins a tick after a key at time 0.
  if (nearest == carrier.keys.end() || apart(*nearest) > Session::kTick) return std::nullopt;
  return static_cast<std::size_t>(nearest - carrier.keys.begin());
}

void set_key(scene::Carrier& carrier, const scene::CarrierKey& pose) {
  if (const auto present = key_of_time(carrier, pose.time)) {
    scene::CarrierKey& key = carrier.keys[*present];
    key = {key.time, pose.position_world, pose.rotation};
    return;
  }
  const auto after =
      std::ranges::find_if(carrier.keys, [&](const scene::CarrierKey& key) { return key.time > pose.time; });
  carrier.keys.insert(after, pose);
}

bool remove_key(scene::Carrier& carrier, double seconds) {
  const auto present = key_of_time(carrier, seconds);
  if (!present || carrier.keys.size() == 1) return false;
  carrier.keys.erase(carrier.keys.begin() + static_cast<std::ptrdiff_t>(*present));
  return true;
}

std::optional<double> key_time_before(const scene::Carrier& carrier, double seconds) {
  const auto present = key_of_time(carrier, seconds);
  std::optional<double> time;
  for (std::size_t i = 0; i < carrier.keys.size(); ++i)
    if (carrier.keys[i].time < seconds && i != present) time = carrier.keys[i].time;
  return time;
}

std::optional<double> key_time_after(const scene::Carrier& carrier, double seconds) {
  const auto present = key_of_time(carrier, seconds);
  for (std::size_t i = 0; i < carrier.keys.size(); ++i)
    if (carrier.keys[i].time > seconds && i != present) return carrier.keys[i].time;
  return std::nullopt;
}

}  // namespace brume::viewer
