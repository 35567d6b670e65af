// Names that Windows takes for something else. The rules are the same on every platform that asks.
#include "base/reserved_names.h"

#include <doctest/doctest.h>

#include <string>

using namespace focal;

TEST_CASE("devices") {
  for (const wchar_t* name :
       {L"NUL", L"nul", L"Con", L"prn", L"AUX", L"com1", L"COM9", L"lpt0", L"nul.txt", L"COM1.tar.gz",
        L"NUL ", L"nul  .bin", L"NUL:", L"CONIN$", L"conout$", L"COM\u00b2"})
    CHECK(is_device_name(name));
  for (const wchar_t* name : {L"", L"null", L"com", L"com10", L"COMx", L"xnul", L"console", L"a.nul", L".nul",
                              L"lpt", L"na\u00efve"})
    CHECK_FALSE(is_device_name(name));
}

TEST_CASE("paths that stay below their folder") {
  for (const wchar_t* path : {L"data.bin", L"sub/data.bin", L"sub\\data.bin", L"./data.bin", L"a//b",
                              L".hidden", L"a b/c d.bin", L"\u65e5\u672c/\u8a9e.bin"})
    CHECK(is_plain_relative_path(path));
  for (const wchar_t* path : {L"",
                              L".",
                              L"..",
                              L"../x",
                              L"sub/../../x",
                              L"sub\\..\\x",
                              L"/x",
                              L"\\x",
                              L"//server/share/x",
                              L"\\\\server\\share\\x",
                              L"\\\\?\\C:\\x",
                              L"\\\\.\\COM1",
                              L"C:\\x",
                              L"C:x",
                              L"c:",
                              L"x:stream",
                              L"x::$DATA",
                              L"NUL",
                              L"sub/com1.bin",
                              L"nul/x",
                              L".../x",
                              L".. /x",
                              L"sub/x.",
                              L"sub/x ",
                              L"sub /x",
                              L"sub/"})
    CHECK_FALSE(is_plain_relative_path(path));
}
