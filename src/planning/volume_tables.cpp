#include "planning/volume_tables.hpp"

#include <glm/gtc/packing.hpp>

#include "planning/blackbody.hpp"
#include "planning/transfer_table.hpp"

namespace brume::planning {

GlowTable glow_table(const HeatInput& heat) {
  GlowTable table;
  for (std::uint32_t i = 0; i < shared::kVolumeColors; ++i) {
    const float value = heat.high * static_cast<float>(i) / static_cast<float>(shared::kVolumeColors - 1);
    const glm::vec3 color = heat.emission * blackbody_color(heat.kelvin * value);
    table.push_back(glm::packHalf4x16(glm::vec4(glm::min(color, 65000.0f), 0)));
  }
  return table;
}

std::span<const VolumeTables> VolumeTableCache::update(std::span<const VolumeInput> volumes) {
  sources_.resize(volumes.size());
  tables_.resize(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    Source& source = sources_[i];
    VolumeTables& tables = tables_[i];
    // What heat emits.
    const HeatInput& heat = volumes[i].heat;
    const glm::vec3 heat_source(heat.kelvin, heat.high, heat.emission);
    if (!heat.volume && !heat.preview) {
      tables.glow = nullptr;
    } else if (!tables.glow || source.heat != heat_source) {
      tables.glow = std::make_shared<GlowTable>(glow_table(heat));
      source.heat = heat_source;
    }

    // The transfer function.
    const TransferInput& transfer = volumes[i].transfer;
    const glm::vec3 albedo = volumes[i].look.albedo;
    if (transfer.empty()) {
      tables.transfer = nullptr;
    } else if (!tables.transfer || source.albedo != albedo || source.transfer != transfer) {
      TransferInput own = transfer;
      tables.transfer = std::make_shared<TransferTable>(transfer_table(transfer, albedo));
      source.transfer = std::move(own);
      source.albedo = albedo;
    }
  }
  return tables_;
}

}  // namespace brume::planning
