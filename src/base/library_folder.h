// The folder of this library.
#pragma once
#include <string>

namespace focal {

// The folder of the shared library, or of the program that the library is linked into; empty where the system
// does not report it.
std::string library_folder();

}  // namespace focal
