// Whether the interface of a public header is the one that is kept.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/api/run_shell.hpp"

namespace brume::api {

/// What differs between the kept interface and that of a header: the exit status of abidiff, and its report.
inline ShellRun abi_difference(const std::string& header, const std::string& kept,
                               const std::string& include = BRUME_SOURCE_DIR "/include") {
  const std::string tests = BRUME_SOURCE_DIR "/tests/";
  return run_shell("abi=$(mktemp) && '" + tests + "api/abi-of-headers' " + header + " '" + include +
                   "' > \"$abi\" && abidiff --harmless '" + tests + kept +
                   "' \"$abi\" 2>&1; status=$?; rm -f \"$abi\"; exit $status");
}

}  // namespace brume::api
