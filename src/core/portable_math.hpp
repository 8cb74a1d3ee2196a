// Elementary functions with the same bits on every machine: by sums, products, quotients and rounding alone,
// which IEEE 754 defines, where those of C libraries differ in their last bits. Build with -ffp-contract=off.
// Their error is below 10^-14 of the result, of sine and cosine below 10^-15.
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
/// Of an angle in turns, |turns| below 2^31.
SineCosine sine_cosine_of_turns(double turns);

}  // namespace brume::portable
