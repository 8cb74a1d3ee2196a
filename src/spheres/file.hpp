// Files of tanks: .spheres.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Whether a file is one of a tank, by its suffix .spheres in any case.
bool is_tank_file(const std::filesystem::path& path);

/// Reads a tank (docs/reference/formats.md). Fails with bad_input, and one line that names the file, for
/// bytes that are none: truncated, damaged, or with spheres that are not finite or not inside of the tank;
/// with resource_limit for more than the limits of Tank. That spheres do not overlap is not checked.
Result<Tank> load_tank(const std::filesystem::path& path);
/// The same from memory; `name` is the file's in messages.
Result<Tank> parse_tank(std::span<const std::byte> bytes, const std::string& name);

/// The bytes of a file; the same for the same tank.
std::vector<std::byte> tank_bytes(const Tank& tank);
/// Writes a file as a whole or not at all.
Result<void> save_tank(const std::filesystem::path& path, const Tank& tank);

}  // namespace brume::spheres
