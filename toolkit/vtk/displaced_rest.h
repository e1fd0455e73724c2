#pragma once

#include <optional>
#include <string>

#include "toolkit/mesh/fields.h"

class vtkPolyData;

namespace mimetra {

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
