#include "planning/transfer_table.hpp"

namespace brume::planning {
namespace {

glm::dvec3 color_of(const TransferInput& transfer, glm::vec3 albedo, double at) {
  return transfer.color_map.empty() ? glm::dvec3(albedo) : scene::color_at(transfer.color_map, at);
}

double opacity_of(const TransferInput& transfer, double at) {
  return transfer.opacity.empty() ? 1 : scene::opacity_at(transfer.opacity, at);
}

double integral_of(const TransferInput& transfer, double at) {
  return transfer.opacity.empty() ? at : scene::opacity_integral(transfer.opacity, at);
}

}  // namespace

std::uint32_t transfer_kind(const TransferInput& transfer) {
  if (transfer.empty()) return shared::kTransferNone;
  return transfer.opacity.empty() ? shared::kTransferColors : shared::kTransferOpacity;
}

shared::VolumeTransfer device_transfer(const TransferInput& transfer) {
  shared::VolumeTransfer device{};
  const double length = double{transfer.range.y} - double{transfer.range.x};
  device.per_value = static_cast<float>(1 / length);
  device.first = static_cast<float>(-double{transfer.range.x} / length);
  device.scattered = 1 - transfer.glow;
  device.emitted = transfer.glow * transfer.emission;
  return device;
}

std::vector<glm::vec4> transfer_table(const TransferInput& transfer, glm::vec3 albedo) {
  const auto at_end = [&](double at) {
    const double opacity = opacity_of(transfer, at);
    return glm::vec4(glm::dvec4(opacity * color_of(transfer, albedo, at), opacity));
  };
  std::vector<glm::vec4> table{at_end(0)};
  // A cell has one colour, from its middle.
  glm::dvec4 sum(0);
  table.emplace_back(sum);
  for (std::uint32_t cell = 0; cell < shared::kTransferCells; ++cell) {
    const double end = (cell + 1.0) / shared::kTransferCells;
    const double opacity = integral_of(transfer, end) - sum.a;
    const glm::dvec3 color = color_of(transfer, albedo, (cell + 0.5) / shared::kTransferCells);
    sum += glm::dvec4(opacity * color, opacity);
    table.emplace_back(sum);
  }
  table.push_back(at_end(1));
  return table;
}

glm::vec3 mean_color(const TransferInput& transfer, glm::vec3 albedo) {
  constexpr int kSamples = 64;
  glm::dvec3 sum(0), plain(0);
  double opacities = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double at = (i + 0.5) / kSamples, opacity = opacity_of(transfer, at);
    const glm::dvec3 color = color_of(transfer, albedo, at);
    sum += opacity * color;
    plain += color;
    opacities += opacity;
  }
  return glm::vec3(opacities > 0 ? sum / opacities : plain / double{kSamples});
}

}  // namespace brume::planning
