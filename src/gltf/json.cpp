// Two passes of nlohmann's iterative SAX parser: the first measures, the second builds.
#include "gltf/json.h"

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "gltf/text.h"

namespace focal {
namespace {

const char* begin_of(std::span<const std::byte> text) { return reinterpret_cast<const char*>(text.data()); }

[[noreturn]] void fail_syntax(const std::string& explanation) {
  // Extracts the message of "[json.exception.parse_error.101] parse error at line 1, column 2: ...; last
  // read: ...".
  const size_t start = explanation.find("] ");
  const size_t from = start == std::string::npos ? 0 : start + 2;
  throw Error(Status::invalid_file,
              "JSON: " + printable(explanation.substr(from, explanation.find(';') - from)),
              "the file is corrupt or not glTF; export it again");
}

// The first pass checks syntax, depth and size before allocating anything. It also counts the members of
// every object in order of opening, so that the second pass never has to grow (that is, copy) an ordered
// object.
template <class Json>
class Measurer : public nlohmann::json_sax<Json> {
 public:
  explicit Measurer(const JsonLimits& limits) : limits_(limits) {}
  std::vector<int32_t> members;

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(typename Json::number_integer_t) override { return count(); }
  bool number_unsigned(typename Json::number_unsigned_t) override { return count(); }
  bool number_float(typename Json::number_float_t, const std::string&) override { return count(); }
  bool string(std::string&) override { return count(); }
  bool binary(typename Json::binary_t&) override { return count(); }
  bool start_object(size_t) override {
    open(static_cast<int32_t>(members.size()));
    members.push_back(0);
    return count();
  }
  bool key(std::string&) override { return ++members[static_cast<size_t>(open_.back())], true; }
  bool end_object() override { return open_.pop_back(), true; }
  bool start_array(size_t) override { return open(-1), count(); }
  bool end_array() override { return open_.pop_back(), true; }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    fail_syntax(error.what());
  }

 private:
  void open(int32_t object) {
    if (static_cast<int32_t>(open_.size()) >= limits_.depth)
      throw Error(Status::unsupported, "JSON nested deeper than " + std::to_string(limits_.depth) + " levels",
                  "no exporter needs that; remove deep extras or extensions");
    open_.push_back(object);
  }
  bool count() {
    if (++values_ > limits_.values)
      throw Error(Status::unsupported, "JSON of more than " + std::to_string(limits_.values) + " values",
                  "split the file or raise the limit");
    return true;
  }

  JsonLimits limits_;
  int64_t values_ = 0;
  std::vector<int32_t> open_;  // per open container: its index in members, -1 for an array
};

template <class Json>
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(Json& root, const std::vector<int32_t>& members) : root_(root), members_(members) {}

  bool null() override { return put(Json()), true; }
  bool boolean(bool value) override { return put(Json(value)), true; }
  bool number_integer(typename Json::number_integer_t value) override { return put(Json(value)), true; }
  bool number_unsigned(typename Json::number_unsigned_t value) override { return put(Json(value)), true; }
  bool number_float(typename Json::number_float_t value, const std::string&) override {
    return put(Json(value)), true;
  }
  bool string(std::string& value) override { return put(Json(std::move(value))), true; }
  bool binary(typename Json::binary_t&) override { return false; }  // not in JSON text
  bool start_object(size_t) override {
    Json& object = put(Json(Json::value_t::object));
    constexpr int32_t room_for_edits = 4;
    if constexpr (is_ordered)
      object.template get_ref<Object&>().reserve(
          static_cast<size_t>(members_[next_object_++] + room_for_edits));
    open_.push_back(&object);
    return true;
  }
  bool key(std::string& name) override { return key_ = std::move(name), true; }
  bool end_object() override { return open_.pop_back(), true; }
  bool start_array(size_t) override { return open_.push_back(&put(Json(Json::value_t::array))), true; }
  bool end_array() override { return open_.pop_back(), true; }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    fail_syntax(error.what());
  }

 private:
  using Object = typename Json::object_t;
  static constexpr bool is_ordered = std::is_same_v<Json, nlohmann::ordered_json>;

  Json& put(Json value) {
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_array()) {
      auto& array = open_.back()->template get_ref<typename Json::array_t&>();
      return array.emplace_back(std::move(value));
    }
    auto& object = open_.back()->template get_ref<Object&>();
    if constexpr (is_ordered) {
      // Bypasses its own emplace, which searches all keys: quadratic, and the keys are known to be distinct.
      auto& list = static_cast<typename Object::Container&>(object);
      return list.emplace_back(std::move(key_), std::move(value)).second;
    } else {
      const auto [place, is_new] = object.emplace(key_, std::move(value));
      if (!is_new)
        throw Error(Status::invalid_file, "JSON has the key '" + printable(key_) + "' twice in one object",
                    "the file is corrupt; export it again");
      return place->second;
    }
  }

  Json& root_;
  const std::vector<int32_t>& members_;
  size_t next_object_ = 0;
  std::string key_;
  std::vector<Json*> open_;  // an element's address is stable until its container gets the next one
};

}  // namespace

template <class Json>
BasicJsonDocument<Json>::BasicJsonDocument(std::span<const std::byte> text, const JsonLimits& limits) {
  const char* const begin = begin_of(text);
  const char* const end = begin + text.size();
  // The parser would skip a byte order mark; glTF forbids it.
  if (text.size() >= 3 && std::equal(begin, begin + 3, "\xEF\xBB\xBF"))
    throw Error(Status::invalid_file, "JSON begins with a byte order mark", "save the file as plain UTF-8");
  Measurer<Json> measurer(limits);
  Json::sax_parse(begin, end, &measurer);
  try {
    Builder<Json> builder(root_, measurer.members);
    Json::sax_parse(begin, end, &builder);
  } catch (...) {
    dismantle(root_);
    throw;
  }
}

template <class Json>
void BasicJsonDocument<Json>::dismantle(Json& value) noexcept {
  if (auto* array = value.template get_ptr<typename Json::array_t*>()) {
    for (Json& element : *array) dismantle(element);
    array->clear();
  } else if (auto* object = value.template get_ptr<typename Json::object_t*>()) {
    for (auto& member : *object) dismantle(member.second);
    object->clear();
  }
}

template class BasicJsonDocument<nlohmann::json>;
template class BasicJsonDocument<nlohmann::ordered_json>;

}  // namespace focal
