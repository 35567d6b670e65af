// Fig. 2, descriptors of a damaged shape, and Fig. 3, symmetric points and symmetry planes.
#include <algorithm>
#include <cmath>

#include "chart.h"
#include "damage.h"
#include "page.h"
#include "study.h"

namespace paper {
namespace {

constexpr std::array kPaints = {"#2563eb", "#d97706", "#b91c1c", "#0a7d3c"};

uint32_t vertex_of(const Marked& marked, const std::string& landmark) {
  const focal_surface_point& point = marked.marks.at(landmark);
  const auto heaviest = std::max_element(point.barycentric, point.barycentric + 3) - point.barycentric;
  return marked.mesh.triangles()[3 * size_t{point.triangle} + static_cast<size_t>(heaviest)];
}

Curve curve_of(const std::string& name, const char* paint, const float* values, size_t count) {
  Curve curve{name, paint, {}};
  for (size_t i = 0; i < count; ++i) curve.points.push_back({static_cast<double>(i), values[i]});
  return curve;
}

// Vertices that a triangle of every one of the shapes uses.
std::vector<uint32_t> common_vertices(const std::vector<Shape>& shapes, size_t wanted) {
  std::vector<size_t> used(shapes[0].positions.size() / 3, 0);
  for (size_t s = 0; s < shapes.size(); ++s)
    for (const uint32_t v : shapes[s].indices)
      if (used[v] == s) ++used[v];
  std::vector<uint32_t> all, some;
  for (uint32_t v = 0; v < used.size(); ++v)
    if (used[v] == shapes.size()) all.push_back(v);
  for (size_t i = 0; i < wanted; ++i) some.push_back(all[i * all.size() / wanted]);
  return some;
}

// Mean length of the change over the mean distance between two points of the clean shape: above 1 it says nothing more.
double change(const std::vector<float>& clean, const std::vector<float>& spoiled, size_t dimension) {
  double changed = 0, apart = 0;
  const size_t count = clean.size() / dimension;
  for (size_t i = 0; i < count; ++i) {
    double c = 0, a = 0;
    const size_t other = (i + count / 2) % count;
    for (size_t k = 0; k < dimension; ++k) {
      c += std::pow(clean[i * dimension + k] - spoiled[i * dimension + k], 2);
      a += std::pow(clean[i * dimension + k] - clean[other * dimension + k], 2);
    }
    changed += std::sqrt(c), apart += std::sqrt(a);
  }
  return changed / apart;
}

}  // namespace

std::string descriptors(const Study& study) {
  const Shape clean = shape_of(study.test().mesh);
  const std::vector<Shape> shapes = {clean, with_noise(clean, 0.3 * mean_edge(clean), 1),
                                     with_holes(clean, 60, 1)};
  const std::array names = {"clean", "noise", "holes"};
  std::vector<uint32_t> vertices = common_vertices(shapes, 200);
  std::string charts;
  std::vector<std::vector<std::string>> rows = {{"descriptor", "noise", "holes"}};
  for (focal_descriptor d = 0; d < static_cast<int32_t>(focal_descriptor_count()); ++d) {
    const size_t dimension = focal_descriptor_dimension(d);
    std::vector<std::vector<float>> values;
    std::vector<Curve> curves;
    for (size_t s = 0; s < shapes.size(); ++s) {
      values.push_back(mesh_of(study.context, shapes[s]).describe(study.context, d, vertices));
      curves.push_back(curve_of(names[s], kPaints[s], &values[s][100 * dimension], dimension));
    }
    charts += chart(focal_descriptor_name(d), "component", "", curves);
    rows.push_back({focal_descriptor_name(d), fixed(change(values[0], values[1], dimension), 2),
                    fixed(change(values[0], values[2], dimension), 2)});
  }
  return section(
      "Fig. 2: descriptors of one point on damaged shapes",
      "Noise of 0.3 mean edges in every coordinate, and 60 holes of one vertex. The table has the mean "
      "change of 200 points over how far two points of the clean shape differ: at 1 nothing is left.",
      "spin images and shape contexts count area, not vertices, in a neighbourhood of 0.2 "
      "sqrt(area); HKS and WKS are shown too.",
      charts + table(rows));
}

std::string symmetry(const Study& study) {
  const focal_symmetry_plane plane = study.test().mesh.symmetry_plane(study.context);
  std::string charts;
  size_t pairs = 0;
  for (const std::string& name : study.set.landmarks) {
    const auto other = std::find_if(study.set.mirror.begin(), study.set.mirror.end(), [&](const auto& pair) {
      return pair.second == name && pair.first != name;
    });
    if (other == study.set.mirror.end() || !study.test().marks.contains(name) || pairs == 2) continue;
    if (!study.test().marks.contains(other->first)) continue;
    std::vector<uint32_t> vertices = {vertex_of(study.test(), name), vertex_of(study.test(), other->first)};
    std::vector<float> values = study.test().mesh.describe(study.context, FOCAL_DESCRIPTOR_SI_HKS, vertices);
    const auto dimension = static_cast<std::ptrdiff_t>(values.size() / 2);
    const auto draw = [&](const std::string& title) {
      return chart(title, "component", "",
                   {curve_of(name, kPaints[2], values.data(), values.size() / 2),
                    curve_of(other->first, kPaints[0], &values[values.size() / 2], values.size() / 2)});
    };
    charts += "<div>" + draw("SI-HKS");
    for (std::ptrdiff_t i = 0; i < 2; ++i) {
      const picture::Point p = place_of(study.test(), i == 0 ? name : other->first);
      const double side =
          plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] - plane.offset;
      if (side < 0) std::reverse(values.begin() + i * dimension, values.begin() + (i + 1) * dimension);
    }
    charts += draw("symmetry-aware") + "</div>";
    ++pairs;
  }
  return pairs == 0
             ? ""
             : section("Fig. 3 a: symmetry-aware descriptors",
                       "A point and its mirror image have one SI-HKS; on the side that the symmetry plane's "
                       "normal does not point to, the components are reversed.",
                       "", charts);
}

std::string planes(const std::vector<Study>& studies) {
  std::vector<picture::Figure> figures;
  for (const Study& study : studies)
    for (const Marked* marked : {&study.set.test[0], &study.set.train[0]}) {
      const focal_symmetry_plane plane = marked->mesh.symmetry_plane(study.context);
      picture::Figure figure = surface_figure(marked->mesh);
      figure.triangles_drawn = 3500;
      const double width = 1.2 * marked->mesh.info().mean_edge_length;
      for (const picture::Point& p : figure.positions) {
        const double side =
            plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] - plane.offset;
        figure.heat.push_back(std::abs(side) < width ? 0.85 : side > 0 ? 0.25 : 0);
      }
      face_marks(figure, *marked);
      figure.caption = study.set.name + ", " + fixed(100 * plane.support, 0) + " %";
      figures.push_back(std::move(figure));
    }
  return section(
      "Fig. 3 b: symmetry planes",
      "Where the plane cuts the shape (red) and its two sides; the percentage tells how much of the "
      "surface is mirrored onto it. A bent body has no plane that mirrors all of it.",
      "the plane is found by our own program after Mitra, Guibas and Pauly 2006; the authors' is not at "
      "hand. Moments of balls stand in for its principal curvatures.",
      pictures(figures, std::min<size_t>(5, figures.size())));
}

}  // namespace paper
