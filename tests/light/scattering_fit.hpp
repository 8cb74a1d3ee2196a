// The error of formulas for multiple scattering against random walks, and the fit of shared/scattering.h to
// them.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "shared/scattering.h"
#include "tests/reference/multiple_scattering.hpp"

namespace brume::reference {

/// A formula for a sample: radiance per irradiance after more than one scattering.
using ManyFormula = std::function<double(const ScatteringSample&)>;

/// Root of the mean square of ln((L + l) / (L' + l)), L and L' the whole scattered radiance of the formula
/// and of the walks, l = 0.004 of the irradiance: a tenth of what thin smoke scatters of it, so that
/// nearly black samples have little weight.
double misfit(std::span<const ScatteringSample> samples, const ManyFormula& formula);

/// shared::scattered without single scattering.
double many_of(const shared::ManyFit& fit, const ScatteringSample& sample);
/// Octaves with the usual guess: exp(-depth / 2^i) / 2^i with g / 2^i, i = 1, 2.
double guessed_octaves(const ScatteringSample& sample);
/// The sum over i = 1, 2 of b^i exp(-a^i depth) and Henyey-Greenstein with c^i g.
double octaves(double a, double b, double c, const ScatteringSample& sample);

/// Minimizes the misfit from a starting point by the method of Nelder and Mead 1965.
std::vector<double> minimize(const std::function<double(const std::vector<double>&)>& cost,
                             std::vector<double> start, double step, int iterations);

/// The fit of least misfit.
shared::ManyFit fit_many(std::span<const ScatteringSample> samples);

}  // namespace brume::reference
