#include "surfaces/small_emitters.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "trace/low_discrepancy.hpp"

namespace brume::surfaces {
namespace {

/// How far a piece may reach from its middle [cells]: a larger one is met by enough of a probe's rays nearby.
constexpr float kMostRadius = 8;
constexpr float kFewestSamples = 16, kMostSamples = 256, kSamplesPerCell = 2;
constexpr std::size_t kMostPieces = 4096;
/// From this many radii on, a piece's samples are as important as each other.
constexpr float kFar = 4;
/// A probe stands for its cell: nothing is nearer than this [cells].
constexpr float kNearest = 0.5f;

glm::vec3 middle_of(const Emitter& triangle) {
  return triangle.corner + (triangle.edge_u + triangle.edge_v) / 3.0f;
}

float brightness(const glm::vec3& color) {
  return (color.r + color.g + color.b) / 3;
}

/// Numbers each emitter by the piece that it belongs to: those that corners connect.
std::vector<std::uint32_t> pieces_of(std::span<const Emitter> emitters) {
  std::vector<std::uint32_t> parents(emitters.size());
  std::iota(parents.begin(), parents.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
  };
  std::map<std::tuple<float, float, float>, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < emitters.size(); ++i) {
    const Emitter& e = emitters[i];
    for (const glm::vec3& p : {e.corner, e.corner + e.edge_u, e.corner + e.edge_v}) {
      // A corner is found by differences, which round: to a tenth of a millimetre.
      const glm::vec3 place = glm::round(p * 1e4f);
      const auto [at, is_new] = first_at.try_emplace({place.x, place.y, place.z}, i);
      if (!is_new) parents[root(i)] = root(at->second);
    }
  }
  for (std::uint32_t i = 0; i < parents.size(); ++i) parents[i] = root(i);
  return parents;
}

}  // namespace

SmallEmitters::SmallEmitters(const Surfaces& surfaces, float cell_size)
    : surfaces_(surfaces), cell_size_(cell_size), is_small_(surfaces.emitters().size()) {
  const std::vector<std::uint32_t> pieces = pieces_of(surfaces.emitters());
  std::map<std::uint32_t, std::vector<std::uint32_t>> triangles;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) triangles[pieces[i]].push_back(i);
  for (const auto& [piece, members] : triangles)
    if (pieces_.size() < kMostPieces) add_piece(members);
}

void SmallEmitters::add_piece(std::span<const std::uint32_t> triangles) {
  const std::span<const Emitter> emitters = surfaces_.emitters();
  Piece piece;
  for (const std::uint32_t i : triangles) {
    piece.area += emitters[i].area;
    piece.middle += emitters[i].area * middle_of(emitters[i]);
    piece.power += emitters[i].area * brightness(emitters[i].radiance);
  }
  if (!(piece.area > 0) || !std::isfinite(piece.power)) return;
  piece.middle /= piece.area;
  for (const std::uint32_t i : triangles) {
    const Emitter& e = emitters[i];
    for (const glm::vec3& p : {e.corner, e.corner + e.edge_u, e.corner + e.edge_v})
      piece.radius = std::max(piece.radius, glm::distance(p, piece.middle));
  }
  if (piece.radius > kMostRadius * cell_size_) return;

  for (const std::uint32_t i : triangles) is_small_[i] = true;
  add_samples(triangles, piece);
  pieces_.push_back(piece);
}

