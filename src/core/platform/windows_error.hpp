// Errors of Windows as values of errno. Internal to this folder's side for Windows.
#pragma once

namespace brume::platform {

/// EIO for what has no other.
int to_errno(unsigned long error);
/// Sets errno by what GetLastError returns.
void set_errno();

}  // namespace brume::platform
