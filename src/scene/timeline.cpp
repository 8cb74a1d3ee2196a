#include "scene/timeline.hpp"

#include <algorithm>

namespace brume::scene {

void sort_events(Timeline& timeline) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
  for_each_event_list(
      timeline, [&](const char*, auto& events) { std::stable_sort(events.begin(), events.end(), earlier); });
}

}  // namespace brume::scene
