// focal rig: the skeleton and skin weights of a model's characters, put into a mesh's own glTF.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>

#include "command_error.h"
#include "files.h"
#include "keep_skeleton.h"
#include "landmark_text.h"
#include "marked_mesh.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "paths.h"
#include "progress.h"
#include "rig_report.h"
#include "text_table.h"
#include "verdict_text.h"

namespace focal_cli {
namespace {

struct RigOptions : CommonOptions, DetectionOptions {
  std::string model, mesh, output, names, animations, skeleton_template, vrm;
  std::vector<std::string> pins;
  focal_pose pose = FOCAL_POSE_OF_MESH;
  bool rest_pose = false, symmetric = false, keep_failed = false, keep_skeleton = false, ground_root = false,
       drop_helpers = false;
  int32_t influences = 4;
};

const std::map<std::string, focal_bone_names> conventions = {
    {"vrm", FOCAL_BONE_NAMES_VRM},
    {"mixamo", FOCAL_BONE_NAMES_MIXAMO},
    {"unreal", FOCAL_BONE_NAMES_UNREAL},
    {"rigify", FOCAL_BONE_NAMES_RIGIFY},
    {"unity", FOCAL_BONE_NAMES_UNITY},
    {"godot", FOCAL_BONE_NAMES_UNITY},
    {"rigify-metarig", FOCAL_BONE_NAMES_RIGIFY_METARIG}};

// A JSON object from the model's joint names to others; a joint that it lacks keeps its name.
std::vector<std::string> names_from_file(const std::string& path, const std::vector<std::string>& joints) {
  if (!std::filesystem::exists(path_of(path)))
    throw CommandError(
        "'" + path + "' is neither a convention of bone names nor a file",
        "write vrm, mixamo, unreal, rigify, rigify-metarig, unity or godot, or pass a JSON file of names");
  const Json file = Json::parse(read_text_file(path), nullptr, false);
  if (!file.is_object())
    throw CommandError(path + " is not an object of joint names", R"(write {"hips": "Pelvis", ...})");
  std::vector<std::string> names = joints;
  for (const auto& [joint, name] : file.items()) {
    const auto at = std::find(joints.begin(), joints.end(), joint);
    if (at == joints.end() || !name.is_string() || name.get_ref<const std::string&>().empty())
      throw CommandError(path + ": '" + joint + "' is no joint of the model, or its name is no text",
                         "'focal info MODEL' lists the joints");
    names[static_cast<size_t>(at - joints.begin())] = name.get<std::string>();
  }
  return names;
}

// In order; what is wrong with a template the library says.
std::vector<std::string> template_joints(const std::string& text) {
  std::vector<std::string> names;
  const Json file = Json::parse(text, nullptr, false);
  if (file.is_object() && file.contains("joints") && file["joints"].is_array())
    for (const Json& joint : file["joints"])
      names.push_back(joint.is_object() && joint.contains("name") && joint["name"].is_string()
                          ? joint["name"].get<std::string>()
                          : "");
  return names;
}

// "NAME=X,Y,Z" each: joint_count x 3, NaN for a joint that follows.
std::vector<float> pinned(const std::vector<std::string>& pins, const std::vector<std::string>& joints) {
  std::vector<float> places(pins.empty() ? 0 : 3 * joints.size(), std::numeric_limits<float>::quiet_NaN());
  for (const std::string& pin : pins) {
    const size_t sign = std::min(pin.rfind('='), pin.size());
    const auto at = std::find(joints.begin(), joints.end(), pin.substr(0, sign));
    float p[3];
    char rest = 0;
    if (at == joints.end() || std::sscanf(pin.c_str() + sign, "=%f,%f,%f%c", &p[0], &p[1], &p[2], &rest) != 3)
      throw CommandError("--pin " + pin + " names no joint of the skeleton, or no place",
                         "write --pin NAME=X,Y,Z in the mesh's units; 'focal info MODEL' lists the joints");
    std::copy(p, p + 3, places.begin() + 3 * (at - joints.begin()));
  }
  return places;
}

Skeleton skeleton_of(const RigOptions& options, const focal_model* model, const focal_detection* detection,
                     const focal_mesh* animations, focal_task* task) {
  auto params = initialised(focal_skeleton_params_init);
  params.animations = animations;
  params.rest_pose = options.rest_pose ? FOCAL_POSE_OF_TEACHERS : options.pose;
  params.symmetric = options.symmetric, params.drop_helpers = options.drop_helpers;
  params.max_influences = options.influences, params.ground_root = options.ground_root;
  std::string skeleton_template;
  if (!options.skeleton_template.empty()) {
    skeleton_template = read_text_file(options.skeleton_template);
    params.skeleton_template = skeleton_template.c_str();
  }
  const std::vector<std::string> joints =
      skeleton_template.empty() ? joint_names_of(model) : template_joints(skeleton_template);
  const std::vector<float> pins = pinned(options.pins, joints);
  if (!pins.empty()) params.fixed_joints = pins.data(), params.fixed_joint_count = joints.size();
  std::vector<std::string> names;
  std::vector<const char*> pointers;
  const auto convention = conventions.find(options.names);
  if (convention != conventions.end()) {
    params.names = convention->second;
  } else if (!options.names.empty()) {
    names = names_from_file(options.names, joints);
    for (const std::string& name : names) pointers.push_back(name.c_str());
    params.joint_names = pointers.data(), params.joint_name_count = pointers.size();
  }
  return owned<Skeleton>(focal_skeleton_create, detection, &params, task);
}

bool writes(const RigVerdict& verdict, const RigOptions& options) {
  return !verdict.failed() || options.keep_failed;
}

Json report_of(const focal_skeleton* skeleton, const focal_detection* detection, const RigVerdict& verdict,
               const RigOptions& options, double seconds) {
  auto found = initialised(focal_detection_info_init);
  check(focal_detection_get_info(detection, &found));
  Json warnings = Json::array();
  for (uint32_t i = 0; i < found.warning_count; ++i)
    warnings.push_back(focal_detection_warning(detection, i));
  add_skeleton_warnings(warnings, skeleton);
  Json report = {{"mesh", options.mesh}, {"output", Json()}};
  if (writes(verdict, options)) report["output"] = options.output;
  add_verdict(report, verdict);
  report.update({{"joints", joints_json(skeleton)},
                 {"weights", weights_json(skeleton)},
                 {"category_fit", found.category_fit},
                 {"warnings", warnings},
                 {"seconds", seconds}});
  return report;
}

void print_rig(const Json& report, const RigVerdict& verdict) {
  print_joints(report["joints"]);
  std::cout << "\nverdict: " << verdict_text(verdict) << "\n";
  if (!verdict.failed() && !verdict_hint(verdict).empty())
    std::cout << "hint: " << verdict_hint(verdict) << "\n";
  std::cout << (report["output"].is_null() ? "no file written" : report["output"].get<std::string>())
            << " in " << fixed_text(report["seconds"].get<double>(), 2)
            << " s; fits the category: " << percent_text(report["category_fit"].get<double>(), 0) << "\n";
}

void write_file(const RigOptions& options, const focal_skeleton* skeleton) {
  if (options.vrm.empty()) return check(focal_skeleton_write_gltf(skeleton, options.output.c_str()));
  check(focal_skeleton_write_vrm(skeleton, read_text_file(options.vrm).c_str(), options.output.c_str()));
}

// The one file that is needed; a model is not.
void rig_own_skeleton(const RigOptions& options) {
  if (!options.mesh.empty())
    throw CommandError("--keep-skeleton needs no model, '" + options.model + "' is one too many",
                       "write focal rig --keep-skeleton MESH -o OUT");
  const std::pair<bool, const char*> others[] = {{!options.names.empty(), "--names"},
                                                 {!options.skeleton_template.empty(), "--template"},
                                                 {!options.animations.empty(), "--animations"},
                                                 {options.rest_pose, "--rest-pose"},
                                                 {options.pose != FOCAL_POSE_OF_MESH, "--pose"},
                                                 {options.drop_helpers, "--drop-helpers"},
                                                 {options.symmetric, "--symmetric"},
                                                 {options.ground_root, "--ground-root"},
                                                 {!options.vrm.empty(), "--vrm"},
                                                 {!options.pins.empty(), "--pin"}};
  for (const auto& [given, name] : others)
    if (given)
      throw CommandError(std::string("--keep-skeleton and ") + name + " exclude each other",
                         "the joints stay as they are");
  keep_skeleton(options.model, options.output, options.influences, options);
}

// Who names a mesh alone has no model yet, and learns here which there are.
void check_both_given(const RigOptions& options, const focal_context* context) {
  if (options.mesh.empty())
    throw CLI::ValidationError("MODEL and MESH",
                               "both are needed, '" + options.model + "' is alone; " + model_hint(context));
}

void rig(const RigOptions& options) {
  if (options.keep_skeleton) return rig_own_skeleton(options);
  const auto start = std::chrono::steady_clock::now();
  const Context context = make_context(options);
  check_both_given(options, context.get());
  check_output_folder(options.output);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  if (focal_model_joint_count(model.get()) == 0 && options.skeleton_template.empty())
    throw CommandError(
        "the model knows no skeleton",
        "train one on rigged characters: focal train --rigs A.glb -o MODEL; or describe one over its "
        "landmarks: --template FILE.json, here or for 'focal train'");
  const Mesh mesh = load_mesh(context.get(), options.mesh, options);
  auto params = detect_params_of(options, options);
  params.keep_votes = 0;
  const auto detection = owned<Detection>(focal_model_detect, model.get(), mesh.get(), &params,
                                          progress.begin("detecting", 0, 2));
  const Mesh animations =
      options.animations.empty() ? nullptr : load_mesh(context.get(), options.animations, options);
  const Skeleton skeleton =
      skeleton_of(options, model.get(), detection.get(), animations.get(), progress.begin("rigging", 1, 2));
  const RigVerdict verdict = verdict_of(skeleton.get(), detection.get());
  if (writes(verdict, options)) write_file(options, skeleton.get());
  progress.clear();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json report = report_of(skeleton.get(), detection.get(), verdict, options, seconds);
  if (options.json) print_json(report);
  if (options.prints_text()) {
    print_rig(report, verdict);
    for (const Json& warning : report["warnings"])
      std::cerr << "warning: " << warning.get<std::string>() << "\n";
  }
  if (verdict.failed())
    throw CommandError("the rig of " + options.mesh + " failed (quality " + percent_text(verdict.quality, 0) +
                           ")" + (options.keep_failed ? "" : "; no file is written without --keep-failed"),
                       verdict_hint(verdict));
}

}  // namespace

void add_rig(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("rig", "Add the skeleton and skin weights of a model's characters to a mesh");
  const auto options = std::make_shared<RigOptions>();
  verb->add_option(
          "MODEL", options->model,
          "Model of rigged characters (focal train --rigs), or the name of a stock model: focal models")
      ->type_name("")
      ->required();
  verb->add_option("MESH", options->mesh, "glTF file, .glb or .gltf")->type_name("");
  verb->add_option("-o,--output", options->output, "The mesh's own file with skeleton, skin and landmarks")
      ->type_name("OUT.glb")
      ->required();
  verb->add_option("--names", options->names,
                   "Names of the bones: vrm, mixamo, unreal, rigify, rigify-metarig, unity, godot, or a JSON "
                   "file that "
                   "maps the model's joint names to yours; default: as on the training characters")
      ->type_name("NAMES");
  verb->add_option(
          "--template", options->skeleton_template,
          "Your own skeleton over the model's landmarks, see docs/rigs.md; default: that of the training "
          "characters")
      ->type_name("FILE.json");
  verb->add_flag(
      "--symmetric", options->symmetric,
      "Make joints and weights exact mirror images if the mesh is symmetric; otherwise bones of both sides "
      "get the same length");
  verb->add_option("--influences", options->influences,
                   "Maximum number of joints that move one vertex (default 4)")
      ->check(CLI::Range(1, 8));
  verb->add_flag(
      "--rest-pose", options->rest_pose,
      "Same as --pose teachers: show the mesh in the rest pose of the model's first training character");
  add_choice(*verb, "--pose", options->pose,
             "The pose that the file shows: that of the mesh (default), the training characters' rest pose "
             "(teachers), the same with level arms (t) or with arms 45 degrees below level (a)",
             "mesh|teachers|t|a",
             {{"mesh", FOCAL_POSE_OF_MESH},
              {"teachers", FOCAL_POSE_OF_TEACHERS},
              {"t", FOCAL_POSE_T},
              {"a", FOCAL_POSE_A}});
  verb->get_option("--pose")->excludes("--rest-pose");
  verb->add_flag("--drop-helpers", options->drop_helpers,
                 "Omit twist bones and helpers of the training characters; their parent joints take over "
                 "what they moved");
  verb->add_flag("--ground-root", options->ground_root,
                 "Add a root joint on the ground above all others, as engines expect it");
  verb->add_option(
          "--vrm", options->vrm,
          "Write a VRM 1.0 avatar, with its meta data from a JSON file: {\"name\": ..., \"authors\": [...]}")
      ->type_name("META.json");
  verb->add_option("--pin", options->pins,
                   "Fix the position of a joint (the model's name for it), in the mesh's units; the others "
                   "follow. May be "
                   "given several times")
      ->type_name("NAME=X,Y,Z")
      ->allow_extra_args(false);
  verb->add_flag(
      "--keep-skeleton", options->keep_skeleton,
      "Compute weights only, without a model: focal rig --keep-skeleton MESH -o OUT. The joints of the "
      "mesh's own skin stay bit-identical");
  verb->add_flag("--keep-failed", options->keep_failed,
                 "Write the file even if the verdict is 'failed'; the exit status is still 1");
  verb->add_option("--animations", options->animations,
                   "Rigged character whose animations are retargeted and added to the file")
      ->type_name("CHARACTER.glb");
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { rig(*options); });
}

}  // namespace focal_cli
