// Photons against the reference, with samples enough for 2 %: that is four standard errors or more.
#include "tests/path_tracer/tank_caustics.hpp"

namespace brume::reference {
namespace {

constexpr double kKnown = 0.005, kAllowed = 0.02;
constexpr std::uint32_t kRounds = 16, kPathsOfRound = 1200000, kPhotonsOfRound = 1000000;

TEST(CausticsAgainstReference, OfLargeBalls) {
  expect_caustic(CausticTank::large_balls, kRounds, kPathsOfRound, kPhotonsOfRound, kKnown, kAllowed);
}

TEST(CausticsAgainstReference, OfMedia) {
  expect_caustic(CausticTank::media, kRounds, kPathsOfRound, kPhotonsOfRound, kKnown, kAllowed);
}

TEST(CausticsAgainstReference, OfAPackedTank) {
  expect_caustic(CausticTank::packed, kRounds, kPathsOfRound, kPhotonsOfRound, kKnown, kAllowed);
}

}  // namespace
}  // namespace brume::reference
