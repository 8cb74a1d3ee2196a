#include "core/portable_math.hpp"

#include <cmath>
#include <limits>

namespace brume::portable {
namespace {

// ln 2 in two parts: multiples of the first up to 2^11 are exact.
constexpr double kLn2 = 0x1.62e42fefa39efp-1, kLn2High = 0x1.62e42fefap-1, kLn2Low = 0x1.cf79abc9e3b39p-40;

/// 1 - x / (a (a + 1)) (1 - x / ((a + 2) (a + 3)) (1 - ...)), a = first: the series of sine and cosine.
double alternating(double square, int first, int terms) {
  double sum = 1;
  for (int i = terms - 1; i >= 0; --i) {
    const int a = first + 2 * i;
    sum = 1 - square / (a * (a + 1)) * sum;
  }
  return sum;
}

}  // namespace

double exp(double x) {
  if (x < -708) return 0;
  if (x > 709) return std::numeric_limits<double>::infinity();
  // e^x = 2^k e^r, |r| <= ln 2 / 2, of which 14 terms of the power series leave less than 10^-17.
  const double k = std::floor(x / kLn2 + 0.5), r = x - k * kLn2High - k * kLn2Low;
  double sum = 1;
  for (int i = 14; i >= 1; --i) sum = 1 + r / i * sum;
  return std::ldexp(sum, static_cast<int>(k));
}

double log(double x) {
  // x = 2^e m, m in [sqrt(1/2), sqrt(2)]; ln m = 2 artanh s, s = (m - 1) / (m + 1), whose square is below
  // 0.0295.
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < 0.70710678118654752) {
    m *= 2;
    --e;
  }
  const double s = (m - 1) / (m + 1), square = s * s;
  double sum = 0;
  for (int i = 23; i >= 1; i -= 2) sum = 1.0 / i + square * sum;
  return e * kLn2High + (e * kLn2Low + 2 * s * sum);
}

double pow(double x, double y) {
  return exp(y * log(x));
}

SineCosine sine_cosine_of_turns(double turns) {
  // From the nearest quarter of a turn: |angle| <= pi / 4, of which ten terms leave less than 10^-20.
  const double quarters = std::floor(4 * turns + 0.5);
  const double angle = 0x1.921fb54442d18p+0 * (4 * turns - quarters), square = angle * angle;
  const double sine = angle * alternating(square, 2, 10), cosine = alternating(square, 1, 10);
  const double fourths = quarters - 4 * std::floor(quarters / 4);
  if (fourths == 0) return {sine, cosine};
  if (fourths == 1) return {cosine, -sine};
  if (fourths == 2) return {-sine, -cosine};
  return {-cosine, sine};
}

}  // namespace brume::portable
