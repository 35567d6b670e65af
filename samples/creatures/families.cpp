// The list of families, and what their designs share.
#include "design.h"

namespace creatures {

std::array<double, 6> random_asymmetry(Random& random, double size) {
  std::array<double, 6> waves;
  for (int i : {0, 2, 4}) waves[i] = random.uniform(-size, size);
  for (int i : {1, 3, 5}) waves[i] = random.uniform(0, 6);
  return waves;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all{
      {"humanoid", "people of different proportions in different poses", design_humanoid},
      {"quadruped", "four-legged animals with paws and a tail", design_quadruped},
      {"hand", "right hands", design_hand},
      {"insect", "six-legged animals with antennae", design_insect},
  };
  return all;
}

}  // namespace creatures
