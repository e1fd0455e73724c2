#include "toolkit/vtk/displaced_rest.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "toolkit/vtk/poly_data.h"

namespace mimetra {
namespace {

/// Of the largest value: positions and displacements are written in single precision.
constexpr double kRounding = 4 * std::numeric_limits<float>::epsilon();
/// From the first frame that is looked at to the last.
constexpr int kSteps = 8;

double largest_of(const Eigen::MatrixXd& values) {
  return values.array().isFinite().select(values.array().abs(), 0).maxCoeff();
}

/// What is not finite agrees: it is refused, unless there is nothing else.
bool agree(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double largest) {
  const Eigen::ArrayXXd apart = (a - b).array().abs();
  return apart.isFinite().any() && !(apart > kRounding * largest).any();
}

bool has_its_length(vtkPolyData& data, const Eigen::MatrixXd& displacement) {
  const auto found = point_values(data, kDisplacementLength);
  const Eigen::VectorXd length = displacement.rowwise().norm();
  return found && found->rows() == length.rows() && found->cols() == 1 &&
         agree(*found, length, largest_of(length));
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
  largest_ = std::max({largest_, largest_of(positions), largest_of(rest)});
  if (is_first) {
    if (frames_ > 1 || has_its_length(data, *displacement)) rest_ = rest;
  } else if (first->rows() == rest.rows() && agree(rest, *first, largest_)) {
    rest_ = first;
  }
}

std::optional<Positions> DisplacedRest::found(const std::string& name) const {
  if (rest_) check_rest(*rest_, name);
  return rest_;
}

bool is_displacement(const Field& field) {
  return field.location == Field::Location::vertices &&
         (field.name == kDisplacement || field.name == kDisplacementLength);
}

}  // namespace mimetra
