// Skeleton templates as JSON: what is written is what is read, and what has another form is refused by name.
#include "skeleton/template_file.h"

#include <doctest/doctest.h>

#include "base/error.h"

using namespace focal;

namespace {

std::string with_joints(const std::string& joints) {
  return R"({"format": "focal-skeleton-template", "version": 1, "symmetric": true, "joints": [)" + joints +
         "]}";
}

void check_refused(const std::string& text, Status status, const std::string& part) {
  try {
    parse_skeleton_template(text.c_str());
    FAIL("accepted: ", text);
  } catch (const Error& error) {
    CHECK(error.status() == status);
    CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, error.what());
  }
}

constexpr const char* two_joints =
    R"({"name": "hips", "centre": ["a", "b"], "rest": [0, 2, 0]},
       {"name": "spine", "parent": "hips", "between": ["hips", "c"], "share": 0.25, "tip": "c"})";

}  // namespace

TEST_CASE("a template is read field by field") {
  const SkeletonTemplate found = parse_skeleton_template(with_joints(two_joints).c_str());
  CHECK(found.symmetric);
  REQUIRE(found.joints.size() == 2);
  CHECK(found.joints[0].name == "hips");
  CHECK(found.joints[0].parent.empty());
  CHECK(found.joints[0].centre == std::vector<std::string>{"a", "b"});
  CHECK(found.joints[0].share == 0.5);
  CHECK(found.joints[0].rest == Vector3(0, 2, 0));
  CHECK(found.joints[1].parent == "hips");
  CHECK(found.joints[1].between == std::vector<std::string>{"hips", "c"});
  CHECK(found.joints[1].share == 0.25);
  CHECK(found.joints[1].tip == "c");
  CHECK(!found.joints[1].rest);
}

TEST_CASE("what is no template is refused with what is wrong") {
  const auto bad = Status::invalid_argument;
  check_refused("{", Status::invalid_file, "the skeleton template: JSON");
  check_refused("[]", bad, "has no \"format\"");
  check_refused(R"({"format": "focal-skeleton-template", "version": 2})", Status::unsupported,
                "another version");
  check_refused(with_joints("3"), bad, "a joint that is not an object");
  check_refused(with_joints(R"({"nmae": "a"})"), bad, "an unknown \"nmae\"");
  check_refused(with_joints(R"({"name": 3})"), bad, "a \"name\" that is no text");
  check_refused(with_joints(R"({"centre": "a"})"), bad, "a \"centre\" that is no list");
  check_refused(with_joints(R"({"centre": [1]})"), bad, "a \"centre\" that is no list of names");
  check_refused(with_joints(R"({"share": "1"})"), bad, "a \"share\" that is no number");
  check_refused(with_joints(R"({"rest": [1, 2]})"), bad, "a \"rest\" that is no list of three numbers");
  check_refused(with_joints(R"({"rest": [1, 2, "3"]})"), bad, "a \"rest\" that is no list of three numbers");
  check_refused(with_joints(R"({"rest": [0, 0, 0]})"), bad, "a \"rest\" without a direction");
}

TEST_CASE("a template in a model must suit the model's landmarks") {
  const std::string text = with_joints(two_joints);
  CHECK(template_of_model(text, {"a", "b", "c"}).joints.size() == 2);
  CHECK_THROWS_WITH_AS(template_of_model(text, {"a", "b"}), doctest::Contains("section TMPL: "), Error);
}
