// Descriptions of volumes as JSON: untrusted objects and the values in them. Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.hpp"

namespace brume::grids {

/// Keys in the order of the file.
using Json = nlohmann::ordered_json;

/// Reads a file of one object, of at most 1 MiB and a few levels. Fails with bad_input.
Result<Json> read_json_object(const std::filesystem::path& path);

/// The failure of a file with such a description.
Failure bad_description(const std::filesystem::path& path, const std::string& what);

// nullopt: not of this form.

/// A whole number in [low, high].
std::optional<std::int64_t> to_integer(const Json& value, std::int64_t low, std::int64_t high);
/// Three of them.
std::optional<glm::ivec3> to_integers(const Json& list, int low, int high);
/// Three finite numbers.
std::optional<glm::dvec3> to_point(const Json& list);
/// Four columns of three numbers.
std::optional<glm::dmat4> to_transform(const Json& columns);

Json to_json(const glm::dmat4& affine);
Json to_json(const glm::dvec3& v);

}  // namespace brume::grids
