// Game characters: from parts to a finished character.
#include "game.h"

#include <algorithm>
#include <map>

namespace creatures {
namespace game {
namespace {

// Parts of one key become one mesh: all separate, both sides together, or everything at once.
std::string key_of(const Part& part, double habit) {
  if (habit < 0.25) return "character";
  const bool sided = part.name.ends_with(".L") || part.name.ends_with(".R");
  return habit < 0.7 && sided ? part.name.substr(0, part.name.size() - 2) : part.name;
}

std::vector<Part> merged(std::vector<Part> parts, double habit) {
  std::vector<Part> result;
  std::map<std::string, size_t> known;
  for (Part& part : parts) {
    const std::string key = key_of(part, habit);
    const auto [at, fresh] = known.try_emplace(key, result.size());
    if (fresh) {
      result.push_back(std::move(part));
      result.back().name = key;
      continue;
    }
    Part& whole = result[at->second];
    append(whole.mesh, part.mesh);
    whole.skin.insert(whole.skin.end(), part.skin.begin(), part.skin.end());
  }
  return result;
}

// Large triangles may miss a short neck or a small ear: then what is nearest to the bone follows it halfway.
void lead_every_joint(Character& made) {
  std::vector<double> most(made.skeleton.joints.size(), 0.0);
  for (const Influences& v : made.skin)
    for (int k = 0; k < max_influences; ++k)
      most[static_cast<size_t>(v.joints[k])] = std::max(most[static_cast<size_t>(v.joints[k])], v.weights[k]);
  for (size_t j = 0; j < most.size(); ++j) {
    if (most[j] > 0.3) continue;
    const Vec3 middle = 0.5 * (made.skeleton.joints[j].rest + made.skeleton.joints[j].tip);
    const auto nearest = std::min_element(
        made.rest.positions.begin(), made.rest.positions.end(),
        [&](const Vec3& a, const Vec3& b) { return (a - middle).norm() < (b - middle).norm(); });
    Influences& v = made.skin[static_cast<size_t>(nearest - made.rest.positions.begin())];
    v = {{static_cast<int>(j), v.joints[0], 0, 0}, {0.5, 0.5, 0, 0}};
    if (v.joints[0] == v.joints[1]) v = {{static_cast<int>(j), 0, 0, 0}, {1, 0, 0, 0}};
  }
}

}  // namespace

Character finish(const Frame& frame, std::vector<Part> parts, Random& random) {
  Character made{frame.name, frame.skeleton, {}, {}, {}, {}, {}};
  for (Part& part : merged(std::move(parts), random.uniform(0, 1))) {
    append(made.rest, part.mesh);
    made.skin.insert(made.skin.end(), part.skin.begin(), part.skin.end());
    made.pieces.push_back({part.name, static_cast<int>(part.mesh.positions.size()),
                           static_cast<int>(part.mesh.triangles.size())});
  }
  lead_every_joint(made);
  add_landmarks(made, frame.body, frame.anchors);
  double floor = 1e9;
  for (const Vec3& p : made.rest.positions) floor = std::min(floor, p.y());
  const double scale = random.typical(0.6, 1.4);
  const Vec3 down(0, floor, 0);
  for (Vec3& p : made.rest.positions) p = scale * (p - down);
  for (Joint& joint : made.skeleton.joints) {
    joint.rest = scale * (joint.rest - down);
    joint.tip = scale * (joint.tip - down);
  }
  pose_character(made, frame.freedoms, random);
  return made;
}

}  // namespace game

const std::vector<Family>& game_families() {
  static const std::vector<Family> all{
      {"game_humanoid", "people, mascots and robots as games have them: of parts, from realistic to chibi",
       nullptr, game::make_humanoid},
      {"game_quadruped", "four-legged animals as games have them: of parts, from lizards to elephants",
       nullptr, game::make_quadruped},
  };
  return all;
}

}  // namespace creatures
