#include "planning/transfer_table.hpp"

#include <gtest/gtest.h>

namespace brume::planning {
namespace {

TEST(TransferTable, HoldsTheIntegralsOfTheCurves) {
  const TransferInput transfer{
      {{0.2f, 0}, {0.6f, 1}, {0.6f, 0.25f}, {1, 0.5f}}, {"", {{0, {1, 0, 0}}, {1, {0, 0, 1}}}}, {0, 1}, 0, 1};
  const std::vector<glm::vec4> table = transfer_table(transfer, glm::vec3(0.5f));
  ASSERT_EQ(table.size(), shared::kTransferEntries);
  EXPECT_EQ(table.front(), glm::vec4(0));
  EXPECT_EQ(table[1], glm::vec4(0));
  EXPECT_EQ(table.back(), glm::vec4(0, 0, 0.5f, 0.5f));
  for (std::uint32_t cell = 0; cell <= shared::kTransferCells; cell += 64) {
    const double at = double(cell) / shared::kTransferCells;
    EXPECT_NEAR(double{table[1 + cell].a}, scene::opacity_integral(transfer.opacity, at), 1e-7);
  }
  // The colour (1 - x, 0, x), weighted by opacity.
  double blue = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i)
    blue += (i + 0.5) / kSteps * scene::opacity_at(transfer.opacity, (i + 0.5) / kSteps) / kSteps;
  // The colour of a cell is that of its middle: off by half a cell where the opacity varies within it.
  EXPECT_NEAR(double{table[1 + shared::kTransferCells].b}, blue, 1e-3);
  EXPECT_EQ(table[1 + shared::kTransferCells].g, 0);
}

TEST(TransferTable, AConstantColourIsThatOfAnyPart) {
  const TransferInput transfer{{{0, 0}, {1, 1}}, {}, {0, 1}, 0, 1};
  const glm::vec3 albedo(0.9f, 0.4f, 0.1f);
  const auto table = transfer_table(transfer, albedo);
  for (std::size_t i = 2; i < table.size(); ++i)
    EXPECT_LT(glm::length(glm::vec3(table[i]) / table[i].a - albedo), 1e-6f) << i;
  EXPECT_LT(glm::length(mean_color(transfer, albedo) - albedo), 1e-6f);
}

TEST(TransferTable, ValuesHavePositionsInTheRange) {
  TransferInput transfer;
  EXPECT_EQ(transfer_kind(transfer), shared::kTransferNone);
  transfer.glow = 0.25f;
  transfer.emission = 8;
  transfer.range = {2, 6};
  const shared::VolumeTransfer device = device_transfer(transfer);
  EXPECT_EQ(transfer_kind(transfer), shared::kTransferColors);
  EXPECT_EQ(2 * device.per_value + device.first, 0);
  EXPECT_EQ(6 * device.per_value + device.first, 1);
  EXPECT_EQ(device.scattered, 0.75f);
  EXPECT_EQ(device.emitted, 2);
  transfer.opacity = {{0, 0}, {1, 1}};
  EXPECT_EQ(transfer_kind(transfer), shared::kTransferOpacity);
}

}  // namespace
}  // namespace brume::planning
