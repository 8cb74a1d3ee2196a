#include "reference/emission_cells.hpp"

#include <algorithm>

#include "reference/medium.hpp"

namespace brume::reference {
namespace {

/// The power of a cell, from eight points of it: exact enough, since it only guides.
float power_of(const Medium& medium, std::uint32_t cell) {
  float power = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 at = 0.25f + 0.5f * glm::vec3(i & 1, i >> 1 & 1, i >> 2);
    const glm::vec3 emission = medium.emission(medium.majorants().world_point(cell, at));
    power += std::max({emission.r, emission.g, emission.b});
  }
  return power;
}

}  // namespace

EmissionCells::EmissionCells(std::span<const Medium* const> media) {
  // Power of each cell that may emit.
  double whole = 0;
  std::vector<float> powers;
  for (const Medium* medium : media) {
    const Majorants& majorants = medium->majorants();
    const auto index = static_cast<std::uint32_t>(media_.size());
    media_.push_back({medium, std::vector<float>(majorants.count())});
    Lit& lit = media_.back();
    for (std::uint32_t cell = 0; cell < majorants.count(); ++cell) {
      if (!(majorants.bound(cell) > 0)) continue;
      const float power = power_of(*medium, cell);
      if (!(power > 0)) continue;
      lit.density[cell] = power;
      cells_.push_back({index, cell});
      powers.push_back(power * majorants.cell_volume());
      whole += double{powers.back()};
    }
  }

  // The whole is 1.
  double sum = 0;
  for (const float power : powers) {
    sum += double{power} / whole;
    power_up_to_.push_back(static_cast<float>(sum));
  }
  for (Lit& lit : media_)
    for (float& density : lit.density) density = static_cast<float>(double{density} / whole);
}

glm::vec3 EmissionCells::sample(float time, Sampler& sampler) const {
  const auto chosen = std::ranges::upper_bound(power_up_to_, sampler.next_1d());
  const auto i =
      std::min<std::size_t>(static_cast<std::size_t>(chosen - power_up_to_.begin()), cells_.size() - 1);
  const glm::vec2 across = sampler.next_2d();
  const Medium& medium = *media_[cells_[i].medium].medium;
  return medium.world_from_rest(medium.majorants().world_point(cells_[i].cell, {across, sampler.random()}),
                                time);
}

float EmissionCells::direction_density(const Ray& ray) const {
  double sum = 0;
  for (const Lit& lit : media_)
    lit.medium->majorants().traverse_cells(
        lit.medium->at_rest(ray), [&](float begin, float end, std::uint32_t cell) {
          const double from = double{begin}, to = double{end};
          if (lit.density[cell] > 0)
            sum += double{lit.density[cell]} * (to * to * to - from * from * from) / 3;
          return false;
        });
  return static_cast<float>(sum);
}

}  // namespace brume::reference
