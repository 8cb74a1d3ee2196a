// Checks numbers of the C interfaces against the ranges of scene/options.hpp.
#pragma once

#include <string>

#include "api/call.hpp"
#include "scene/options.hpp"

namespace brume::api {

/// Refuses what is outside the range of a setting: "NAME must be from 0 to 10^6".
void require_range(const scene::OptionInfo& info, float value, const std::string& name,
                   const char* or_else = "");
void require_range(const scene::OptionInfo& info, std::uint32_t value, const std::string& name);

/// The same for all settings of a struct: a visitor of scene/options.hpp. Messages begin with `start`, the
/// key and a backtick.
class RangeCheck {
 public:
  explicit RangeCheck(std::string start) : start_(std::move(start)) {}

  template <typename Number>
  void operator()(const scene::OptionInfo& info, const Number& member) const {
    require_range(info, member, start_ + info.key + "`");
  }
  void operator()(const scene::OptionInfo& info, const glm::vec3& member) const {
    for (int axis = 0; axis < 3; ++axis) (*this)(info, member[axis]);
  }
  template <typename Member>
  void operator()(const scene::OptionInfo& info, const std::optional<Member>& member) const {
    if (member) (*this)(info, *member);
  }

 private:
  std::string start_;
};

}  // namespace brume::api
