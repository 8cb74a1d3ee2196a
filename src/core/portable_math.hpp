// Elementary functions that return the same bits on every machine; C libraries differ in the last
// bits. They use only operations that IEEE 754 defines exactly (sums, products, quotients, rounding), and
// need -ffp-contract=off. The relative error is below 10^-14; sine and cosine have an absolute error below
// 10^-15.
#pragma once

namespace brume::portable {

/// e^x; 0 below -708, infinity above 709.
double exp(double x);
/// Natural logarithm of a normal number above 0.
double log(double x);
/// x^y of a normal number above 0.
double pow(double x, double y);

struct SineCosine {
  double sine, cosine;
};
/// Sine and cosine of an angle in turns, |turns| below 2^31.
SineCosine sine_cosine_of_turns(double turns);

}  // namespace brume::portable
