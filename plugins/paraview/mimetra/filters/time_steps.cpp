#include "plugins/paraview/mimetra/filters/time_steps.h"

#include <utility>

#include <vtkPolyData.h>

#include "toolkit/io/frame_times.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

namespace {

std::string name_of(std::optional<double> time) {
  return time ? "time " + to_text(*time) : "the mesh";
}

void expect_count(const std::string& name, const char* what, int found, int expected,
                  const std::vector<double>& times) {
  if (found == expected) return;
  throw MismatchError(name + ": " + std::to_string(found) + ' ' + what + ", expected " +
                      std::to_string(expected) + " as " +
                      (times.empty() ? "before" : "at time " + to_text(times.front())));
}

}  // namespace

std::invalid_argument no_mesh_error(const std::string& found) {
  return std::invalid_argument("expected a surface of polygons (vtkPolyData), found " + found +
                               "; apply Extract Surface or Merge Blocks first");
}

vtkPolyData& mesh_of(vtkDataObject* data) {
  vtkPolyData* mesh = vtkPolyData::SafeDownCast(data);
  if (mesh) return *mesh;
  throw no_mesh_error(data ? data->GetClassName() : "nothing");
}

void TimeSteps::begin(std::vector<double> times, bool with_fields) {
  *this = TimeSteps();
  times_ = std::move(times);
  with_fields_ = with_fields;
  displaced_ = DisplacedRest(static_cast<int>(count()));
}

std::optional<double> TimeSteps::next_time() const {
  return times_.empty() ? std::nullopt : std::optional(times_[next_]);
}

void TimeSteps::add(vtkDataObject* data) {
  vtkPolyData& mesh = mesh_of(data);
  const std::string name = name_of(next_time());
  const Positions positions = positions_of(mesh, name);
  Connectivity connectivity = connectivity_of(mesh, name);
  if (next_ == 0) {
    frames_.resize(static_cast<Eigen::Index>(count()), positions.size());
    if (auto carried = rest_of(mesh, positions, name)) {
      rest_ = std::move(carried->positions);
      note_on_carried(carried->note);
    }
    if (with_fields_) fields_ = fields_of(mesh, connectivity);
    vertices_ = connectivity.vertices;
    faces_ = connectivity.polygons.size();
    connectivity_ = std::move(connectivity);
  } else {
    expect_count(name, "vertices", connectivity.vertices, vertices_, times_);
    const int face = first_different_face(connectivity, connectivity_);
    if (face >= 0) {
      throw MismatchError(name + ": face " + std::to_string(face) + " is not that of time " +
                          to_text(times_.front()) + "; all time steps need the same faces");
    }
  }
  if (displaced_.looks_at(static_cast<int>(next_))) {
    displaced_.look_at(mesh, positions);
    if (rest_is_whole_)
      note_on_carried(rest_of(mesh, positions, name).value_or(CarriedRest{}).note);
  }
  frames_.row(static_cast<Eigen::Index>(next_)) =
      Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size());
  ++next_;
}

void TimeSteps::note_on_carried(const std::string& note) {
  rest_is_whole_ = note.empty();
  if (!rest_is_whole_) notes_.push_back(note);
}

FieldSequence TimeSteps::taken() {
  const Eigen::VectorXd times =
      Eigen::Map<const Eigen::VectorXd>(times_.data(), static_cast<Eigen::Index>(times_.size()));
  if (const std::string odd = note_on_steps(times); !odd.empty()) {
    notes_.push_back(odd + " (Temporal Shift Scale brings them there)");
  }
  const std::string first = name_of(times_.empty() ? std::nullopt : std::optional(times_.front()));
  auto displaced = std::exchange(displaced_, DisplacedRest(1)).found(first);
  are_displaced_ = displaced.has_value();
  if (are_displaced_) std::erase_if(fields_, is_displacement);
  if (!rest_) rest_ = std::move(displaced);
  MeshSequence sequence(std::move(connectivity_), std::move(frames_), times, std::move(rest_));
  return FieldSequence(std::move(sequence), std::move(fields_));
}

void TimeSteps::expect_counts_of(vtkPolyData& mesh, std::optional<double> time) const {
  const auto found = [](vtkIdType count) { return static_cast<int>(count); };
  expect_count(name_of(time), "vertices", found(mesh.GetNumberOfPoints()), vertices_, times_);
  expect_count(name_of(time), "faces", found(mesh.GetNumberOfPolys()), faces_, times_);
}

int frame_at(const MeshSequence& sequence, double time) {
  Eigen::Index frame = 0;
  (sequence.times().array() - time).abs().minCoeff(&frame);
  return static_cast<int>(frame);
}
