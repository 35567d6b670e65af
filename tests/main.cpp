// The one entry point of every C++ test; the tests themselves mirror src/ file by file.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
