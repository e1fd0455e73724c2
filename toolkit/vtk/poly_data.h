#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"

class vtkPolyData;

namespace mimetra {

// Meshes as VTK holds them. Errors start with `name`: a file, or what else the data came from.

/// Positions (N x 3). Throws IoError where there are none, or one is not finite.
Positions positions_of(vtkPolyData& data, const std::string& name);

/// The polygons; vertices and lines are left out. Throws IoError where there are none, or strips.
Connectivity connectivity_of(vtkPolyData& data, const std::string& name);

/// A rest pose that a mesh carries, and what is odd about it; "" for nothing.
struct CarriedRest {
  Positions positions;
  std::string note;
};

/// The rest pose of data at `positions`: the point data kRestPose, or field data of this name,
/// which files of earlier versions have. Where filters have moved the points since set_rest() by a
/// linear map and a shift, it has moved with them; where they have moved otherwise, it stays, which
/// is noted. Throws IoError where a vertex of it is not finite.
std::optional<CarriedRest> rest_of(vtkPolyData& data, const Positions& positions,
                                   const std::string& name);

/// Throws IoError where a vertex of a rest pose is not finite.
void check_rest(const Positions& rest, const std::string& name);

/// All numeric point data, and cell data of the polygons, save rest poses. Whole numbers from 2^53
/// on are rounded to double precision.
std::vector<Field> fields_of(vtkPolyData& data, const Connectivity& connectivity);

/// A point array (N x c), or nothing.
std::optional<Eigen::MatrixXd> point_values(vtkPolyData& data, const std::string& name);

void set_polygons(vtkPolyData& data, const Connectivity& connectivity);

enum class Precision { single_precision, double_precision };
/// A rest pose that was set stays that of the new positions.
void set_positions(vtkPolyData& data, const Eigen::Ref<const Positions>& positions, Precision);

/// Adds or replaces a field: float, or integers of 32 bits, of 64 where a value needs them, and
/// double where one is beyond these or not finite. Triangle fields go on the polygon, the largest
/// of its triangles', and are 0 on cells of other kinds.
void add_field(vtkPolyData& data, const Field& field, const Connectivity& connectivity);

/// Point data of FieldSequence::displacement: the vector from the rest pose, and its length.
void add_displacement(vtkPolyData& data, const Eigen::MatrixXd& displacement);

/// Point data (N x 3, double) that carry the rest pose along a pipeline, and stay with their points
/// where a filter takes some away or distributes them. Filters that move points turn and scale it
/// at most, as a vector; kPlaced, the points themselves, tells what has become of them.
constexpr const char* kRestPose = "mimetra_rest";
constexpr const char* kPlaced = "mimetra_points";
void set_rest(vtkPolyData& data, const std::optional<Positions>& rest);

/// The rest pose from which the point data kDisplacement of a series lead to its frames, as those
/// do that mimetra writes: other programs may mean anything by that name. It is the same in all
/// frames looked at; of a mesh of one frame, kDisplacementLength must be beside it.
class DisplacedRest {
 public:
  explicit DisplacedRest(int frames);

  /// True for frames that are to be looked at: the first, the last, and some between.
  bool looks_at(int frame) const;
  /// False where further frames change nothing.
  bool is_possible() const { return is_first_ || rest_; }
  /// Looks at a frame; the first one comes first.
  void look_at(vtkPolyData& data, const Positions& positions);

  /// Nothing where the data are no displacements, or something else's, and where the precision of
  /// points far from the origin does not tell. Throws IoError that begins with `name` where a
  /// vertex of it is not finite.
  std::optional<Positions> found(const std::string& name) const;

 private:
  int frames_;
  bool is_first_ = true;
  double largest_ = 0;   ///< displacement
  double rounding_ = 0;  ///< of rest poses of one frame and another
  std::optional<Positions> rest_;
};

}  // namespace mimetra
