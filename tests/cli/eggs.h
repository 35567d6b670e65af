// A small set and a model of it, made once for all tests of the program.
#pragma once
#include "command.h"
#include "scratch_folder.h"
#include "tiny_set.h"

// A set of eggs and a model of it, made once for all tests of this file.
struct Eggs {
  ScratchFolder scratch;
  json trained;
  Eggs() {
    write_tiny_set(scratch, 4, 2);
    trained = focal_json("train " + folder() + " -o " + model() + " --eigenpairs 40 --trees 8");
  }
  std::string folder() const { return scratch.path.string(); }
  std::string model() const { return scratch / "eggs.focal"; }
  std::string mesh() const { return scratch / "egg4.glb"; }
};

inline const Eggs& eggs() {
  static const Eggs made;
  return made;
}
