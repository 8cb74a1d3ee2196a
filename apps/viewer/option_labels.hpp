// The settings of a file in a user's words.
#pragma once

#include <string_view>

namespace brume::viewer {

/// The label of the setting with this key; empty for an unknown one.
const char* label_of(std::string_view key);

}  // namespace brume::viewer
