#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "toolkit/io/data.h"
#include "toolkit/vtk/poly_data.h"

class vtkDataObject;
class vtkPolyData;

/// Error for data of a class that is not a mesh.
std::invalid_argument no_mesh_error(const std::string& found);

/// Mesh of a data object. Throws std::invalid_argument if the object is not a mesh.
vtkPolyData& mesh_of(vtkDataObject* data);

/// The time steps of an input, collected one after the other.
class TimeSteps {
 public:
  /// Starts over. `times` is empty for a static mesh. With `with_fields`, collects the point and
  /// cell data of the first time step too.
  void begin(std::vector<double> times, bool with_fields);

  bool complete() const { return next_ == count(); }
  double share() const { return static_cast<double>(next_) / static_cast<double>(count()); }
  /// Time to request next; none for a static mesh.
  std::optional<double> next_time() const;
  /// Adds a time step. Throws std::invalid_argument if `data` is not a mesh. Throws IoError and
  /// MismatchError, whose messages name the time.
  void add(vtkDataObject* data);
  /// Returns the collected sequence and forgets it, except for its times and counts.
  mimetra::FieldSequence taken();

  /// Notes on what is odd about the collected time steps.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns whether the point data `displacement` were written by mimetra.
  bool are_displaced() const { return are_displaced_; }

  /// Throws MismatchError if a mesh at `time` has other numbers of vertices or faces than the
  /// collected ones.
  void expect_counts_of(vtkPolyData& mesh, std::optional<double> time) const;

 private:
  std::size_t count() const { return times_.empty() ? 1 : times_.size(); }
  /// Adds a note on the carried rest pose; empty if the points have moved as a whole since it was
  /// set.
  void note_on_carried(const std::string& note);

  std::vector<double> times_;
  bool with_fields_ = false;
  std::size_t next_ = 0;
  int vertices_ = 0;
  int faces_ = 0;
  mimetra::Connectivity connectivity_;
  mimetra::Frames frames_;
  std::optional<mimetra::Positions> rest_;
  bool rest_is_whole_ = false;  ///< the points carry the rest pose, and no filter has bent them
  mimetra::DisplacedRest displaced_{1};
  bool are_displaced_ = false;
  std::vector<std::string> notes_;
  std::vector<mimetra::Field> fields_;
};

/// Frame nearest to a time.
int frame_at(const mimetra::MeshSequence& sequence, double time);
