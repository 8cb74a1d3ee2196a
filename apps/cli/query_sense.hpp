// `brume query --sense`: what an eye sees in a tank.
#pragma once

#include <string>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/outputs.hpp"

namespace brume::cli {

struct SenseOptions {
  std::string input;   ///< A tank (.spheres), or a scene of one.
  std::string eye;     ///< As parse_camera takes it; empty: no sensing.
  std::string size;    ///< Rays across and down; empty: 16x9.
  std::string output;  ///< .exr or .png; empty: none.
  std::string json;
};

/// Declares --sense, --size and -o.
void declare_sense(const Arguments& arguments, SenseOptions& options);

/// Casts the rays and writes what they meet. Throws Error.
void sense_tank(const SenseOptions& options, Outputs& outputs);

}  // namespace brume::cli
