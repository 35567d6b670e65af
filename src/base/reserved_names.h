// The names of Windows that lead elsewhere than they seem to.
#pragma once
#include <string_view>

namespace focal {

// NUL, com1, CON.txt: a device in every folder. name: one component of a path.
bool is_device_name(std::wstring_view name);

// Leads to a file below the folder that it is relative to: no root, drive, share, stream, device, "..", and no name that Windows
// changes.
bool is_plain_relative_path(std::wstring_view path);

}  // namespace focal
