// Characters and sets as files.
#include "write.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace creatures {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* licence = "CC0 1.0 (made by focal_creatures)";

Json numbers(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }
Json rounded(const Vec3& v) { return numbers((v * 1e7).array().round().matrix() / 1e7); }

void save(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void save(const std::filesystem::path& path, const Json& json) { save(path, json.dump(1) + "\n"); }

// One binary glTF under construction: a buffer, its views and its accessors.
class Glb {
 public:
  Glb() {
    root["asset"] = {{"version", "2.0"}, {"generator", "focal_creatures"}, {"copyright", licence}};
    root["scene"] = 0;
  }

  template <class T>
  int add(const std::vector<T>& values, int component_type, const char* type, int width, int target = 0) {
    while (bytes_.size() % 4) bytes_.push_back('\0');
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (target) view["target"] = target;
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    root["bufferViews"].push_back(view);
    root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"count", values.size() / static_cast<size_t>(width)},
                                 {"type", type}});
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  // The mesh with its positions and indices; returns its attributes for more.
  Json& add_mesh(const std::string& name, const std::vector<Vec3>& positions,
                 const std::vector<Triangle>& triangles) {
    std::vector<float> xyz;
    Eigen::AlignedBox3f box;
    for (const Vec3& p : positions) {
      const Eigen::Vector3f f = p.cast<float>();
      xyz.insert(xyz.end(), f.data(), f.data() + 3);
      box.extend(f);
    }
    std::vector<uint32_t> indices;
    for (const Triangle& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
    const int position = add(xyz, 5126, "VEC3", 3, 34962);
    root["accessors"][position]["min"] = {box.min().x(), box.min().y(), box.min().z()};
    root["accessors"][position]["max"] = {box.max().x(), box.max().y(), box.max().z()};
    Json primitive{{"attributes", {{"POSITION", position}}},
                   {"indices", add(indices, 5125, "SCALAR", 1, 34963)}};
    root["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    return root["meshes"].back()["primitives"][0]["attributes"];
  }

  void write(const std::filesystem::path& path) {
    while (bytes_.size() % 4) bytes_.push_back('\0');
    root["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    const auto word = [&out](size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(value >> shift & 255));
    };
    word(2);
    word(28 + text.size() + bytes_.size());
    word(text.size());
    word(0x4E4F534A);  // "JSON"
    out += text;
    word(bytes_.size());
    word(0x004E4942);  // "BIN"
    save(path, out + bytes_);
  }

  Json root;

 private:
  std::string bytes_;
};

void write_posed(const Character& made, const std::filesystem::path& path) {
  Glb glb;
  glb.add_mesh(made.name, made.posed, made.rest.triangles);
  glb.root["nodes"] = Json::array({{{"name", made.name}, {"mesh", 0}}});
  glb.root["scenes"] = Json::array({{{"nodes", {0}}}});
  glb.write(path);
}

void add_skin_attributes(Glb& glb, Json& attributes, const std::vector<Influences>& skin) {
  std::vector<uint8_t> joints;
  std::vector<float> weights;
  for (const Influences& v : skin) {
    float sum = 0;
    for (double w : v.weights) sum += static_cast<float>(w);
    for (int k = 0; k < max_influences; ++k) {
      joints.push_back(static_cast<uint8_t>(v.joints[k]));
      weights.push_back(static_cast<float>(v.weights[k]) / sum);
    }
  }
  attributes["JOINTS_0"] = glb.add(joints, 5121, "VEC4", 4, 34962);
  attributes["WEIGHTS_0"] = glb.add(weights, 5126, "VEC4", 4, 34962);
}

// Nodes 1 to n are the joints; bones that end in no joint get a node for their tip.
void add_joint_nodes(Glb& glb, const Skeleton& skeleton) {
  Json& nodes = glb.root["nodes"];
  const size_t count = skeleton.joints.size();
  for (const Joint& joint : skeleton.joints) {
    const Vec3 from = joint.parent < 0 ? Vec3(Vec3::Zero()) : skeleton.joints[joint.parent].rest;
    nodes.push_back({{"name", joint.name}, {"translation", numbers(joint.rest - from)}});
  }
  for (size_t i = 0; i < count; ++i)
    if (skeleton.joints[i].parent >= 0) nodes[skeleton.joints[i].parent + 1]["children"].push_back(i + 1);
  for (size_t i = 0; i < count; ++i) {
    if (nodes[i + 1].contains("children")) continue;
    const Joint& joint = skeleton.joints[i];
    nodes[i + 1]["children"].push_back(nodes.size());
    nodes.push_back({{"name", joint.name + "_end"}, {"translation", numbers(joint.tip - joint.rest)}});
  }
}

// "stretch": from rest into the character's pose and back, within two seconds.
void add_animation(Glb& glb, const Character& made) {
  const int times = glb.add(std::vector<float>{0, 1, 2}, 5126, "SCALAR", 1);
  glb.root["accessors"][times]["min"] = {0}, glb.root["accessors"][times]["max"] = {2};
  Json samplers = Json::array(), channels = Json::array();
  for (size_t j = 0; j < made.skeleton.joints.size(); ++j) {
    const int parent = made.skeleton.joints[j].parent;
    if (parent < 0) continue;  // the character stays where it looks
    const Eigen::Quaternionf turn(
        Eigen::Matrix3d(made.pose[parent].rotation().transpose() * made.pose[j].rotation()).cast<float>());
    std::vector<float> keys = {0, 0, 0, 1, turn.x(), turn.y(), turn.z(), turn.w(), 0, 0, 0, 1};
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", j + 1}, {"path", "rotation"}}}});
    samplers.push_back({{"input", times}, {"output", glb.add(keys, 5126, "VEC4", 4)}});
  }
  glb.root["animations"] =
      Json::array({{{"name", "stretch"}, {"samplers", samplers}, {"channels", channels}}});
}

// A mesh for each piece, all with the one skin: node 0, and after the joints' nodes the others.
void add_skinned_meshes(Glb& glb, const Character& made) {
  size_t vertex = 0, triangle = 0;
  for (const Piece& piece : made.pieces) {
    const auto from = made.rest.positions.begin() + static_cast<std::ptrdiff_t>(vertex);
    const auto skin = made.skin.begin() + static_cast<std::ptrdiff_t>(vertex);
    std::vector<Triangle> triangles;
    for (int t = 0; t < piece.triangles; ++t, ++triangle) {
      triangles.push_back(made.rest.triangles[triangle]);
      for (int& v : triangles.back()) v -= static_cast<int>(vertex);
    }
    add_skin_attributes(glb, glb.add_mesh(piece.name, {from, from + piece.vertices}, triangles),
                        {skin, skin + piece.vertices});
    vertex += static_cast<size_t>(piece.vertices);
  }
}

void write_rig(const Character& made, const std::filesystem::path& path) {
  Glb glb;
  if (made.pieces.empty())
    add_skin_attributes(glb, glb.add_mesh(made.name, made.rest.positions, made.rest.triangles), made.skin);
  else
    add_skinned_meshes(glb, made);
  std::vector<float> inverse_binds;
  Json joints = Json::array();
  for (const Joint& joint : made.skeleton.joints) {
    Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
    inverse.topRightCorner<3, 1>() = -joint.rest.cast<float>();
    inverse_binds.insert(inverse_binds.end(), inverse.data(), inverse.data() + 16);
    joints.push_back(joints.size() + 1);
  }
  glb.root["nodes"] = Json::array({{{"name", made.name}, {"mesh", 0}, {"skin", 0}}});
  add_joint_nodes(glb, made.skeleton);
  Json scene = Json::array({0, 1});
  for (size_t i = 1; i < made.pieces.size(); ++i) {
    scene.push_back(glb.root["nodes"].size());
    glb.root["nodes"].push_back({{"name", made.pieces[i].name}, {"mesh", i}, {"skin", 0}});
  }
  const int binds = glb.add(inverse_binds, 5126, "MAT4", 16);
  glb.root["skins"] = Json::array({{{"skeleton", 1}, {"joints", joints}, {"inverseBindMatrices", binds}}});
  glb.root["scenes"] = Json::array({{{"nodes", scene}}});
  add_animation(glb, made);
  glb.write(path);
}

Json joints_json(const Character& made) {
  Json joints = Json::array();
  for (size_t i = 0; i < made.skeleton.joints.size(); ++i) {
    const Joint& joint = made.skeleton.joints[i];
    const Eigen::Quaterniond q(made.pose[i].rotation());
    joints.push_back({{"name", joint.name},
                      {"parent", joint.parent < 0 ? Json() : Json(made.skeleton.joints[joint.parent].name)},
                      {"position", rounded(made.pose[i] * joint.rest)},
                      {"tip", rounded(made.pose[i] * joint.tip)},
                      {"rest", rounded(joint.rest)},
                      {"restTip", rounded(joint.tip)},
                      {"rotation", {q.x(), q.y(), q.z(), q.w()}}});
  }
  return {{"format", "focal-joints"},      {"version", 1}, {"mesh", made.name + ".glb"},
          {"rig", made.name + ".rig.glb"}, {"units", "m"}, {"joints", joints}};
}

Json landmarks_json(const Character& made) {
  Json marks = Json::array();
  for (const Landmark& mark : made.landmarks)
    marks.push_back({{"name", mark.name},
                     {"vertex", mark.vertex},
                     {"position", numbers(made.posed[mark.vertex].cast<float>().cast<double>())},
                     {"triangle", mark.triangle},
                     {"barycentric", numbers(mark.barycentric)}});
  return {{"format", "focal-landmarks"}, {"version", 1}, {"mesh", made.name + ".glb"}, {"landmarks", marks}};
}

}  // namespace

void write_character(const Character& character, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_posed(character, folder / (character.name + ".glb"));
  write_rig(character, folder / (character.name + ".rig.glb"));
  save(folder / (character.name + ".joints.json"), joints_json(character));
  save(folder / (character.name + ".landmarks.json"), landmarks_json(character));
}

void write_set(const Family& family, const std::vector<Character>& characters, int train_count, uint64_t seed,
               const std::filesystem::path& folder) {
  Json names = Json::array(), mirror = Json::object(), train = Json::array(), test = Json::array();
  for (const Landmark& mark : characters.front().landmarks) {
    names.push_back(mark.name);
    if (mark.name.ends_with(".R")) mirror[mark.name] = mark.name.substr(0, mark.name.size() - 1) + "L";
  }
  for (size_t i = 0; i < characters.size(); ++i)
    (static_cast<int>(i) < train_count ? train : test).push_back(characters[i].name);
  save(folder / "set.json", Json{{"name", family.name},
                                 {"category", family.name},
                                 {"description", family.description},
                                 {"licence", licence},
                                 {"redistributable", true},
                                 {"seed", seed},
                                 {"landmark_names", names},
                                 {"mirror", mirror},
                                 {"train", train},
                                 {"test", test}});
}

}  // namespace creatures
