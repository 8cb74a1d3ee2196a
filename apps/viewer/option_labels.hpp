// The settings of a file in a user's words.
#pragma once

#include "scene/options.hpp"

namespace brume::viewer {

/// The label of a setting; empty for an unknown one.
const char* label_of(const scene::OptionInfo& info);

}  // namespace brume::viewer
