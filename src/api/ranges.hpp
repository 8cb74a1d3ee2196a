// Checks numbers of the C interfaces against the ranges of scene/options.hpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "api/call.hpp"
#include "scene/options.hpp"

namespace brume::api {

/// Refuses what is outside the range of a setting: "NAME must be from 0 to 10^6".
void require_range(const scene::OptionInfo& info, float value, const std::string& name,
                   const char* or_else = "");
void require_range(const scene::OptionInfo& info, std::uint32_t value, const std::string& name);
/// Allocates nothing where the value is in range.
void require_range(const scene::OptionInfo& info, float value, const char* name);

/// The same for all settings of a struct: a visitor of scene/options.hpp. Allocates nothing where all are in
/// range.
class RangeCheck {
 public:
  /// Names in messages are `start`, the key and a backtick, which begins in `start`.
  explicit RangeCheck(const char* start) : start_(start) {}
  /// For an item of a list: "decal 2: `strength`".
  RangeCheck(const char* item, std::size_t number) : start_(item), number_(number) {}

  template <typename Number>
  void operator()(const scene::OptionInfo& info, const Number& member) const {
    if (!is_in_range(info, member)) require_range(info, member, name_of(info));
  }
  void operator()(const scene::OptionInfo& info, const glm::vec3& member) const {
    for (int axis = 0; axis < 3; ++axis) (*this)(info, member[axis]);
  }
  template <typename Member>
  void operator()(const scene::OptionInfo& info, const std::optional<Member>& member) const {
    if (member) (*this)(info, *member);
  }

 private:
  static bool is_in_range(const scene::OptionInfo& info, float value);
  static bool is_in_range(const scene::OptionInfo& info, std::uint32_t value);
  std::string name_of(const scene::OptionInfo& info) const;

  const char* start_;
  std::optional<std::size_t> number_;
};

}  // namespace brume::api
