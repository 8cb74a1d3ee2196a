// The constants of shared/scattering.h are those that the fit finds. Prints them, and how formulas compare.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/light/scattering_fit.hpp"

namespace brume::reference {
namespace {

TEST(ScatteringFit, HasTheLeastMisfit) {
  const auto samples = scattering_samples({0, 0.3, 0.6, 0.85}, {0.8, 0.9, 0.99, 1}, 5000, 1);
  const auto of = [&](const shared::ManyFit& fit) {
    return misfit(samples, [&](const ScatteringSample& s) { return many_of(fit, s); });
  };
  const shared::ManyFit found = fit_many(samples), shipped = shared::many_fit();
  const auto print = [&](const char* name, const shared::ManyFit& f) {
    std::printf(
        "%s decay %.3f held %.3f share %.3f share_g %.3f closure %.3f even %.3f even_g %.3f: misfit %.4f\n",
        name, double{f.decay}, double{f.held}, double{f.scale}, double{f.scale_g}, double{f.closure},
        double{f.even}, double{f.even_g}, of(f));
  };
  print("found:  ", found);
  print("shipped:", shipped);
  const auto abc = minimize(
      [&](const std::vector<double>& p) {
        if (p[0] < 0 || p[1] < 0 || p[2] < 0 || p[2] >= 1) return 1e9;
        return misfit(samples, [&](const ScatteringSample& s) { return octaves(p[0], p[1], p[2], s); });
      },
      {0.5, 0.5, 0.5}, 0.2, 200);
  const double best_octaves =
      misfit(samples, [&](const ScatteringSample& s) { return octaves(abc[0], abc[1], abc[2], s); });
  std::printf("octaves: guessed %.4f; fitted, a %.3f b %.3f c %.3f: %.4f\n", misfit(samples, guessed_octaves),
              abc[0], abc[1], abc[2], best_octaves);
  double noise = 0;
  for (const ScatteringSample& s : samples) {
    const double relative = s.error / (s.once + s.more + 0.004 * s.irradiance);
    noise += relative * relative / static_cast<double>(samples.size());
  }
  std::printf("noise of the samples: %.4f\n", std::sqrt(noise));
  EXPECT_LT(of(shipped), 1.01 * of(found));
  EXPECT_LT(of(shipped), 0.5 * best_octaves);
}

// A beam through a round hole: the formula, which knows only whether a point is lit, against walks on the
// axis and beside the beam, where the formula gives no light. Prints the table of docs/how/light.md.
TEST(ScatteringFit, TreatsEveryBeamAsAWideOne) {
  const Body body{Body::Shape::box, 4};
  const std::vector<double> albedos{0.5, 0.9, 0.99};
  std::vector<double> narrowest, widest;
  for (const double beam : {0.1, 0.3, 1.0, 3.0, 10.0}) {
    const BodyLight light{true, {0, 0, 1}, {}, beam};
    const glm::dvec3 on_axis{0, 0, -2.5}, out{1, 0, 0}, beside = on_axis + glm::dvec3(0, beam + 0.3, 0);
    const auto inside = walk_light(body, light, 0.3, albedos, on_axis, out, 60000, 7);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const ScatteringSample& s = inside[i];
      const double ratio = (s.once + many_of(shared::many_fit(), s)) / (s.once + s.more);
      std::printf("beam %4.1f albedo %.2f: formula / walks %.2f", beam, s.albedo, ratio);
      if (body.contains(beside)) {
        const auto there = walk_light(body, light, 0.3, albedos, beside, out, 60000, 8);
        std::printf("; beside it walks are %.3f of inside", there[i].more / (s.once + s.more));
        EXPECT_EQ(there[i].once, 0);
      }
      std::printf("\n");
      EXPECT_LT(s.error, 0.02 * (s.once + s.more));
      if (beam == 0.1) narrowest.push_back(s.more);
      if (beam == 10.0) {
        widest.push_back(s.more);
        EXPECT_NEAR(std::log(ratio), 0, 0.26) << "the fit's misfit where all is lit";
      }
    }
  }
  for (std::size_t i = 0; i < albedos.size(); ++i) EXPECT_LT(narrowest[i], widest[i]);
}

}  // namespace
}  // namespace brume::reference