/// At equal steps of area.
void SmallEmitters::add_samples(std::span<const std::uint32_t> triangles, Piece& piece) {
  const std::span<const Emitter> emitters = surfaces_.emitters();
  const float faces = piece.area / (cell_size_ * cell_size_);
  piece.first_sample = static_cast<std::uint32_t>(samples_.size());
  piece.samples =
      static_cast<std::uint32_t>(std::clamp(kSamplesPerCell * faces, kFewestSamples, kMostSamples));
  float passed = 0;
  std::size_t at = 0;
  for (std::uint32_t s = 0; s < piece.samples; ++s) {
    const float wanted = (static_cast<float>(s) + 0.5f) / static_cast<float>(piece.samples) * piece.area;
    while (at + 1 < triangles.size() && passed + emitters[triangles[at]].area < wanted)
      passed += emitters[triangles[at++]].area;
    const Emitter& e = emitters[triangles[at]];
    glm::vec2 uv(0x1p-32f * static_cast<float>(trace::reversed_bits(s)),
                 0x1p-32f * static_cast<float>(trace::second_of_sobol(s)));
    if (uv.x + uv.y > 1) uv = 1.0f - uv;
    const glm::vec3 across = glm::cross(e.edge_u, e.edge_v);
    const float length = glm::length(across);
    samples_.push_back({e.corner + uv.x * e.edge_u + uv.y * e.edge_v,
                        length > 0 ? across / length : glm::vec3(0), e.radiance});
  }
}

bool SmallEmitters::contains(const SurfaceHit& hit) const {
  const std::optional<std::uint32_t> emitter = surfaces_.emitter_of(hit);
  return emitter && is_small_[*emitter];
}

/// Calls `use` with what a probe chooses from, in a fixed order: far pieces as a whole, near ones by sample.
template <typename Use>
void SmallEmitters::for_each_choice(glm::vec3 centre_world, Use use) const {
  const float nearest = kNearest * cell_size_;
  const auto squared = [&](glm::vec3 place, float least) {
    const glm::vec3 path = place - centre_world;
    return std::max(glm::dot(path, path), least * least);
  };
  for (const Piece& piece : pieces_) {
    const float share = piece.area / static_cast<float>(piece.samples),
                power = piece.power / static_cast<float>(piece.samples);
    if (squared(piece.middle, nearest) > kFar * kFar * piece.radius * piece.radius) {
      const double weight = double{piece.power} / double{squared(piece.middle, nearest)};
      use(Choice{piece.first_sample, piece.samples, weight, share});
      continue;
    }
    for (std::uint32_t s = piece.first_sample; s < piece.first_sample + piece.samples; ++s)
      use(Choice{s, 1, double{power} / double{squared(samples_[s].position_world, nearest)}, share});
  }
}

void SmallEmitters::find_rays(glm::vec3 centre_world, std::uint32_t phase,
                              std::span<shared::EmitterRay> rays) const {
  std::ranges::fill(rays, shared::EmitterRay{});
  double sum = 0;
  for_each_choice(centre_world, [&](const Choice& choice) { sum += choice.weight; });
  if (!(sum > 0)) return;
  // At equal steps through the sum, so that what is chosen changes little from probe to probe.
  const double step = sum / static_cast<double>(rays.size());
  double passed = 0, wanted = (phase + 0.5) / shared::kProbePhases * step;
  std::size_t next = 0;
  for_each_choice(centre_world, [&](const Choice& choice) {
    for (; next < rays.size() && wanted < passed + choice.weight; wanted += step, ++next) {
      const double within = (wanted - passed) / choice.weight * choice.count;
      const auto sample = std::min(static_cast<std::uint32_t>(std::max(within, 0.0)), choice.count - 1);
      const double area = double{choice.share} * choice.count * step / choice.weight;
      rays[next] = ray_to(choice.first_sample + sample, centre_world, static_cast<float>(area));
    }
    passed += choice.weight;
  });
}

/// `area`: what the sample stands for, over how often it is chosen [m^2].
shared::EmitterRay SmallEmitters::ray_to(std::uint32_t sample, glm::vec3 centre_world, float area) const {
  const shared::EmitterSample& place = samples_[sample];
  const glm::vec3 path = place.position_world - centre_world;
  const float distance = glm::length(path), nearest = kNearest * cell_size_;
  if (!(distance > 0)) return {};
  const glm::vec3 direction = path / distance;
  // Up to just in front of the sample, which is a surface, too.
  if (surfaces_.occluded({centre_world, direction, distance - 1e-3f * std::max(distance, cell_size_)}))
    return {};
  const float cosine = std::abs(glm::dot(place.normal, direction));
  return {sample, area * cosine / std::max(distance * distance, nearest * nearest) / shared::kRaySolidAngle};
}

}  // namespace brume::surfaces
