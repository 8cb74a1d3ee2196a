// UTF-8 as calls of Windows take it. Internal to this folder's side for Windows.
#pragma once

#include <string>
#include <string_view>

namespace brume::platform {

std::wstring to_utf16(std::string_view utf8);
std::string to_utf8(std::wstring_view utf16);

}  // namespace brume::platform
