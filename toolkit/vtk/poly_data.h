#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"

class vtkPolyData;

namespace mimetra {

// Conversions between meshes and vtkPolyData. Error messages start with `name`: the file, or
// another origin of the data.

/// Positions (N x 3). Throws IoError if there are no points, or a position is unusable.
Positions positions_of(vtkPolyData& data, const std::string& name);

/// Polygons of the data, without vertex and line cells. Throws IoError if there are no polygons, if
/// some are invalid, or if there are triangle strips.
Connectivity connectivity_of(vtkPolyData& data, const std::string& name);

/// A rest pose that a mesh carries, and a note on what is odd about it ("" for nothing).
struct CarriedRest {
  Positions positions;
  std::string note;
};

/// Rest pose of data at `positions`: the point data kRestPose, or field data of this name in files
/// of earlier versions. If filters have moved the points since set_rest() by a linear map and a
/// shift, the rest pose moves with them. After any other motion the rest pose stays, and a note
/// says so. Throws IoError if one of its vertices is unusable.
std::optional<CarriedRest> rest_of(vtkPolyData& data, const Positions& positions,
                                   const std::string& name);

/// Throws IoError if a vertex of a rest pose is unusable.
void check_rest(const Positions& rest, const std::string& name);

/// All numeric point data, and cell data of the polygons, except rest poses. Whole numbers from
/// 2^53 on are rounded to double precision.
std::vector<Field> fields_of(vtkPolyData& data, const Connectivity& connectivity);

/// Point array `name` (N x c), or nothing if there is none.
std::optional<Eigen::MatrixXd> point_values(vtkPolyData& data, const std::string& name);

void set_polygons(vtkPolyData& data, const Connectivity& connectivity);

enum class Precision { single_precision, double_precision };
/// Replaces the points. A rest pose set before becomes the rest pose of the new positions. Throws
/// MismatchError for positions beyond the range of a single_precision number.
void set_positions(vtkPolyData& data, const Eigen::Ref<const Positions>& positions, Precision);

/// Adds or replaces a field. Integer fields become int32, or int64 if a value needs it, or double
/// if a value exceeds int64 or is not finite. Other fields become float. Throws MismatchError if a
/// finite value exceeds the range of float. Triangle fields go onto polygons, which get the largest
/// value of their triangles. Cells of other kinds get 0.
void add_field(vtkPolyData& data, const Field& field, const Connectivity& connectivity);

/// Adds the point data of FieldSequence::displacement: the vector from the rest pose, and its
/// length.
void add_displacement(vtkPolyData& data, const Eigen::MatrixXd& displacement);

/// Names of point data (N x 3, double) that carry the rest pose along a pipeline. They stay with
/// their points if a filter removes or distributes points. Filters that move points at most rotate
/// and scale kRestPose, as a vector. kPlaced, a copy of the points, shows how the points have moved
/// since.
constexpr const char* kRestPose = "mimetra_rest";
constexpr const char* kPlaced = "mimetra_points";
void set_rest(vtkPolyData& data, const std::optional<Positions>& rest);

/// Rest pose implied by the point data kDisplacement of a series: positions minus displacements.
/// Other programs may use that name for anything. A rest pose is therefore found only if all
/// checked frames imply the same one. In a mesh of one frame, kDisplacementLength must match too.
class DisplacedRest {
 public:
  explicit DisplacedRest(int frames);

  /// Returns whether to check a frame: the first, the last, and some between them.
  bool looks_at(int frame) const;
  /// Returns false if further frames cannot change the result.
  bool is_possible() const { return is_first_ || rest_; }
  /// Checks a frame. \pre The first call gets the first frame.
  void look_at(vtkPolyData& data, const Positions& positions);

  /// Rest pose, or nothing if the arrays are missing, belong to something else, or are lost in
  /// rounding far from the origin. Throws IoError, beginning with `name`, if one of its vertices is
  /// unusable.
  std::optional<Positions> found(const std::string& name) const;

 private:
  int frames_;
  bool is_first_ = true;
  double largest_ = 0;   ///< component of a displacement, as absolute value
  double rounding_ = 0;  ///< rounding error of a frame's rest pose
  std::optional<Positions> rest_;
};

}  // namespace mimetra
