#include "toolkit/vtk/poly_data.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

namespace {

Eigen::MatrixXd values_of(vtkDataArray& array) {
  Eigen::MatrixXd values(array.GetNumberOfTuples(), array.GetNumberOfComponents());
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      values(row, column) = array.GetComponent(row, static_cast<int>(column));
    }
  }
  return values;
}

void name_components(vtkDataArray& array) {
  if (array.GetNumberOfComponents() != 3) return;
  array.SetComponentName(0, "X");
  array.SetComponentName(1, "Y");
  array.SetComponentName(2, "Z");
}

template <typename Array, typename Values, typename Convert>
vtkSmartPointer<Array> array_of(const std::string& name, const Values& values, Convert convert) {
  const auto array = vtkSmartPointer<Array>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(std::max(1, static_cast<int>(values.cols())));
  array->SetNumberOfTuples(values.rows());
  auto* out = array->GetPointer(0);
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      *out++ = convert(values(row, column));
    }
  }
  name_components(*array);
  return array;
}

template <typename Values>
vtkSmartPointer<vtkDataArray> float_array(const std::string& name, const Values& values) {
  return array_of<vtkFloatArray>(name, values, [&name](double x) {
    if (std::isfinite(x) && std::abs(x) > std::numeric_limits<float>::max()) {
      throw MismatchError("'" + name + "' holds " + std::to_string(x) +
                          ", which is beyond single precision and would be infinite in the file; "
                          "scale the mesh down, or write .npy");
    }
    return static_cast<float>(x);
  });
}

template <typename Values>
vtkSmartPointer<vtkDataArray> double_array(const std::string& name, const Values& values) {
  return array_of<vtkDoubleArray>(name, values, [](double x) { return x; });
}

template <typename Array>
vtkSmartPointer<vtkDataArray> integer_array(const std::string& name,
                                            const Eigen::MatrixXd& values) {
  return array_of<Array>(name, values, [](double x) {
    return static_cast<typename Array::ValueType>(std::llround(x));
  });
}

vtkSmartPointer<vtkDataArray> array_of(const std::string& name, const Eigen::MatrixXd& values,
                                       bool integer) {
  if (!integer) return float_array(name, values);
  if (all_are_held_by<vtkTypeInt32>(values)) return integer_array<vtkTypeInt32Array>(name, values);
  if (all_are_held_by<vtkTypeInt64>(values)) return integer_array<vtkTypeInt64Array>(name, values);
  return double_array(name, values);
}

vtkSmartPointer<vtkTypeInt32Array> index_array(const std::vector<int>& indices) {
  const auto array = vtkSmartPointer<vtkTypeInt32Array>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(indices.size()));
  std::copy(indices.begin(), indices.end(), array->GetPointer(0));
  return array;
}

/// Number of vertex and line cells, which VTK numbers before the polygons.
Eigen::Index cells_before_polygons(vtkPolyData& data) {
  return data.GetNumberOfVerts() + data.GetNumberOfLines();
}

/// Extends values on polygons to all cells; other cells get 0.
Eigen::MatrixXd on_cells(vtkPolyData& data, const Eigen::MatrixXd& on_polygons) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(data.GetNumberOfCells(), on_polygons.cols());
  values.middleRows(cells_before_polygons(data), on_polygons.rows()) = on_polygons;
  return values;
}

/// Copies the values of each polygon to its triangles.
Eigen::MatrixXd on_triangles(vtkPolyData& data, const Eigen::MatrixXd& on_cells,
                             const Connectivity& connectivity) {
  return on_cells.middleRows(cells_before_polygons(data), connectivity.polygons.size())(
      connectivity.polygon_of_triangle, Eigen::all);
}

/// Array `name` of point data or field data, or null if it does not hold one 3-vector per vertex.
vtkDataArray* vectors_of(vtkFieldData& carrier, const char* name, const Positions& positions) {
  vtkDataArray* array = carrier.GetArray(name);
  const bool fits = array && array->GetNumberOfComponents() == 3 &&
                    array->GetNumberOfTuples() == positions.rows();
  return fits ? array : nullptr;
}

/// Moves `rest` by the linear map and shift that took the points from `then` to `now`. Returns
/// nothing if the points moved otherwise.
std::optional<Positions> moved_with(const Positions& rest, const Positions& then,
                                    const Positions& now) {
  // Share of the largest coordinate: filters may output points in single precision.
  constexpr double kRounding = 4 * std::numeric_limits<float>::epsilon();
  // Share of the largest squared extent. In flatter directions, rounding would determine the map.
  constexpr double kFlat = 1e-8;
  if (now == then) return rest;
  const Eigen::RowVector3d center = then.colwise().mean();
  const Positions around = then.rowwise() - center, moves = now - then;
  const Eigen::RowVector3d shift = moves.colwise().mean();
  // Lazy products sum in an order that does not depend on cache sizes.
  const Eigen::Matrix3d squares = around.transpose().lazyProduct(around);
  const Eigen::Matrix3d moved = around.transpose().lazyProduct((moves.rowwise() - shift).eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares);
  const double flat = kFlat * axes.eigenvalues().maxCoeff();
  const Eigen::Vector3d inverse =
      (axes.eigenvalues().array() > flat).select(axes.eigenvalues().cwiseInverse(), 0);
  const Eigen::Matrix3d map =
      axes.eigenvectors() * inverse.asDiagonal() * axes.eigenvectors().transpose() * moved;
  const double left = ((moves - around.lazyProduct(map)).rowwise() - shift).cwiseAbs().maxCoeff();
  const double largest = std::max(then.cwiseAbs().maxCoeff(), now.cwiseAbs().maxCoeff());
  if (!(left <= kRounding * largest)) return {};
  return (rest + (rest.rowwise() - center).lazyProduct(map)).rowwise() + shift;
}

