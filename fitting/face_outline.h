#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fitting/fitted_frame.h"

/// Outline of a face as a camera sees it. Landmarks of the jaw are on the outline rather than at
/// vertices. Internal to landmark_fitter.h.
namespace mimetra {

/// Finds the outline of a model: its boundary edges, and the edges between a front-facing and a
/// back-facing triangle. Queries are const.
class FaceOutline {
 public:
  explicit FaceOutline(const MorphableModel& model);

  /// Matches each landmark (m x 2) of a frame to the nearest point of the outline, with weight 1.
  /// Landmarks that are not seen (NaN) are left out; the result is null if none is seen. `neutral`
  /// holds the model's vertices for the alpha of the frame.
  std::shared_ptr<const OutlineRows> matched(const FittedFrame& frame, const Positions& neutral,
                                             const ImagePoints& landmarks) const;
  Positions neutral(const Eigen::VectorXd& alpha) const;

 private:
  struct Edge {
    int from = 0, to = 0;
    std::array<int, 2> triangles = {};  ///< second is -1 at the boundary
  };
  struct Match {
    Eigen::Index landmark = 0;
    int from = 0, to = 0;
    double share = 0;  ///< position on the edge, from 0 at `from` to 1 at `to`
    Eigen::RowVector2d normal = Eigen::RowVector2d::Zero();
  };

  std::vector<Edge> seen_outline(const ImagePoints& image) const;
  Eigen::MatrixXd rows_of(int vertex) const;
  OutlineRows rows_of(const std::vector<Match>& matches, const ImagePoints& landmarks) const;

  MorphableModel model_;
  std::vector<Edge> edges_;
};

/// Landmarks of a clip's frames on the outline.
struct ClipOutline {
  std::shared_ptr<const FaceOutline> face;
  std::vector<ImagePoints> landmarks;  ///< m x 2 for each frame

  /// Matches the frames again. All frames have the same alpha.
  std::vector<std::shared_ptr<const OutlineRows>> matched(
      const std::vector<FittedFrame>& frames) const;
};

}  // namespace mimetra
