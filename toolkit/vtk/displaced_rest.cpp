#include "toolkit/vtk/displaced_rest.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <utility>

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "toolkit/vtk/poly_data.h"

namespace mimetra {
namespace {

/// Above it displacements drown in the rounding, as a share of the largest one.
constexpr double kMostRounding = 0.25;
/// From the first frame that is looked at to the last.
constexpr int kSteps = 8;

double largest_of(const Eigen::MatrixXd& values) {
  return values.array().isFinite().select(values.array().abs(), 0).maxCoeff();
}

/// How far sums of `values` may be off where one of the arrays is of single precision.
double rounding_of(const Eigen::MatrixXd& values, std::initializer_list<vtkDataArray*> arrays) {
  const bool is_single = std::ranges::any_of(
      arrays, [](vtkDataArray* array) { return array->GetDataType() == VTK_FLOAT; });
  const double epsilon =
      is_single ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  return 4 * epsilon * largest_of(values);
}

/// What is not finite agrees: it is refused, unless there is nothing else.
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