/// Stores the points as kPlaced if the mesh carries a rest pose. The array shares their memory.
void keep_places(vtkPolyData& data) {
  if (!data.GetPoints() || !data.GetPointData()->HasArray(kRestPose)) return;
  vtkDataArray* points = data.GetPoints()->GetData();
  const auto places = vtkSmartPointer<vtkDataArray>::Take(points->NewInstance());
  places->ShallowCopy(points);
  places->SetName(kPlaced);
  name_components(*places);
  data.GetPointData()->AddArray(places);
}

void check_finite(const Positions& positions, const std::string& name, const std::string& what) {
  if (const Eigen::Index v = first_unusable(positions); v >= 0) {
    throw IoError(name, what + std::to_string(v) + " has no usable position");
  }
}

Positions rest_in(vtkDataArray& array, const std::string& name) {
  Positions rest = values_of(array);
  check_rest(rest, name);
  return rest;
}

}  // namespace

Positions positions_of(vtkPolyData& data, const std::string& name) {
  if (data.GetNumberOfPoints() == 0) throw IoError(name, "has no points");
  Positions positions = values_of(*data.GetPoints()->GetData());
  check_finite(positions, name, "point ");
  return positions;
}

Connectivity connectivity_of(vtkPolyData& data, const std::string& name) {
  if (data.GetNumberOfStrips() > 0) {
    throw IoError(name, "has triangle strips; apply ParaView's Triangulate first");
  }
  // The offsets of a file may point anywhere.
  if (!data.GetPolys()->IsValid()) throw IoError(name, "the offsets of its faces do not fit");
  Polygons polygons;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < data.GetNumberOfPolys(); ++cell) {
    data.GetPolys()->GetCellAtId(cell, corners);
    for (const vtkIdType corner : *corners) polygons.corners.push_back(static_cast<int>(corner));
    polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  if (polygons.size() == 0) throw IoError(name, "has no faces");
  try {
    return Connectivity::from_polygons(static_cast<int>(data.GetNumberOfPoints()),
                                       std::move(polygons));
  } catch (const std::invalid_argument& error) {
    throw IoError(name, error.what());
  }
}

std::optional<CarriedRest> rest_of(vtkPolyData& data, const Positions& positions,
                                   const std::string& name) {
  vtkDataArray* on_points = vectors_of(*data.GetPointData(), kRestPose, positions);
  if (!on_points) {
    vtkDataArray* beside = vectors_of(*data.GetFieldData(), kRestPose, positions);
    if (!beside) return {};
    return CarriedRest{rest_in(*beside, name), ""};
  }
  Positions rest = rest_in(*on_points, name);
  // Earlier versions did not store kPlaced.
  vtkDataArray* places = vectors_of(*data.GetPointData(), kPlaced, positions);
  if (!places) return CarriedRest{std::move(rest), ""};
  if (auto moved = moved_with(rest, values_of(*places), positions)) return CarriedRest{*moved, ""};
  return CarriedRest{
      std::move(rest),
      "filters have moved the points since their rest pose (" + std::string(kRestPose) +
          ") was set, and not as a whole: it stays where it was, and what moved them counts as "
          "deformation; where it is none, apply such filters after mimetra's, or leave the array "
          "out by Pass Arrays"};
}

void check_rest(const Positions& rest, const std::string& name) {
  check_finite(rest, name, "rest pose: vertex ");
}

std::vector<Field> fields_of(vtkPolyData& data, const Connectivity& connectivity) {
  std::vector<Field> fields;
  const auto add = [&fields](vtkFieldData& arrays, Field::Location location, auto placed) {
    for (int i = 0; i < arrays.GetNumberOfArrays(); ++i) {
      vtkDataArray* array = vtkDataArray::SafeDownCast(arrays.GetAbstractArray(i));
      if (!array || !array->GetName()) continue;
      const std::string name = array->GetName();
      if (name == kRestPose || name == kPlaced) continue;
      const bool integer = array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
      fields.push_back({name, location, placed(values_of(*array)), integer});
    }
  };
  add(*data.GetPointData(), Field::Location::vertices,
      [](const Eigen::MatrixXd& values) { return values; });
  add(*data.GetCellData(), Field::Location::triangles,
      [&](const Eigen::MatrixXd& values) { return on_triangles(data, values, connectivity); });
  return fields;
}

