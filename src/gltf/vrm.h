// VRM 1.0 out: the humanoid map and the meta data of an avatar, put into a file that has a skeleton.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/limits.h"
#include "mesh/rig.h"

namespace focal {

// source: a .glb with the joints of the rig, as add_skin or replace_weights wrote it. roles: per joint the name of VRM's human bone, or
// empty. meta: a JSON object with "name" and "authors"; "licenseUrl" is filled in where it is missing. What the file had in VRMC_vrm is
// replaced. https://github.com/vrm-c/vrm-specification, VRMC_vrm-1.0. Throws what parse_gltf throws; invalid_argument (a .gltf,
// a human bone that VRM requires is missing, meta without a name or authors), invalid_file (meta is no JSON object).
std::vector<std::byte> add_vrm(std::span<const std::byte> source, const std::vector<Joint>& joints,
                               std::span<const std::string> roles, std::string_view meta,
                               const GltfLimits& limits = {});

}  // namespace focal
