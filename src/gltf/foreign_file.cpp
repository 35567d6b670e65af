#include "gltf/foreign_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace focal {
namespace {

using std::string_view;

struct Kind {
  const char *begin, *name, *hint;
};

constexpr const char* import_hint = "import it in Blender (File, Import) and export it as .glb";
constexpr const char* unpack_hint = "unpack it and pass the .glb or .gltf in it";
constexpr std::array kinds{
    Kind{"version https://git-lfs.github.com/spec/", "a Git LFS pointer instead of the file",
         "fetch the file: git lfs install, then git lfs pull"},
    Kind{"Kaydara FBX Binary", "an FBX file", import_hint},
    Kind{"; FBX", "an FBX file (text)", import_hint},
    Kind{"ply\n", "a PLY file", import_hint},
    Kind{"ply\r", "a PLY file", import_hint},
    Kind{"solid ", "an STL file", import_hint},
    Kind{"BLENDER", "a Blender file", "open it in Blender and export it as .glb (File, Export, glTF 2.0)"},
    Kind{"#usda", "a USD file", import_hint},
    Kind{"PXR-USDC", "a USD file", import_hint},
    Kind{"PK\x03\x04", "a zip archive (or USDZ, 3MF)", unpack_hint},
    Kind{"\x1f\x8b", "a gzip archive", unpack_hint},
    Kind{"7z\xbc\xaf\x27\x1c", "a 7z archive", unpack_hint},
    Kind{"Rar!", "a RAR archive", unpack_hint},
    Kind{"\x89PNG", "a PNG picture", "pass the model, not an image of it"},
    Kind{"\xff\xd8\xff", "a JPEG picture", "pass the model, not an image of it"},
    Kind{"%PDF", "a PDF document", "pass a .glb or .gltf file"},
    Kind{"FOCALMDL", "a focal model", "pass it as the model, and a .glb or .gltf file as the mesh"},
};

string_view without_space(string_view text) {
  const size_t at = text.find_first_not_of(" \t\r\n");
  return at == string_view::npos ? string_view() : text.substr(at);
}

// Case-insensitive.
bool begins(string_view text, string_view with) {
  return text.size() >= with.size() && std::equal(with.begin(), with.end(), text.begin(), [](char a, char b) {
           return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
         });
}

bool is_html(string_view text) { return begins(text, "<!doctype html") || begins(text, "<html"); }

// OBJ has no signature: its lines start with one of a few words.
bool is_obj(string_view text) {
  for (int line = 0; line < 50 && !text.empty(); ++line) {
    text = without_space(text);
    if (begins(text, "v ") || begins(text, "mtllib ") || begins(text, "vn ") || begins(text, "vt "))
      return true;
    if (!begins(text, "#") && !begins(text, "o ") && !begins(text, "g ") && !begins(text, "s ")) return false;
    const size_t end = text.find('\n');
    text = end == string_view::npos ? string_view() : text.substr(end + 1);
  }
  return false;
}

// 80 bytes, the number of triangles, 50 bytes each.
bool is_binary_stl(std::span<const std::byte> bytes) {
  if (bytes.size() < 84) return false;
  uint64_t count = 0;
  for (size_t i = 4; i-- > 0;) count = count << 8 | static_cast<uint64_t>(bytes[80 + i]);
  return bytes.size() == 84 + 50 * count;
}

[[noreturn]] void refuse(const std::string& name, const char* hint) {
  throw Error(Status::invalid_file, "the file is " + name + ", not glTF", hint);
}

}  // namespace

void refuse_foreign_file(std::span<const std::byte> bytes) {
  const string_view text(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 8192));
  for (const Kind& kind : kinds)
    if (text.starts_with(kind.begin)) refuse(kind.name, kind.hint);
  const string_view first = without_space(text);
  if (is_html(first)) refuse("a web page", "the server sent it instead of the file; download it again");
  if (begins(first, "<?xml") || begins(first, "<collada")) refuse("an XML file (COLLADA, X3D)", import_hint);
  if (is_obj(text)) refuse("an OBJ file", import_hint);
  if (is_binary_stl(bytes)) refuse("an STL file", import_hint);
}

}  // namespace focal
