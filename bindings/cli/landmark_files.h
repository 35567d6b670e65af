// Landmark files: our own JSON, 3D Slicer's .mrk.json and .fcsv, CSV, MeshLab's .pp.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace focal_cli {

using Position = std::array<double, 3>;

struct SurfacePlace {
  uint32_t triangle = 0;
  std::array<double, 3> barycentric{1, 0, 0};
};

// One landmark of a file; a format holds what it can of it. Positions are in the mesh file's coordinates.
struct Landmark {
  std::string name;
  std::optional<Position> position;
  std::optional<uint32_t> vertex;
  std::optional<SurfacePlace> surface;
  std::string status;  // found, uncertain or absent from a detection; empty for a mark set by hand
  std::optional<double> confidence;

  bool absent() const { return status == "absent"; }
};

struct LandmarkFile {
  std::string mesh;  // file name of the mesh, where the format has a place for it
  std::vector<Landmark> landmarks;
};

enum class LandmarkFormat { own_json, slicer_json, slicer_fcsv, csv, meshlab };

// By the ending of the name: .mrk.json, .json, .fcsv, .csv, .pp. Throws CommandError for any other.
LandmarkFormat landmark_format_of(const std::string& path);

// Slicer keeps points in RAS or LPS and reads mesh files as LPS, so the mesh's coordinates are taken as LPS:
// points stored as RAS are turned on the way in, and LPS is written. Foreign formats leave absent landmarks
// out.
LandmarkFile parse_landmarks(LandmarkFormat format, std::string_view text);
std::string format_landmarks(LandmarkFormat format, const LandmarkFile& file);

LandmarkFile read_landmark_file(const std::string& path);
void write_landmark_file(const std::string& path, const LandmarkFile& file);

// The formats one by one; parse_landmarks and format_landmarks choose among them.
LandmarkFile parse_own_json(std::string_view text);
std::string format_own_json(const LandmarkFile& file);
LandmarkFile parse_slicer_json(std::string_view text);
std::string format_slicer_json(const LandmarkFile& file);
LandmarkFile parse_slicer_fcsv(std::string_view text);
std::string format_slicer_fcsv(const LandmarkFile& file);
LandmarkFile parse_csv(std::string_view text);
std::string format_csv(const LandmarkFile& file);
LandmarkFile parse_meshlab(std::string_view text);
std::string format_meshlab(const LandmarkFile& file);

}  // namespace focal_cli
