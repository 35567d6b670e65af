// Takes the arguments as Windows keeps them, in UTF-16: main() would get them in a code page, without the letters that it lacks.
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <string>
#include <vector>

#include "command.h"

namespace {

std::string utf8_of(const wchar_t* wide) {
  const int size = ::WideCharToMultiByte(CP_UTF8, 0, wide, -1, nullptr, 0, nullptr, nullptr);
  std::string text(static_cast<size_t>(size), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, wide, -1, text.data(), size, nullptr, nullptr);
  text.pop_back();  // the NUL
  return text;
}

// Text leaves as UTF-8 with single newlines, in a console too, which goes back to the user's code page at the end.
class Utf8Output {
 public:
  Utf8Output() : before_(::GetConsoleOutputCP()) {
    ::SetConsoleOutputCP(CP_UTF8);
    for (const int stream : {1, 2}) ::_setmode(stream, _O_BINARY);
  }
  ~Utf8Output() {
    if (before_ != 0) ::SetConsoleOutputCP(before_);
  }
  Utf8Output(const Utf8Output&) = delete;
  Utf8Output& operator=(const Utf8Output&) = delete;

 private:
  UINT before_;
};

}  // namespace

int wmain(int argc, wchar_t** argv) {
  const Utf8Output output;
  std::vector<std::string> texts;
  for (int i = 0; i < argc; ++i) texts.push_back(utf8_of(argv[i]));
  std::vector<char*> arguments;
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  return focal_cli::run_command(argc, arguments.data());
}
