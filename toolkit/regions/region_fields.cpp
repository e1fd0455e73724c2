#include <string>

#include "toolkit/regions/regions.h"

namespace mimetra {
namespace {

Field integer_field(std::string name, Field::Location location, const Eigen::VectorXd& values) {
  return {std::move(name), location, values, true};
}

}  // namespace

std::vector<Field> fields_of(const Regions& regions) {
  Eigen::VectorXd strongest = Eigen::VectorXd::Constant(regions.vertices, -1);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(regions.vertices);
  Eigen::VectorXd added = Eigen::VectorXd::Zero(regions.vertices);
  for (std::size_t k = 0; k < regions.regions.size(); ++k) {
    for (const VertexIndex v : regions.regions[k].vertices) {
      if (count[v] == 0) {
        strongest[v] = static_cast<double>(k);
        added[v] = regions.regions[k].added_for.empty() ? 0 : 1;
      }
      count[v] += 1;
    }
  }
  Eigen::VectorXd in_L = Eigen::VectorXd::Zero(regions.all_triangles);
  for (const int t : regions.triangles) in_L[t] = 1;
  std::vector<Field> fields = {integer_field("region", Field::Location::vertices, strongest),
                               integer_field("region_count", Field::Location::vertices, count),
                               integer_field("roi", Field::Location::vertices, count.cwiseMin(1)),
                               integer_field("in_L", Field::Location::triangles, in_L)};
  if (!added.isZero(0)) {
    fields.push_back(integer_field("added", Field::Location::vertices, added));
  }
  if (regions.weights.size() > 0) {
    fields.push_back({"weight", Field::Location::vertices, regions.weights});
  }
  return fields;
}

std::vector<Field> component_fields(const Components& components, const Regions& regions) {
  std::vector<Field> fields;
  for (std::size_t k = 0; k < regions.regions.size(); ++k) {
    const int component = regions.regions[k].component;
    if (component < 0) continue;
    const std::string number = std::to_string(k);
    const PositionsView displacements(components.displacements.row(component).data(),
                                      components.vertices(), 3);
    fields.push_back({"support_" + number, Field::Location::vertices,
                      components.support.row(component).transpose()});
    fields.push_back({"component_" + number, Field::Location::vertices, displacements});
  }
  return fields;
}

}  // namespace mimetra
