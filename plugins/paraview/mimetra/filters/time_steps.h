#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "toolkit/operations/data.h"
#include "toolkit/vtk/poly_data.h"

class vtkDataObject;
class vtkPolyData;

/// What is wrong with data of a class that is no mesh.
std::invalid_argument no_mesh_error(const std::string& found);

/// The mesh of a data object. Throws std::invalid_argument where it is none.
vtkPolyData& mesh_of(vtkDataObject* data);

/// The time steps of an input, collected one after the other.
class TimeSteps {
 public:
  /// Begins anew; no times for a mesh that stands still. `with_fields`: also the point and cell
  /// data of the first time step.
  void begin(std::vector<double> times, bool with_fields);

  bool complete() const { return next_ == count(); }
  double share() const { return static_cast<double>(next_) / static_cast<double>(count()); }
  /// The time to ask for next; none for a mesh that stands still.
  std::optional<double> next_time() const;
  /// Throws IoError, MismatchError and std::invalid_argument that name the time.
  void add(vtkDataObject* data);
  /// What was collected, which is then forgotten, save its times and counts.
  mimetra::FieldSequence taken();

  /// What is odd about those collected.
  const std::vector<std::string>& notes() const { return notes_; }
  /// True where the point data `displacement` were mimetra's, and not anything else's.
  bool are_displaced() const { return are_displaced_; }

  /// Throws MismatchError for a mesh at `time` with other numbers of vertices or faces than those
  /// collected.
  void expect_counts_of(vtkPolyData& mesh, std::optional<double> time) const;

 private:
  std::size_t count() const { return times_.empty() ? 1 : times_.size(); }
  /// Empty where the points are as a whole where they were when the rest pose was set.
  void note_on_carried(const std::string& note);

  std::vector<double> times_;
  bool with_fields_ = false;
  std::size_t next_ = 0;
  int vertices_ = 0;
  int faces_ = 0;
  mimetra::Connectivity connectivity_;
  mimetra::Frames frames_;
  std::optional<mimetra::Positions> rest_;
  bool rest_is_whole_ = false;  ///< it came with the points, and no filter has bent these
  mimetra::DisplacedRest displaced_{1};
  bool are_displaced_ = false;
  std::vector<std::string> notes_;
  std::vector<mimetra::Field> fields_;
};

/// The frame nearest to a time.
int frame_at(const mimetra::MeshSequence& sequence, double time);
