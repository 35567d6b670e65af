// What is passed for glTF and is something else is called by its name, with what to do.
#include "gltf/foreign_file.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "gltf/gltf_builder.h"

using namespace focal;
using namespace focal_test;

TEST_CASE("other kinds of files are named by their first bytes") {
  std::string stl(84, '\0');
  stl[80] = 1, stl += std::string(50, 'x');
  const std::vector<std::pair<std::string, std::string>> files = {
      {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 3\n", "Git LFS pointer"},
      {std::string("Kaydara FBX Binary  \0\x1a", 22), "FBX"},
      {"; FBX 7.4.0 project file\n", "FBX"},
      {"ply\nformat ascii 1.0\n", "PLY"},
      {"solid cube\nfacet normal 0 0 1\n", "STL"},
      {stl, "STL"},
      {"# made by hand\n\nmtllib a.mtl\no cube\nv 0 0 0\n", "OBJ"},
      {"o cube\ng side\nv 0 0 0\n", "OBJ"},
      {"BLENDER-v400", "Blender"},
      {"#usda 1.0\n", "USD"},
      {"PXR-USDC", "USD"},
      {"PK\x03\x04zip", "zip"},
      {"\n <!DOCTYPE HTML><title>404</title>", "web page"},
      {"<html><body>Not Found", "web page"},
      {"<?xml version=\"1.0\"?><COLLADA>", "COLLADA"},
      {"\x89PNG\r\n", "PNG"},
      {"FOCALMDL", "focal model"}};
  for (const auto& [text, name] : files) {
    const std::string beginning = text.substr(0, 30);  // clang captures no structured binding
    CAPTURE(beginning);
    try {
      read_gltf_memory(bytes_of(text));
      FAIL("it was read");
    } catch (const Error& error) {
      CHECK(error.status() == Status::invalid_file);
      CHECK(std::string(error.what()).find(name) != std::string::npos);
      CHECK_FALSE(error.hint().empty());
    }
  }
}

TEST_CASE("what might be glTF is left to the parser") {
  for (const char* text : {"{}", " \n{\"asset\": {}}", "", "v", "vn", "solid", "# only a comment\n", "o \n"})
    CHECK_NOTHROW(refuse_foreign_file(bytes_of(text)));
  CHECK(error_of(bytes_of("# only a comment\n")).find("JSON") != std::string::npos);
}
