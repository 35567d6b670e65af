// Characters that teach: names that differ by a prefix match, characters of other skeletons are named, useless skins too.
#include "skeleton/teachers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

const RiggedMesh& teacher() {
  static const RiggedMesh one = rigged(humanoid(1));
  return one;
}

// Every joint called otherwise.
template <class Rename>
RiggedMesh renamed(Rename&& rename) {
  RiggedMesh result = teacher();
  for (Joint& joint : result.rig.joints) joint.name = rename(joint.name);
  return result;
}

RiggedMesh prefixed(const std::string& prefix) {
  return renamed([&](const std::string& name) { return prefix + name; });
}

std::set<std::string> names_of(const RiggedMesh& character) {
  std::set<std::string> names;
  for (const Joint& joint : character.rig.joints) names.insert(joint.name);
  return names;
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& one : sentences) text += one + "\n";
  return text;
}

// The message of the error.
std::string refusal(std::vector<RiggedMesh> characters) {
  try {
    match_teachers(characters);
  } catch (const Error& error) {
    CHECK(error.status() == Status::invalid_argument);
    CHECK(std::string(error.hint()).size() > 10);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("characters of one skeleton: nothing to say, nothing changed") {
  std::vector<RiggedMesh> characters(3, teacher());
  CHECK(match_teachers(characters).empty());
  for (const RiggedMesh& one : characters) CHECK(names_of(one) == names_of(teacher()));
  characters.resize(1);
  CHECK(match_teachers(characters).empty());
}

TEST_CASE("a prefix on some of the files is put aside, and said so") {
  for (const std::string prefix :
       {"mixamorig:", "mixamorig1:", "Armature_", "Armature_mixamorig:", "Bip001 ", "hero|", "X"}) {
    CAPTURE(prefix);
    std::vector<RiggedMesh> characters = {teacher(), prefixed(prefix), teacher(), prefixed(prefix)};
    const std::vector<std::string> warnings = match_teachers(characters);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("characters 2 and 4: the prefix '" + prefix + "'") != std::string::npos);
    for (const RiggedMesh& one : characters) CHECK(names_of(one) == names_of(teacher()));
    characters = {prefixed(prefix), teacher()};  // the first decides what joints are called
    CHECK(match_teachers(characters).size() == 1);
    CHECK(names_of(characters[1]) == names_of(prefixed(prefix)));
  }
  std::vector<RiggedMesh> characters = {prefixed("mixamorig:"), prefixed("mixamorig7:"), prefixed("Bip01 ")};
  CHECK(match_teachers(characters).size() == 2);
  CHECK(names_of(characters[1]) == names_of(characters[2]));
  const TrainingSet set = training_set_of(characters, {.shapes = 3, .landmarks = 10});
  CHECK(set.skeleton.size() == teacher().rig.joints.size());
}

TEST_CASE(
    "characters that share only a few joints are refused, with what they share and what they are called") {
  std::vector<RiggedMesh> characters;
  for (int pack = 0; pack < 5; ++pack) {
    characters.push_back(renamed([&](const std::string& name) {
      return name == "hips" || name == "spine" || name == "head" ? name
                                                                 : name + std::to_string(pack) + "bone";
    }));
    characters.back().file = "pack" + std::to_string(pack) + ".glb";
  }
  const std::string message = refusal(characters);
  CAPTURE(message);
  CHECK(message.find("do not share one skeleton") != std::string::npos);
  CHECK(message.find("share 3 of ") != std::string::npos);
  CHECK(message.find("'hips'") != std::string::npos);
  CHECK(message.find("0bone'") != std::string::npos);
  CHECK(message.find("1 (pack0.glb)") != std::string::npos);
  CHECK_THROWS_AS(training_set_of(characters), Error);
  const std::string nothing =
      refusal({teacher(), renamed([](const std::string& name) { return name + "_b"; })});
  CHECK(nothing.find("none of ") != std::string::npos);
}

TEST_CASE("one character of another skeleton among many is named; the others teach") {
  std::vector<RiggedMesh> characters(4, teacher());
  characters[2] = renamed([](const std::string& name) { return name == "hips" ? name : "q" + name + "w"; });
  const std::string warnings = joined(match_teachers(characters));
  CAPTURE(warnings);
  CHECK(warnings.find("character 3 shares 1 of ") != std::string::npos);
  CHECK(warnings.find("are left out") != std::string::npos);
  CHECK(training_set_of(characters, {.shapes = 4, .landmarks = 10}).skeleton.size() ==
        teacher().rig.joints.size());
}

TEST_CASE("skins that teach nothing are named with their file") {
  RiggedMesh heap = teacher(), bare = teacher(), invalid = teacher();
  for (Joint& joint : heap.rig.joints) joint.bind.topRightCorner<3, 1>().setConstant(0.25);
  for (size_t v = 0; v < bare.rig.influences.size(); ++v)
    if (v % 3) bare.rig.influences[v] = {};
  bare.file = "bare.glb";
  invalid.invalid_weights = 12;
  std::vector<RiggedMesh> characters = {teacher(), heap, bare, invalid};
  const std::vector<std::string> warnings = match_teachers(characters);
  CAPTURE(joined(warnings));
  REQUIRE(warnings.size() == 3);
  CHECK(warnings[0].find("character 2: all of its") == 0);
  CHECK(warnings[1].find("character 3 (bare.glb): 6") == 0);
  CHECK(warnings[1].find("no skin weights") != std::string::npos);
  CHECK(warnings[2].find("character 4: 12 skin weights are negative") == 0);
  std::vector<std::string> reported;
  training_set_of(characters, {.shapes = 4, .landmarks = 10}, {}, &reported);
  CHECK(reported == warnings);
}
