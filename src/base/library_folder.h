// Where this library lies.
#pragma once
#include <filesystem>

namespace focal {

// The folder of the shared library, or of the program that the library is linked into; empty where the system does not report it.
std::filesystem::path library_folder();

}  // namespace focal
