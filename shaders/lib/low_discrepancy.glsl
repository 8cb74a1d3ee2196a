// Points that fill a square or a cube evenly: Sobol's in two dimensions with Owen's scrambling, the functions of
// src/trace/low_discrepancy.hpp, and a lattice in three.
#ifndef LOW_DISCREPANCY_GLSL
#define LOW_DISCREPANCY_GLSL

/// What Owen's nested scrambling does to bits that are reversed, from the lowest bit on: Vegdahl 2021, "Building a
/// Better LK Hash", after Laine and Karras 2011.
uint scrambled_upwards(uint bits, uint seed) {
  bits ^= bits * 0x3d20adeau;
  bits += seed;
  bits *= (seed >> 16u) | 1u;
  bits ^= bits * 0x05526c56u;
  bits ^= bits * 0x53a22864u;
  return bits;
}

/// Sobol's second coordinate of point i, as a fraction of 2^32: Pascal's triangle modulo 2 times the reversed bits
/// of i, by halves (Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact").
uint second_of_sobol(uint i) {
  uint bits = bitfieldReverse(i);
  bits ^= bits << 16u;
  bits ^= (bits & 0x00ff00ffu) << 8u;
  bits ^= (bits & 0x0f0f0f0fu) << 4u;
  bits ^= (bits & 0x33333333u) << 2u;
  bits ^= (bits & 0x55555555u) << 1u;
  return bits;
}

/// Point i of a sequence in [0, 1)^2. Sequences of other seeds come in other orders.
vec2 sobol_point(uint i, uint seed) {
  const uint shuffled = bitfieldReverse(scrambled_upwards(bitfieldReverse(i), seed));
  const uint x = bitfieldReverse(scrambled_upwards(shuffled, seed ^ 0x85ebca6bu));
  const uint y = bitfieldReverse(scrambled_upwards(bitfieldReverse(second_of_sobol(shuffled)), seed ^ 0xc2b2ae35u));
  return vec2(uvec2(x, y) >> 8u) * (1.0 / 16777216.0);
}

/// Point i of a sequence in [0, 1)^3 that is moved by `shift` (Roberts 2018, "The Unreasonable Effectiveness of
/// Quasirandom Sequences").
vec3 lattice_point(uint i, vec3 shift) {
  return fract(shift + float(i) * vec3(0.8191725134, 0.6710436067, 0.5497004779));
}

#endif
