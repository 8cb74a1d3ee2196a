// The defaults of the structs of the C interface.
#pragma once

#include <algorithm>
#include <cstring>

#include "api/call.hpp"

namespace brume::api {

/// Writes the defaults into a struct of any version of the headers: its first `struct_size` bytes. Members
/// that only a later version has become 0, which selects the behaviour without them.
template <typename Params>
brume_result write_defaults(const char* function, Params* out, std::uint32_t struct_size) noexcept {
  return Call(function).run([&](Call&) {
    require(out != nullptr, "the struct to write is null");
    require(struct_size >= offsetof(Params, next) + sizeof(out->next) && struct_size <= kMostStructBytes,
            "`struct_size` must be the size of the struct");
    Params params = defaults<Params>();
    params.struct_size = struct_size;
    std::memset(static_cast<void*>(out), 0, struct_size);
    std::memcpy(static_cast<void*>(out), &params, std::min<std::size_t>(struct_size, sizeof(Params)));
  });
}

}  // namespace brume::api
