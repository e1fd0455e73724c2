#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fitting/fitted_frame.h"

/// Landmarks of the jaw lie on the outline of the face as a camera sees it, not on vertices.
/// Internal to landmark_fitter.h.
namespace mimetra {

/// Finds the outline of a model: edges of its boundary, and those between a triangle whose front is
/// seen and one whose back is. Queries are const.
class FaceOutline {
 public:
  explicit FaceOutline(const MorphableModel& model);

  /// The point of the outline nearest to each of a frame's landmarks (m x 2, NaN for those not
  /// seen, which are left out), all with weight 1; null where none is seen. `neutral`: the model's
  /// vertices with the frame's alpha.
  std::shared_ptr<const OutlineRows> matched(const FittedFrame& frame, const Positions& neutral,
                                             const ImagePoints& landmarks) const;
  Positions neutral(const Eigen::VectorXd& alpha) const;

 private:
  struct Edge {
    int from = 0, to = 0;
    std::array<int, 2> triangles = {};  ///< the second is -1 at the boundary
  };
  struct Match {
    Eigen::Index landmark = 0;
    int from = 0, to = 0;
    double share = 0;  ///< of the way
    Eigen::RowVector2d normal = Eigen::RowVector2d::Zero();
  };

  std::vector<Edge> seen_outline(const ImagePoints& image) const;
  Eigen::MatrixXd rows_of(int vertex) const;
  OutlineRows rows_of(const std::vector<Match>& matches, const ImagePoints& landmarks) const;

  MorphableModel model_;
  std::vector<Edge> edges_;
};

/// What a clip's frames have on the outline.
struct ClipOutline {
  std::shared_ptr<const FaceOutline> face;
  std::vector<ImagePoints> landmarks;  ///< of each frame

  /// Matches the frames, which have one alpha, anew.
  std::vector<std::shared_ptr<const OutlineRows>> matched(
      const std::vector<FittedFrame>& frames) const;
};

}  // namespace mimetra