std::optional<Eigen::MatrixXd> point_values(vtkPolyData& data, const std::string& name) {
  vtkDataArray* array = data.GetPointData()->GetArray(name.c_str());
  return array ? std::optional(values_of(*array)) : std::nullopt;
}

void set_polygons(vtkPolyData& data, const Connectivity& connectivity) {
  vtkNew<vtkCellArray> cells;
  cells->SetData(index_array(connectivity.polygons.offsets),
                 index_array(connectivity.polygons.corners));
  data.SetPolys(cells);
}

void set_positions(vtkPolyData& data, const Eigen::Ref<const Positions>& positions,
                   Precision precision) {
  vtkNew<vtkPoints> points;
  points->SetData(precision == Precision::single_precision ? float_array("Points", positions)
                                                           : double_array("Points", positions));
  data.SetPoints(points);
  keep_places(data);
}

void add_field(vtkPolyData& data, const Field& field, const Connectivity& connectivity) {
  if (field.location == Field::Location::triangles) {
    const Eigen::MatrixXd values = on_cells(data, on_polygons(field.values, connectivity));
    data.GetCellData()->AddArray(array_of(field.name, values, field.integer));
    return;
  }
  vtkPointData* on_points = data.GetPointData();
  on_points->AddArray(array_of(field.name, field.values, field.integer));
  // ParaView first colours a mesh by its active scalars.
  if (!on_points->GetScalars() && field.values.cols() == 1) {
    on_points->SetActiveScalars(field.name.c_str());
  }
}

void add_displacement(vtkPolyData& data, const Eigen::MatrixXd& displacement) {
  data.GetPointData()->AddArray(float_array(kDisplacement, displacement));
  data.GetPointData()->AddArray(
      float_array(kDisplacementLength, displacement.rowwise().norm().eval()));
}

void set_rest(vtkPolyData& data, const std::optional<Positions>& rest) {
  data.GetPointData()->RemoveArray(kPlaced);
  data.GetPointData()->RemoveArray(kRestPose);
  data.GetFieldData()->RemoveArray(kRestPose);
  if (!rest) return;
  data.GetPointData()->AddArray(double_array(kRestPose, *rest));
  keep_places(data);
}

namespace {

/// Above this share of the largest displacement, rounding hides the displacements.
constexpr double kMostRounding = 0.25;
/// Checked frames are about frames / kSteps apart.
constexpr int kSteps = 8;

double largest_of(const Eigen::MatrixXd& values) {
  return values.array().isFinite().select(values.array().abs(), 0).maxCoeff();
}

/// Bound on the rounding error of differences of `values`, for the least precise of `arrays`.
double rounding_of(const Eigen::MatrixXd& values, std::initializer_list<vtkDataArray*> arrays) {
  const bool is_single = std::ranges::any_of(
      arrays, [](vtkDataArray* array) { return array->GetDataType() == VTK_FLOAT; });
  const double epsilon =
      is_single ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  return 4 * epsilon * largest_of(values);
}

/// NaN differences count as equal, because check_rest() refuses such values later. At least one
/// difference must be finite.
bool agree(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double rounding) {
  const Eigen::ArrayXXd apart = (a - b).array().abs();
  return apart.isFinite().any() && !(apart > rounding).any();
}

bool has_its_length(vtkPolyData& data, const Eigen::MatrixXd& displacement) {
  vtkPointData& arrays = *data.GetPointData();
  const auto found = point_values(data, kDisplacementLength);
  const Eigen::VectorXd length = displacement.rowwise().norm();
  return found && found->rows() == length.rows() && found->cols() == 1 &&
         agree(*found, length,
               rounding_of(length,
                           {arrays.GetArray(kDisplacement), arrays.GetArray(kDisplacementLength)}));
}

}  // namespace

DisplacedRest::DisplacedRest(int frames) : frames_(frames) {}

bool DisplacedRest::looks_at(int frame) const {
  return frame % std::max(1, frames_ / kSteps) == 0 || frame == frames_ - 1;
}

void DisplacedRest::look_at(vtkPolyData& data, const Positions& positions) {
  if (!is_possible()) return;
  const bool is_first = std::exchange(is_first_, false);
  const std::optional<Positions> first = std::exchange(rest_, {});
  const auto displacement = point_values(data, kDisplacement);
  if (!displacement || displacement->rows() != positions.rows() || displacement->cols() != 3)
    return;
  const Positions rest = positions - *displacement;
  const auto arrays = {data.GetPoints()->GetData(), data.GetPointData()->GetArray(kDisplacement)};
  rounding_ = std::max({rounding_, rounding_of(positions, arrays), rounding_of(rest, arrays)});
  largest_ = std::max(largest_, largest_of(*displacement));
  if (is_first) {
    if (frames_ > 1 || has_its_length(data, *displacement)) rest_ = rest;
  } else if (first->rows() == rest.rows() && agree(rest, *first, rounding_)) {
    rest_ = first;
  }
}

std::optional<Positions> DisplacedRest::found(const std::string& name) const {
  if (!rest_ || (largest_ > 0 && rounding_ > kMostRounding * largest_)) return {};
  check_rest(*rest_, name);
  return rest_;
}

}  // namespace mimetra
